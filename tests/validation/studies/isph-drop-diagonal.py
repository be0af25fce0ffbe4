from studies._drop import measure
from study import Level, Study

study = Study(
    name="isph-drop-diagonal",
    title="ISPH: elliptic drop, stretched along the diagonals",
    levels=[Level(1), Level(2), Level(4)],
    bars={"long axis, t = 0.5 s": 0.002, "short axis, t = 0.5 s": 0.0025, "long axis, t = 1 s": 0.003, "short axis, t = 1 s": 0.01,
          "velocity, t = 1 s": 0.03, "pressure, t = 0.5 s": 0.035},
    measure=measure,
    x_label="t [s]",
    y_label="semi-axis [m]",
    case="isph-drop.toml",
    settings=('body.drop.velocity=["y", "x"]', "domain.min=[-3, -3]", "domain.max=[3, 3]"),
)

from studies._drop import measure
from study import Level, Study

study = Study(
    name="isph-drop",
    title="ISPH: elliptic drop, stretched along the lattice",
    levels=[Level(1), Level(2), Level(4)],
    bars={"long axis, t = 0.5 s": 0.003, "short axis, t = 0.5 s": 0.004, "long axis, t = 1 s": 0.008, "short axis, t = 1 s": 0.045,
          "velocity, t = 1 s": 0.11, "pressure, t = 0.5 s": 0.04},
    ranges={"isph": {"area / exact": (1.0, 1.05)}},
    measure=measure,
    x_label="t [s]",
    y_label="semi-axis [m]",
)

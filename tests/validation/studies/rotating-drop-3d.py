from studies._rotation import measure
from study import Level, Study

study = Study(
    name="rotating-drop-3d",
    title="Free rotating ball",
    levels=[Level(1), Level(2), Level(4)],
    bars={"angular momentum": 0.02, "momentum": 1e-7},
    published={"angular momentum": 2e-7},
    measure=measure,
    x_label="t [s]",
    y_label="angular velocity over that at the start",
)

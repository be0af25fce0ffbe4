from studies._extension import measurement
from study import Level, Study

study = Study(
    name="trouton-planar",
    title="Sheet that stretches under its own weight",
    levels=[Level(1), Level(2), Level(4)],
    bars={"extensional viscosity": 0.016, "rate of strain": 0.015},
    published={"extensional viscosity": 0.13, "rate of strain": 0.13},
    ranges={"published": {"extensional viscosity / mu (exact 4)": (4.25, 4.52)}, "accurate": {}},
    measure=measurement(4, 0.048, 0.012),
    x_label="initial height above the tip [mm]",
    y_label="rate of strain [1/s]",
)

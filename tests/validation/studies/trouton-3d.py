from studies._extension import measurement
from study import Level, Study

study = Study(
    name="trouton-3d",
    title="Bar that stretches under its own weight",
    levels=[Level(1), Level(2), Level(4)],
    bars={"extensional viscosity": 0.053, "rate of strain": 0.055},
    published={"extensional viscosity": 0.1, "rate of strain": 0.1},
    # The correction of the viscosity overdoes that of threads as they get thin, and so makes up for less and less.
    orders={"extensional viscosity": 0.75, "rate of strain": 0.75},
    ranges={"published": {"extensional viscosity / mu (exact 3)": (2.7, 2.88)}, "accurate": {}},
    measure=measurement(3, 0.04, 0.01),
    x_label="initial height above the tip [mm]",
    y_label="rate of strain [1/s]",
)

from studies._vortices import measure
from study import Level, Study

study = Study(
    name="taylor-green",
    title="Taylor-Green vortices, 0.01 m/s",
    levels=[Level(1), Level(2), Level(4), Level(8)],
    bars={"t = 1 ms": 0.0115, "t = 5 ms": 0.058, "t = 10 ms": 0.12},
    published={"t = 1 ms": 0.0023, "t = 5 ms": 0.0145, "t = 10 ms": 0.038},
    measure=measure,
    x_label="t [s]",
    y_label="kinetic energy / that at the start",
)

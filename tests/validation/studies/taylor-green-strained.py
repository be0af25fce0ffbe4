from studies._vortices import measure
from study import Level, Study

study = Study(
    name="taylor-green-strained",
    title="Taylor-Green vortices, 0.1 m/s",
    levels=[Level(1), Level(2), Level(4), Level(8)],
    bars={"t = 1 ms": 0.012, "t = 5 ms": 0.06, "t = 10 ms": 0.122},
    published={"t = 5 ms": 0.3, "t = 10 ms": 0.8},
    ranges={"published": {"rate / exact to 10 ms": (1.4, 1.63)}, "accurate": {}},
    measure=measure,
    x_label="t [s]",
    y_label="kinetic energy / that at the start",
    case="taylor-green.toml",
    settings=(
        'body.vortices.velocity=["0.1 * sin(100 * pi * x) * cos(100 * pi * y)", "-0.1 * cos(100 * pi * x) * sin(100 * pi * y)"]',
    ),
)

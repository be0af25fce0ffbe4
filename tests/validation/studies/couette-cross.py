from studies._rates import measurement, rates
from study import Level, Study

study = Study(
    name="couette-cross",
    title="Couette flow of a Cross fluid",
    levels=[Level(1), Level(2)],
    bars={f"viscosity at {rate:g}/s": 0.01 for rate in rates},
    orders={f"viscosity at {rate:g}/s": 0 for rate in rates},
    measure=measurement(lambda rate: 0.5 + 19.5 / (1 + rate**0.6)),
    x_label="shear rate [1/s]",
    y_label="viscosity [Pa s]",
    case="couette-rates.toml",
    settings=("melt.rheology.model=cross",),
)

from studies._cylinders import measure
from study import Level, Study

study = Study(
    name="taylor-couette-soft",
    title="Taylor-Couette flow, bulk viscosity / viscosity = 100",
    levels=[Level(1), Level(2), Level(4)],
    bars={"velocity": 0.035, "torque, inner": 0.017, "torque, outer": 0.016},
    published={"velocity": 0.07, "torque, inner": 0.1, "torque, outer": 0.1},
    ranges={"published": {"torque / exact, inner": (1.04, 1.12), "torque / exact, outer": (1.04, 1.12)}, "accurate": {}},
    measure=measure,
    x_label="r [m]",
    y_label="speed / that of the inner cylinder",
    case="taylor-couette.toml",
    settings=("material.fluid.bulk_viscosity=1e2", "material.fluid.bulk_modulus=1e4"),
)

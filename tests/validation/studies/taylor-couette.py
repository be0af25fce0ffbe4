from studies._cylinders import measure
from study import Level, Study

study = Study(
    name="taylor-couette",
    title="Taylor-Couette flow, bulk viscosity / viscosity = 1000",
    levels=[Level(1), Level(2), Level(4)],
    bars={"velocity": 0.046, "torque, inner": 0.033, "torque, outer": 0.031},
    published={"velocity": 0.095, "torque, inner": 0.36, "torque, outer": 0.36},
    ranges={"published": {"torque / exact, inner": (1.2, 1.36), "torque / exact, outer": (1.2, 1.36)}, "accurate": {}},
    orders={"velocity": 0.85},
    measure=measure,
    x_label="r [m]",
    y_label="speed / that of the inner cylinder",
)

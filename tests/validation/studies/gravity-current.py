from studies._similarity import measurement
from study import Level, Study

study = Study(
    name="gravity-current",
    title="Plane viscous gravity current",
    levels=[Level(1), Level(2), Level(4)],
    bars={"prefactor": 0.017, "exponent": 0.045},
    # A thin film is not quite what a current of this shape is: its exponent stays 0.003 away.
    orders={"exponent": 0.4},
    measure=measurement("gravity-current", 2, 1.411, 3, 1 / 5, 3 / 11, 20),
    x_label="t [s]",
    y_label="x_N / (g A^3 t / 3 nu)^(1/5)",
)

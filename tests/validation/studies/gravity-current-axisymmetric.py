from studies._similarity import measurement
from study import Level, Study

study = Study(
    name="gravity-current-axisymmetric",
    title="Axisymmetric viscous gravity current",
    levels=[Level(1), Level(2), Level(4)],
    bars={"prefactor": 0.03, "exponent": 0.12},
    published={"prefactor": 0.04, "exponent": 0.32},
    measure=measurement("gravity-current-axisymmetric", 3, 0.894, 3, 1 / 8, 3 / 7, 4),
    x_label="t [s]",
    y_label="R / (g V^3 t / 3 nu)^(1/8)",
)

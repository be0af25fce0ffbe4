from studies._slit import power_law
from study import Level, Study

study = Study(
    name="power-law-slit",
    title="Poiseuille flow of a power-law fluid, n = 0.5",
    levels=[Level(1), Level(2), Level(4)],
    bars={"profile": 0.021, "flow rate": 0.025},
    measure=power_law(4, 0.5),
    x_label="y [m]",
    y_label="u / that in the middle",
)

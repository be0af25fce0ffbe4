from studies._slit import power_law
from study import Level, Study

study = Study(
    name="power-law-slit-thickening",
    title="Poiseuille flow of a power-law fluid, n = 1.5",
    levels=[Level(1), Level(2), Level(4)],
    bars={"profile": 0.013, "flow rate": 0.022},
    measure=power_law(0.1, 1.5),
    x_label="y [m]",
    y_label="u / that in the middle",
    case="power-law-slit.toml",
    settings=("polymer.rheology.flow_index=1.5", "polymer.rheology.consistency=0.1", "polymer.rheology.min_viscosity=1e-3", "time.end=0.6"),
)

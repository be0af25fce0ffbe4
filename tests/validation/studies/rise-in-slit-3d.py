from study import Level, Study
from studies._rise import slit

study = Study(
    name="rise-in-slit-3d",
    title="Rise in a slit in three dimensions",
    levels=[Level(1), Level(2)],
    bars={"rise": 0.09},
    refined=False,
    measure=slit(0.016),
    x_label="t [s]",
    y_label="rise [mm]",
)

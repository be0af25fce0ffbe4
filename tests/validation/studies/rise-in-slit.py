from study import Level, Study
from studies._rise import slit

# Not refined: the level goes on moving, and differs by some 3 % from run to run.
study = Study(
    name="rise-in-slit",
    title="Rise in a slit",
    levels=[Level(1), Level(2)],
    bars={"rise": 0.06},
    refined=False,
    measure=slit(1),
    x_label="t [s]",
    y_label="rise [mm]",
)

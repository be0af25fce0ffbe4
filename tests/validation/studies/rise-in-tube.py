import numpy as np
from study import Level, Study
from studies._rise import rise

radius, outer, tank = 0.008, 0.016, 0.028  # of the tube, of its outer side and of the pool [m]
exact = 2 * 1 * np.cos(np.radians(60)) / (1000 * 10 * radius)  # 2 gamma cos(theta) / (rho g R) [m]


def distance(x):
    return np.hypot(x[:, 0], x[:, 1])


study = Study(
    name="rise-in-tube",
    title="Rise in a tube",
    levels=[Level(1), Level(2)],
    bars={"rise": 0.09},
    refined=False,
    measure=rise(exact, (np.pi * radius**2, lambda x: distance(x) < radius),
                 (np.pi * (tank**2 - outer**2), lambda x: distance(x) > outer)),
    x_label="t [s]",
    y_label="rise [mm]",
)

import numpy as np
from studies._tension import spacing_of
from study import Level, Outcome, Study

width, edge, pool = 0.012, 0.01, (0.014, 0.04)  # of the slit, lower edge of the plates, pool beside them [m]
exact = 2 * 1 * np.cos(np.radians(60)) / (1000 * 10 * width)  # 2 gamma cos(theta) / (rho g w) [m]


def measure(run):
    """Levels are those of the mass above the lower edge of the plates, the rise their difference, as a mean of the last half of
    the run."""
    area = spacing_of(run.frame(0))**2
    rise = []
    for frame in run.frames():
        x, y = frame.position.T
        inside = np.sum((abs(x) < width / 2) & (y > edge)) / width
        around = np.sum((abs(x) > pool[0]) & (y > edge)) / (2 * (pool[1] - pool[0]))
        rise.append((inside - around) * area)
    rise, late = np.array(rise), run.times > run.times[-1] / 2
    mean = rise[late].mean()
    return Outcome({"rise": abs(mean / exact - 1)},
                   {"rise over exact": mean / exact, "scatter of the rise": rise[late].std() / exact},
                   {"particles": (run.times, 1e3 * rise)}, {"exact": (run.times, np.full(len(rise), 1e3 * exact))})


# Not refined: the level goes on moving, and differs by some 3 % from run to run.
study = Study(
    name="rise-in-slit",
    title="Rise in a slit",
    levels=[Level(1), Level(2)],
    bars={"rise": 0.06},
    refined=False,
    measure=measure,
    x_label="t [s]",
    y_label="rise [mm]",
)

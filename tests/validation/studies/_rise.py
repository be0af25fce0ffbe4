"""Fluid that rises between walls which it meets at 60 degrees."""

import numpy as np
from study import Level, Outcome, Study

edge, depth = 0.01, 0.008  # lower edge of the walls, and what is above it of the fluid at the start, on both sides of them [m]


def rise(name, title, bar, width, inside):
    """width: of the slit, or radius of the tube [m]; inside(x): which particles above the edge of the walls are on that side of them,
    parted in the middle of the walls. Levels are those of the mass above that edge, in what the lattice leaves of the section, the
    rise their difference, as a mean of the last half of the run."""
    exact = 2 * 1 * np.cos(np.radians(60)) / (1000 * 10 * width)  # 2 gamma cos(theta) / (rho g w) [m]

    def counts(frame):
        within = inside(frame.position[frame.position[:, -1] > edge])
        return np.array([within.sum(), (~within).sum()])

    def measure(run):
        found = np.array([counts(frame) for frame in run.frames()])
        levels = depth * found / found[0]
        heights, late = levels[:, 0] - levels[:, 1], run.times > run.times[-1] / 2
        mean = heights[late].mean()
        return Outcome({"rise": abs(mean / exact - 1)},
                       {"rise over exact": mean / exact, "scatter of the rise": heights[late].std() / exact},
                       {"particles": (run.times, 1e3 * heights)}, {"exact": (run.times, np.full(len(heights), 1e3 * exact))})

    # Not refined: the level goes on moving, and differs by some 3 % from run to run.
    return Study(name=name, title=title, levels=[Level(1), Level(2)], bars={"rise": bar}, refined=False, measure=measure,
                 x_label="t [s]", y_label="rise [mm]")


def slit(name, title, bar):
    return rise(name, title, bar, 0.012, lambda x: abs(x[:, 0]) < 0.01)

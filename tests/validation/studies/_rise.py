"""Fluid that rises between walls which it meets at 60 degrees."""

import numpy as np
from studies._tension import spacing_of
from study import Outcome

edge = 0.01  # lower edge of the walls [m]


def rise(exact, section, pool):
    """exact: the rise [m]; section: the area of the slit or tube [m2], or its width [m] in two dimensions, and which places above the
    edge of the walls are in it; pool: likewise beside the walls. Levels are those of the mass above that edge, the rise their
    difference, as a mean of the last half of the run."""

    def measure(run):
        volume = spacing_of(run.frame(0))**run.frame(0).position.shape[1]
        heights = []
        for frame in run.frames():
            above = frame.position[frame.position[:, -1] > edge]
            inside, around = (np.sum(holds(above)) / area for area, holds in (section, pool))
            heights.append((inside - around) * volume)
        heights, late = np.array(heights), run.times > run.times[-1] / 2
        mean = heights[late].mean()
        return Outcome({"rise": abs(mean / exact - 1)},
                       {"rise over exact": mean / exact, "scatter of the rise": heights[late].std() / exact},
                       {"particles": (run.times, 1e3 * heights)}, {"exact": (run.times, np.full(len(heights), 1e3 * exact))})

    return measure


def slit(depth):
    """Between plates 12 mm apart and `depth` [m] deep, 1 in two dimensions, in a pool that is 80 mm wide."""
    exact = 2 * 1 * np.cos(np.radians(60)) / (1000 * 10 * 0.012)  # 2 gamma cos(theta) / (rho g w) [m]
    return rise(exact, (0.012 * depth, lambda x: abs(x[:, 0]) < 0.006), (0.052 * depth, lambda x: abs(x[:, 0]) > 0.014))

"""What the flows of fluids with a rheology between two plates at rest share."""

import numpy as np
from study import Outcome

h, wall_stress = 0.01, 20.0  # half of the gap [m], [Pa]


def measurement(profile):
    """Of the last frame. profile(run, distance from the middle / h): the exact velocity [m/s] and its mean."""

    def measure(run):
        frame = run.frame()
        y, u = frame.position[:, 1], frame.velocity[:, 0]
        exact, mean = profile(run, abs(y / h - 1))
        top = profile(run, np.zeros(1))[0][0]
        line = np.linspace(0, 2 * h, 101)
        rows = np.argsort(y)
        return Outcome(
            {"profile": np.sqrt(np.mean((u - exact) ** 2)) / top, "flow rate": abs(u.mean() / mean - 1)},
            {"flow rate / exact": u.mean() / mean, "middle / exact": u.max() / top},
            {"end": (y[rows], u[rows] / top)},
            {"exact": (line, profile(run, abs(line / h - 1))[0] / top)},
        )

    return measure


def power_law(consistency, n):
    top = (wall_stress / consistency) ** (1 / n) * h * n / (n + 1)

    def profile(run, place):
        return top * (1 - place ** ((n + 1) / n)), top * (n + 1) / (2 * n + 1)

    return measurement(profile)

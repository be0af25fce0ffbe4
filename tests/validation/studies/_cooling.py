"""A layer that cools through its free surface, at some Biot number."""

import numpy as np
from study import Level, Outcome, Study

H, diffusivity, ambient, excess = 0.02, 1e-3, 300.0, 100.0  # [m], [m2/s], [K]


def roots(biot, count=60):
    """Of z tan z = biot, one in each (n pi, n pi + pi / 2)."""
    low, high = np.arange(count) * np.pi, np.arange(count) * np.pi + np.pi / 2
    for _ in range(80):
        middle = (low + high) / 2
        below = middle * np.sin(middle) * np.sign(np.cos(low + 1e-9)) < biot * np.cos(middle) * np.sign(np.cos(low + 1e-9))
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return low


def study(name, biot, bars):
    z = roots(biot)[:, None]

    def exact(y, t):
        series = 4 * np.sin(z) / (2 * z + np.sin(2 * z)) * np.cos(z * y / H) * np.exp(-(z**2) * diffusivity * t / H**2)
        return ambient + excess * series.sum(0)

    def measure(run):
        errors, curves, solutions = {}, {}, {}
        line = np.linspace(0, H, 101)
        for number, t in ((1, 0.1), (4, 0.4)):
            frame = run.frame(number)
            y, T = frame.position[:, 1], frame.temperature
            errors[f"t = {t:g} s"] = np.sqrt(np.mean((T - exact(y, t)) ** 2)) / excess
            rows = np.argsort(y)
            curves[f"{t:g} s"] = (y[rows], T[rows])
            solutions[f"exact, {t:g} s"] = (line, exact(line, t))
        return Outcome(errors, {}, curves, solutions)

    return Study(
        name=name,
        title=f"Cooling through a free surface, Biot number {biot:g}",
        levels=[Level(1), Level(2), Level(4)],
        bars=bars,
        measure=measure,
        x_label="y [m]",
        y_label="T [K]",
        case="cooled-slab.toml",
        settings=(f"heat.heat_transfer={50 * biot:g}",),
    )

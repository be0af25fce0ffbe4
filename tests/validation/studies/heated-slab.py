import numpy as np
from study import Level, Outcome, Study

H, diffusivity, cold, rise = 0.02, 1e-3, 300.0, 100.0  # plates [m], [m2/s], [K]


def exact(y, t):
    n = np.arange(1, 200)[:, None]
    series = np.sum(np.sin(n * np.pi * y / H) / n * np.exp(-((n * np.pi / H) ** 2) * diffusivity * t), 0)
    return cold + rise * (1 - y / H - 2 / np.pi * series)


def measure(run):
    errors, curves, solutions = {}, {}, {}
    line = np.linspace(0, H, 101)
    for number, t in ((1, 0.02), (5, 0.1)):
        frame = run.frame(number)
        y, T = frame.position[:, 1], frame.temperature
        errors[f"t = {t:g} s"] = np.sqrt(np.mean((T - exact(y, t)) ** 2)) / rise
        rows = np.argsort(y)
        curves[f"{t:g} s"] = (y[rows], T[rows])
        solutions[f"{t:g} s"] = (line, exact(line, t))
    return Outcome(errors, {}, curves, solutions)


study = Study(
    name="heated-slab",
    title="Conduction between two plates",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.02 s": 0.02, "t = 0.1 s": 0.01},
    measure=measure,
    x_label="y [m]",
    y_label="T [K]",
)

import numpy as np
from study import Level, Outcome, Study
from treacle_data import read_table

depth, growth = 0.02, 0.06  # [m]
density, g = 1000.0, 9.81


def exact(t):
    return depth * (1 + growth * np.minimum(t, 1))


def measure(run):
    table = read_table(run.path / "probes" / "level.csv")
    t, level = table["time"], table["height"]
    late = t > 1.2
    frame = run.frame()
    middle = np.mean(frame.position[:, 1])
    errors = {
        "level": abs(np.mean(level[late]) / exact(1.2) - 1),
        "centre of mass": abs(middle / (exact(1.2) / 2) - 1),
        "level at 0.5 s": abs(np.interp(0.5, t, level) / exact(0.5) - 1),
    }
    line = np.linspace(0, t[-1], 101)
    return Outcome(errors, {"level / exact": np.mean(level[late]) / exact(1.2)}, {"level": (t, level)}, {"exact": (line, exact(line))})


study = Study(
    name="expanding-tank",
    title="Level of a fluid that expands",
    levels=[Level(1), Level(2), Level(4)],
    bars={"level": 0.01, "centre of mass": 0.01, "level at 0.5 s": 0.01},
    measure=measure,
    x_label="t [s]",
    y_label="level [m]",
)

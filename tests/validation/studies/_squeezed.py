"""What the studies of fluid between plates that close share: the fall of the pressure from the middle outwards."""

import numpy as np
from study import Level, Outcome, Study
from treacle_data import read_table

gap, speed = 4e-3, 1e-3  # at the start [m], of the upper plate [m/s]
middle, outside = (-2e-3, 2e-3), (14e-3, 18e-3)  # patches of the lower plate [m]
after = 0.1  # from when on pressures count [s]


def fall(gradient, h):
    """Between the means over the patches [Pa]; gradient(x, h): dp/dx at x > 0 with a gap of h [Pa/m]."""
    x = np.linspace(0, outside[1], 1801)
    slope = gradient(x, h)
    p = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(x))])
    mean = [p[(x >= max(a, 0)) & (x <= b)].mean() for a, b in (middle, outside)]
    return mean[0] - mean[1]


def study(name, title, gradient, bar, settings=(), refined=True):
    def measure(run):
        probes = [read_table(run.path / "probes" / f"{patch}.csv") for patch in ("middle", "outside")]
        t = probes[0]["time"]
        found = probes[0]["pressure"] - probes[1]["pressure"]
        exact = np.array([fall(gradient, gap - speed * at) for at in t])
        counts = t > after
        off = found[counts] / exact[counts] - 1
        force = run.balance["upper plate_force_y"][run.balance["time"] > after]
        return Outcome(
            {"fall of the pressure": np.sqrt(np.mean(off**2))},
            {"fall / exact": np.mean(off) + 1, "force at the end [N/m]": force[-10:].mean()},
            {"treacle": (t, found)},
            {"theory": (t, exact)},
        )

    return Study(
        name=name,
        title=title,
        case="squeezed-film.toml",
        settings=settings,
        levels=[Level(1), Level(2), Level(4)],
        bars={"fall of the pressure": bar},
        measure=measure,
        x_label="t [s]",
        y_label="pressure in the middle over that 16 mm outside [Pa]",
        refined=refined,
    )

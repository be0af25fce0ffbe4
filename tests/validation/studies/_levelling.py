"""Films that level out by gravity and surface tension, overdamped, whatever the length of their wave."""

import numpy as np
from study import Level, Outcome, Study

depth = 0.02  # mean depth [m]
weight, viscosity, tension = 1000 * 1, 10, 1  # rho g [N/m3], mu [Pa s], gamma [N/m]


def levelling(name, title, length, settings=(), bar=0.04, refined=True):
    """`length`: of the wave [m]."""
    k = 2 * np.pi / length
    x = k * depth
    exact_rate = (weight + tension * k**2) / (2 * viscosity * k) * (np.sinh(x) * np.cosh(x) - x) / (np.cosh(x) ** 2 + x**2)

    def measure(run):
        """The amplitude is that of the mass above each x."""
        times = run.times
        a = np.array([np.cos(k * frame.position[:, 0]).sum() for frame in run.frames()])
        a /= a[0]
        fitted = (times * exact_rate > 0.1) & (times * exact_rate < 0.8)
        rate = -np.polyfit(times[fitted], np.log(a[fitted]), 1)[0]
        values = {f"rate [1/s] (exact {exact_rate:.4g})": rate}
        return Outcome({"rate": abs(rate / exact_rate - 1)}, values, {"particles": (times, a)},
                       {"exact": (times, np.exp(-exact_rate * times))})

    return Study(name=name, title=title, case="levelling-film.toml", settings=settings, levels=[Level(1), Level(2), Level(4)],
                 bars={"rate": bar}, refined=refined, measure=measure, x_label="t [s]", y_label="amplitude over that at the start")


def long_wave(name, title, length, end, interval, bar):
    ends = [f"domain.max=[{length},0.026]", f"layer.max=[{length},0.025]", f"floor.max=[{length},0]",
            f"layer.where=y < 0.02 + 0.001*cos(2*pi*x/{length})", f"time.end={end}", f"output.interval={interval}"]
    # Not refined: x1 is below 1 % already, and particles of long runs on fine lattices gather, which lessens the tension.
    return levelling(name, title, length, tuple(ends), bar, refined=False)

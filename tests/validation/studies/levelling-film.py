import numpy as np
from study import Level, Outcome, Study

length, depth = 0.064, 0.02  # wave length, mean depth [m]
weight, viscosity, tension = 1000 * 1, 10, 1  # rho g [N/m3], mu [Pa s], gamma [N/m]
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


study = Study(
    name="levelling-film",
    title="Levelling of a film by surface tension and gravity",
    levels=[Level(1), Level(2), Level(4)],
    bars={"rate": 0.06},
    measure=measure,
    x_label="t [s]",
    y_label="amplitude over that at the start",
)

import numpy as np
from study import Level, Outcome, Study

length, depth = 0.064, 0.032  # wave length, of each layer [m]
mu, density, gravity = (10, 1), (1000, 100), 10  # of the upper and the lower layer
k = 2 * np.pi / length


def speed_of_interface(rate):
    """Per unit of its height, in two layers between no-slip walls where all grows with this rate. The vertical velocity times
    exp(-i k x) is a sum of cosh kz, sinh kz, cosh mz and sinh mz in each layer, m^2 = k^2 + rho rate / mu, z from the interface; the
    horizontal one, the shear stress and the normal stress follow from it."""

    def derivatives(layer, z):
        m = np.sqrt(k**2 + density[layer] * rate / mu[layer])
        values = []
        for q in (k, m):
            pair = np.cosh(q * z), np.sinh(q * z)
            values += [[q**order * pair[(order + odd) % 2] for order in range(4)] for odd in (0, 1)]
        return np.array(values).T

    def normal(layer):
        _, first, _, third = derivatives(layer, 0)
        return ((3 * mu[layer] * k**2 + density[layer] * rate) * first - mu[layer] * third) / k**2

    def shear(layer):
        value, _, second, _ = derivatives(layer, 0)
        return mu[layer] * (second + k**2 * value)

    none = np.zeros(4)
    walls = [np.append(row, none) for row in derivatives(0, depth)[:2]] + [np.append(none, row) for row in derivatives(1, -depth)[:2]]
    meeting = [np.append(upper, -lower) for upper, lower in zip(derivatives(0, 0)[:2], derivatives(1, 0)[:2], strict=True)]
    stresses = [np.append(stress(0), -stress(1)) for stress in (shear, normal)]
    load = np.zeros(8)
    load[7] = -(density[0] - density[1]) * gravity
    return derivatives(0, 0)[0] @ np.linalg.solve(np.array(walls + meeting + stresses), load)[:4]


def growth_rate():
    rate = (density[0] - density[1]) * gravity / (2 * k * sum(mu))  # of deep layers without inertia
    for _ in range(30):
        rate = speed_of_interface(rate)
    return rate


exact_rate = growth_rate()


def amplitude(frame):
    """That of the light fluid's mass above each x."""
    light = frame.position[frame.material == 1, 0]
    return 2 / length * (2 * length * depth / len(frame.position)) * np.cos(k * light).sum()


def measure(run):
    """The rate is that of the logarithm of the amplitude while it grows by half, from where the start from rest is over."""
    times, a = run.times, np.array([amplitude(f) for f in run.frames()])
    fitted = (times > 0.019) & (a < 1.5 * a[0])
    rate = np.polyfit(times[fitted], np.log(a[fitted]), 1)[0]
    values = {f"rate [1/s] (exact {exact_rate:.4g})": rate, "k times the amplitude at the start": k * a[0]}
    return Outcome({"rate": abs(rate / exact_rate - 1)}, values, {"particles": (times, a / a[0])},
                   {"exact": (times, np.exp(exact_rate * times))})


study = Study(
    name="rayleigh-taylor",
    title="Viscous Rayleigh-Taylor instability",
    levels=[Level(1), Level(2), Level(4)],
    bars={"rate": 0.05},
    published={"rate": 0.5},
    measure=measure,
    x_label="t [s]",
    y_label="amplitude over that at the start",
)

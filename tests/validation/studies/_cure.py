"""A resin that cures at one temperature or by its own heat: the conversion against the rate equation."""

import numpy as np
from study import Level, Outcome, Study

gas_constant, start = 8.31446261815324, 360.0  # [J/(mol K)], [K]


def rate(s, T):
    own, helped = 2e5 * np.exp(-6e4 / (gas_constant * T)), 4e6 * np.exp(-5.5e4 / (gas_constant * T))
    return (own + helped * s**0.8) * max(0.95 - s, 0) ** 1.4


def exact(times, warming):
    """Conversions, by steps of fourth order; T = 360 K + warming s."""
    h, s, t, found = 1e-3, 0.0, 0.0, []

    def f(s):
        return rate(s, start + warming * s)

    for end in times:
        while t < end - h / 2:
            a = f(s)
            b = f(s + h / 2 * a)
            c = f(s + h / 2 * b)
            s, t = s + h / 6 * (a + 2 * b + 2 * c + f(s + h * c)), t + h
        found.append(s)
    return np.array(found)


def study(name, title, heat, settings):
    warming = heat / 1500

    def measure(run):
        frames = [run.frame(k) for k in range(len(run.times))]
        solution = exact(run.times, warming)
        found = np.array([np.mean(f.cure) for f in frames])
        spread = max(np.ptp(f.cure) for f in frames)
        T = np.array([np.mean(f.temperature) for f in frames])
        errors = {"conversion": np.max(abs(found - solution)) / 0.95, "spread": spread}
        if heat > 0:
            balance = run.balance
            gained, steps = np.diff(balance["heat_energy"]), np.diff(balance["time"])
            given = steps * (balance["viscous_heating"] + balance["heat_from_states"])[1:]
            errors["temperature"] = np.max(abs(T - start - warming * solution)) / warming
            errors["balance"] = np.max(abs(gained - given)) / np.sum(given)
        return Outcome(errors, {"conversion at the end": found[-1]}, {"measured": (run.times, found)},
                       {"exact": (run.times, solution)})

    bars = {"conversion": 1e-3, "spread": 1e-3} | ({"temperature": 1e-3, "balance": 1e-7} if heat > 0 else {})
    return Study(
        name=name,
        title=title,
        levels=[Level(1), Level(2)],
        bars=bars,
        measure=measure,
        x_label="t [s]",
        y_label="conversion",
        case="cure.toml",
        settings=settings,
        refined=False,
    )

"""Neumann's solution of freezing from a plate: a front that moves as the root of time, with the conductivity and the heat of solid and
liquid (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed., 1959, sec. 11.2). Densities are the same."""

from math import erf, erfc, exp, pi, sqrt

import numpy as np
from study import Level, Outcome, Study

density, latent, plate, melting = 1000.0, 5e4, 290.0, 330.0  # [kg/m3], [J/kg], [K]
solid, liquid = (3.0, 1000.0), (1.0, 2000.0)  # conductivity [W/(m K)] and specific heat [J/(kg K)]
solidus, liquidus = 329.9, 330.1  # [K]
height, end = 0.05, 100  # [m], [s]


def diffusivity(of):
    return of[0] / (density * of[1])


def growth(start):
    """lambda of the front 2 lambda sqrt(a t), with the diffusivity a of the solid, for a liquid of a temperature."""
    ratio = sqrt(diffusivity(solid) / diffusivity(liquid))
    warm = liquid[0] / solid[0] * ratio * (start - melting) / (melting - plate)

    def left(x):
        return (
            exp(-(x**2)) / erf(x)
            - warm * exp(-((x * ratio) ** 2)) / erfc(x * ratio)
            - x * latent * sqrt(pi) / (solid[1] * (melting - plate))
        )

    low, high = 1e-6, 2.0
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if left(middle) > 0 else (low, middle)
    return low


def exact(y, t, start):
    rate, ratio = growth(start), sqrt(diffusivity(solid) / diffusivity(liquid))
    far = y / (2 * sqrt(diffusivity(solid) * t))
    erfs = np.vectorize(erf)
    frozen = plate + (melting - plate) * erfs(far) / erf(rate)
    molten = start - (start - melting) * (1 - erfs(far * ratio)) / erfc(rate * ratio)
    return np.where(far < rate, frozen, molten)


def study(name, title, start, bars, settings=()):
    """bars: of the place of the front, relative, and of the temperatures, in parts of what the solid spans."""

    def measure(run):
        values, curves, solutions = {}, {}, {}
        line = np.linspace(0, height, 101)
        for number, t in ((1, 25), (4, end)):
            frame = run.frame(number)
            y, T = frame.position[:, 1], frame.temperature
            share = np.clip((liquidus - T) / (liquidus - solidus), 0, 1)
            front, found = 2 * growth(start) * sqrt(diffusivity(solid) * t), share.mean() * height
            values[f"front / exact, t = {t:g} s"] = found / front
            if t == end:
                errors = {
                    "front": abs(found / front - 1),
                    "temperature": np.sqrt(np.mean((T - exact(y, t, start)) ** 2)) / (melting - plate),
                }
            rows = np.argsort(y)
            curves[f"{t:g} s"] = (y[rows], T[rows])
            solutions[f"exact, {t:g} s"] = (line, exact(line, t, start))
        return Outcome(errors, values, curves, solutions)

    return Study(
        name=name,
        title=title,
        case="stefan-freezing.toml",
        settings=settings,
        levels=[Level(1), Level(2), Level(4)],
        bars=bars,
        measure=measure,
        x_label="y [m]",
        y_label="T [K]",
    )

"""Filaments of an Oldroyd-B fluid that hang from a ceiling: each row of particles bears the weight of what is below it."""

import numpy as np
from study import Outcome

density, gravity = 100.0, 200.0  # [kg/m3], [m/s2]
solvent, polymer, relaxation = 50.0, 150.0, 0.2  # [Pa s], [Pa s], [s]


def exact(below, times, dimensions, steps=6000):
    """Stretch and its rate [1/s] at the times of rows that bear the weight of a length `below` [m]. The stress along the filament is
    that weight times the stretch, as the cross-section shrinks; inertia, which delays the start by rho L^2 / eta, is neglected.
    Integrated with the midpoint rule."""
    side = 1 / (dimensions - 1)  # rate of strain across over that along, negative
    modulus, trouton = polymer / relaxation, 2 * (1 + side)

    def rates(state):
        stretch, along, across = state
        rate = (density * gravity * below * stretch - modulus * (along - across)) / (trouton * solvent)
        stretched = 2 * rate * along - (along - 1) / relaxation, -2 * side * rate * across - (across - 1) / relaxation
        return rate, np.array([rate * stretch, *stretched])

    state, dt = np.ones((3, len(below))), times[-1] / steps
    found = []
    for k in range(steps + 1):
        if np.min(abs(k * dt - times)) < dt / 2:
            found.append((state[0].copy(), rates(state)[0]))
        state = state + dt * rates(state + dt / 2 * rates(state)[1])[1]
    return found


def measurement(dimensions, length, width):
    """measure() of a filament of this length and width [m]. Rows nearer than the width to the tip, and 1.5 widths to the ceiling, are left
    out."""

    def measure(run):
        start = run.frame(0)
        heights = start.position[:, -1]
        rows = np.unique(heights.round(9))
        of = [abs(heights - row) < 1e-8 for row in rows]
        above = rows[1:-1] + length  # the tip
        middle = (above > width) & (above < length - 1.5 * width)
        numbers = (1, 3, 6)
        times = run.times[list(numbers)]
        solutions = exact(above[middle], times, dimensions)
        errors, curves, lines = {}, {}, {}
        for number, (t, (stretch, rate)) in zip(numbers, zip(times, solutions, strict=True), strict=True):
            frame = run.frame(number)
            height = np.array([frame.position[k, -1].mean() for k in of])
            speed = np.array([frame.velocity[k, -1].mean() for k in of])
            apart = height[2:] - height[:-2]
            found = (apart / (rows[2:] - rows[:-2]))[middle]
            found_rate = ((speed[2:] - speed[:-2]) / apart)[middle]
            errors[f"elongation at {t:g} s"] = np.sqrt(np.mean((found - stretch) ** 2) / np.mean((stretch - 1) ** 2))
            if number == numbers[-1]:
                errors[f"rate of strain at {t:g} s"] = np.sqrt(np.mean((found_rate - rate) ** 2) / np.mean(rate**2))
            curves[f"{t:g} s"] = (above[middle] * 1e3, found)
            lines[f"exact, {t:g} s"] = (above[middle] * 1e3, stretch)
        return Outcome(errors, {"longest stretch": found.max()}, curves, lines)

    return measure

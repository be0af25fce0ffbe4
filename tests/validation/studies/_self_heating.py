"""Couette flow that heats itself between two plates of one temperature."""

import numpy as np
from study import Outcome, Study

H, U, mu, k, wall = 0.02, 0.2, 10.0, 0.1, 300.0  # plates [m], [m/s], [Pa s], [W/(m K)], [K]
most = mu * U**2 / (8 * k)  # in the middle [K]


def exact(y):
    return wall + 4 * most * y / H * (1 - y / H)


def measure(run):
    frame, balance = run.frame(), run.balance
    y, T = frame.position[:, 1], frame.temperature
    line, rows = np.linspace(0, H, 101), np.argsort(y)
    steps = np.diff(balance["time"])
    gained = np.diff(balance["heat_energy"])
    given = steps * (balance["viscous_heating"] + balance["heat_from_walls"] + balance["heat_from_surface"])[1:]
    heated = np.sum(steps * balance["viscous_heating"][1:])
    errors = {
        "profile": np.sqrt(np.mean((T - exact(y)) ** 2)) / most,
        "middle": abs((T.max() - wall) / most - 1),
        "balance": np.max(abs(gained - given)) / heated,
    }
    return Outcome(errors, {"middle / exact": (T.max() - wall) / most}, {"end": (y[rows], T[rows])}, {"exact": (line, exact(line))})


def study(name, title, levels, bars, more=lambda balance: {}):
    """`more`: further errors, from the balance."""

    def measured(run):
        outcome = measure(run)
        outcome.errors.update(more(run.balance))
        return outcome

    return Study(name=name, title=title, levels=levels, bars=bars, measure=measured, x_label="y [m]", y_label="T [K]")

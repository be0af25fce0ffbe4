import numpy as np
from study import Level, Outcome, Study

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
        "dissipation": np.max(abs(balance["viscous_heating"] / balance["shear_dissipation"] - 1)),
    }
    return Outcome(errors, {"middle / exact": (T.max() - wall) / most}, {"end": (y[rows], T[rows])}, {"exact": (line, exact(line))})


study = Study(
    name="heated-couette",
    title="Viscous heating in Couette flow",
    levels=[Level(1), Level(2), Level(4)],
    bars={"profile": 0.02, "middle": 0.02, "balance": 1e-7, "dissipation": 1e-12},
    measure=measure,
    x_label="y [m]",
    y_label="T [K]",
)

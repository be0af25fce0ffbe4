"""Velocities and stresses against the exact solution (N. D. Waters, M. J. King, Rheol. Acta 9, 1970).
The solution is a Fourier series; each mode is taken by itself."""

import numpy as np
from study import Level, Outcome, Study

H, g, density, solvent, polymer, relaxation = 0.02, 10.0, 1000.0, 1.0, 9.0, 0.1
largest = density * g * H**2 / 8 / (solvent + polymer)  # of the steady flow [m/s]


def exact(y, t):
    """rho u' = rho g_n - mu_s k^2 u - k s, s' = (mu_p k u - s) / lambda for each mode sin(k y)."""
    u = np.zeros_like(y)
    for n in range(1, 200, 2):
        k, drive = n * np.pi / H, 4 * g / (n * np.pi)
        system = np.array([[-solvent * k**2 / density, -k / density], [polymer * k / relaxation, -1 / relaxation]])
        end = -np.linalg.solve(system, np.array([drive, 0.0]))
        values, vectors = np.linalg.eig(system.astype(complex))
        start = np.linalg.solve(vectors, -end.astype(complex))
        u += (end[0] + (vectors @ (start * np.exp(values * t)))[0].real) * np.sin(k * y)
    return u


def measure(run):
    times = run.times
    middle, solution, curves, solutions = [], [], {}, {}
    squares = 0.0
    for k, t in enumerate(times):
        frame = run.frame(k)
        y, u = frame.position[:, 1], frame.velocity[:, 0]
        middle.append(np.max(u)), solution.append(exact(np.array([H / 2]), t)[0])
        squares += np.mean((u - exact(y, t)) ** 2) / len(times)
    steady = run.frame()
    y, u = steady.position[:, 1], steady.velocity[:, 0]
    rate = density * g * (H / 2 - y) / (solvent + polymer)
    wall = density * g * H / 2 / (solvent + polymer)
    first = 2 * polymer * relaxation
    errors = {
        "velocity": np.sqrt(squares) / largest,
        "steady velocity": np.sqrt(np.mean((u - exact(y, steady.time)) ** 2)) / largest,
        "shear stress": np.sqrt(np.mean((steady.elastic_stress_xy - polymer * rate) ** 2)) / (polymer * wall),
        "first normal stress": np.sqrt(np.mean((steady.elastic_stress_xx - steady.elastic_stress_yy - first * rate**2) ** 2))
        / (first * wall**2),
    }
    curves["measured"], solutions["exact"] = (times, np.array(middle)), (times, np.array(solution))
    return Outcome(errors, {"overshoot": max(middle) / largest}, curves, solutions)


study = Study(
    name="elastic-poiseuille",
    title="Start-up of an elastic fluid between plates",
    levels=[Level(1), Level(2), Level(4)],
    bars={"velocity": 0.1, "steady velocity": 0.03, "shear stress": 0.03, "first normal stress": 0.05},
    measure=measure,
    x_label="t [s]",
    y_label="u in the middle [m/s]",
    orders={"velocity": 0.7, "steady velocity": 0.7, "shear stress": 0.4, "first normal stress": 0.4},
)

"""What the studies of the elliptic drop share: its exact solution, and what of it is measured."""

import numpy as np
from study import Outcome

R, A, rho = 1.0, 1.0, 1e3  # radius [m], rate of strain at the start [1/s], [kg/m3]


def exact(times):
    """Semi-axes a along x, b along y and rate of strain: with u = (-A x, A y) and the pressure that is zero on the ellipse,
    a' = -A a, b' = A b, A' = A^2 (a^2 - b^2) / (a^2 + b^2), by Runge-Kutta steps. Columns a, b, A."""
    def rate(state):
        a, b, strain = state
        return np.array([-strain * a, strain * b, strain**2 * (a**2 - b**2) / (a**2 + b**2)])
    rows, state, now = [], np.array([R, R, A]), 0.0
    for t in times:
        steps = max(1, int(np.ceil((t - now) / 1e-3)))
        dt = (t - now) / steps
        for _ in range(steps):
            k1 = rate(state)
            k2 = rate(state + dt / 2 * k1)
            k3 = rate(state + dt / 2 * k2)
            k4 = rate(state + dt * k3)
            state = state + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        now = t
        rows.append(state)
    return np.array(rows).T


def measure(run):
    """Semi-axes from the second moments, relative to those at the start, since a disc of a lattice is not quite round; pressures
    and velocities in axes along and across the direction in which the particles stretch at the start."""
    first = run.frame(0)
    along = first.velocity[np.argmax((first.position * first.velocity).sum(axis=1))]
    along = along / np.linalg.norm(along)
    axes = np.array([[along[1], -along[0]], along]).T
    moments = np.array([((f.position @ axes) ** 2).mean(axis=0) for f in run.frames()])
    a, b = R * np.sqrt(moments / moments[0]).T
    a_exact, b_exact, strain = exact(run.times)
    errors = {}
    for t in (0.5, 1.0):
        k = int(np.argmin(abs(run.times - t)))
        errors[f"long axis, t = {run.times[k]:g} s"] = abs(b[k] / b_exact[k] - 1)
        errors[f"short axis, t = {run.times[k]:g} s"] = abs(a[k] / a_exact[k] - 1)
    end = run.frame()
    flow = strain[-1] * (end.position @ axes) * [-1, 1]
    errors["velocity, t = 1 s"] = np.sqrt(((end.velocity @ axes - flow) ** 2).sum() / (flow**2).sum())
    k = int(np.argmin(abs(run.times - 0.5)))
    frame = run.frame(k)
    x, y = (frame.position @ axes).T
    # From A' + A^2 = 2 P / b^2 and A^2 - A' = 2 P / a^2, p = rho P (1 - x^2 / a^2 - y^2 / b^2).
    top = rho * strain[k] ** 2 / (1 / a_exact[k] ** 2 + 1 / b_exact[k] ** 2)
    pressure = top * np.maximum(0, 1 - (x / a_exact[k]) ** 2 - (y / b_exact[k]) ** 2)
    errors["pressure, t = 0.5 s"] = np.sqrt(np.mean((frame.pressure - pressure) ** 2)) / top
    energy = run.history["kinetic_energy"]
    values = {"area / exact": a[-1] * b[-1] / R**2, "kinetic energy / first": energy[-1] / energy[0],
              "mean density at the end": run.history["mean_density"][-1]}
    return Outcome(errors, values, {"long axis": (run.times, b), "short axis": (run.times, a)},
                   {"exact, long": (run.times, b_exact), "exact, short": (run.times, a_exact)})

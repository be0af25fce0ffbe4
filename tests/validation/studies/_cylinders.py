"""What the studies of Taylor-Couette flow measure: velocities and torques on the cylinders, in the second half of a run."""

import numpy as np
from study import Outcome

inner, outer, spin, mu = 0.01, 0.02, 10.0, 1.0  # radii [m], of the inner cylinder [rad/s], viscosity [Pa s]
B = spin * inner**2 * outer**2 / (outer**2 - inner**2)  # u = A r + B / r
A = -B / outer**2


def polar(frames):
    """Distances from the axis, velocities along and across the circles, of all particles of all frames."""
    position = np.concatenate([frame.position for frame in frames])
    velocity = np.concatenate([frame.velocity for frame in frames])
    r = np.sqrt((position**2).sum(axis=1))
    turned = position[:, 0] * velocity[:, 1] - position[:, 1] * velocity[:, 0]
    return r, turned / r, (position * velocity).sum(axis=1) / r


def measure(run):
    half = run.times[-1] / 2
    r, along, across = polar([frame for frame in run.frames() if frame.time > half])
    late = run.balance["time"] > half
    exact = 4 * np.pi * mu * B  # torque per metre [N]
    torques = {name: sign * np.mean(run.balance[f"{name}_torque"][late]) / exact for name, sign in (("inner", -1), ("outer", 1))}
    errors = {"velocity": np.sqrt(np.mean((along - A * r - B / r) ** 2 + across**2)) / (spin * inner)}
    errors |= {f"torque, {name}": abs(torque - 1) for name, torque in torques.items()}
    values = {f"torque / exact, {name}": torque for name, torque in torques.items()}
    r, along, _ = polar([run.frame()])
    rows, line = np.argsort(r), np.linspace(inner, outer, 101)
    return Outcome(errors, values, {"particles": (r[rows], along[rows] / (spin * inner))},
                   {"exact": (line, (A * line + B / line) / (spin * inner))})

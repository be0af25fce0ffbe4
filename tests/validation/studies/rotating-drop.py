import numpy as np
from studies import _rotation
from study import Level, Study


def measure(run):
    """Rigid rotation is an exact solution of the disc; its pressure, -rho omega^2 (R^2 - r^2) / 2, is a tension."""
    outcome = _rotation.measure(run)
    times, speed = outcome.curves["angular velocity"]
    outcome.errors["angular velocity"] = abs(speed[-1] - 1)
    outcome.exact["exact"] = (times, np.ones_like(times))
    # Each step moves a particle along the tangent, by which the square of its radius r gains (omega dt r)^2.
    step = run.history["time_step"][0]
    outcome.exact["moved along tangents"] = (times, 1 / np.sqrt(1 + 2 * (2 * np.pi) ** 2 * step * times))
    return outcome


study = Study(
    name="rotating-drop",
    title="Free rotating disc",
    levels=[Level(1), Level(2), Level(4)],
    # Forces in the middle of a step take omega^2 dt / 2 of it a second.
    bars={"angular momentum": 0.04, "momentum": 1e-7, "angular velocity": 0.045},
    published={"angular momentum": 2e-7, "angular velocity": 0.1},
    measure=measure,
    x_label="t [s]",
    y_label="angular velocity over that at the start",
)

import numpy as np
from study import Level, Outcome, Study

H, U, nu = 0.02, 0.01, 1e-3  # gap [m], speed of the plate [m/s], kinematic viscosity [m2/s]


def exact(y, t):
    """Fourier series of the start-up: u(y, t) / U."""
    n = np.arange(1, 200)[:, None]
    decay = np.exp(-((n * np.pi / H) ** 2) * nu * t)
    return y / H + (2 / np.pi * (-1.0) ** n / n * decay * np.sin(n * np.pi * y / H)).sum(axis=0)


def measure(run):
    errors, curves, solutions = {}, {}, {}
    for t in (0.02, 0.08):
        frame = run.frame(int(np.argmin(abs(run.times - t))))
        y, u = frame.position[:, 1], frame.velocity[:, 0] / U
        errors[f"t = {frame.time:g} s"] = np.sqrt(np.mean((u - exact(y, frame.time)) ** 2))
        rows = np.argsort(y)
        curves[f"t = {frame.time:g} s"] = (y[rows], u[rows])
        line = np.linspace(0, H, 101)
        solutions[f"exact, t = {frame.time:g} s"] = (line, exact(line, frame.time))
    return Outcome(errors, {}, curves, solutions)


study = Study(
    name="couette",
    title="Start-up of plane Couette flow",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.02 s": 0.1, "t = 0.08 s": 0.1},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

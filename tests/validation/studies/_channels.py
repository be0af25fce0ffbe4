"""What the flows between two plates share: exact solutions, and profiles at some times against them."""

import numpy as np

H, nu = 0.02, 1e-3  # gap [m], viscosity [m2/s]


def couette(y, t):
    """Fourier series of the start-up where the upper plate moves at U: u(y, t) / U."""
    n = np.arange(1, 200)[:, None]
    decay = np.exp(-((n * np.pi / H) ** 2) * nu * t)
    return y / H + (2 / np.pi * (-1.0) ** n / n * decay * np.sin(n * np.pi * y / H)).sum(axis=0)


def poiseuille(y, t):
    """Fourier series of the start-up where gravity drives the fluid: u(y, t) over the steady speed in the middle."""
    n = np.arange(1, 400, 2)[:, None]
    decay = np.exp(-((n * np.pi / H) ** 2) * nu * t)
    return 4 * y / H * (1 - y / H) - (32 / (n * np.pi) ** 3 * decay * np.sin(n * np.pi * y / H)).sum(axis=0)


def profiles(run, times, exact, gap, unit):
    """Errors, curves and exact curves of u / unit over y at the frames nearest to the times [s]; exact(y, t): that ratio."""
    errors, curves, solutions = {}, {}, {}
    for t in times:
        frame = run.frame(int(np.argmin(abs(run.times - t))))
        y, u = frame.position[:, 1], frame.velocity[:, 0] / unit
        label = f"t = {frame.time:g} s"
        errors[label] = np.sqrt(np.mean((u - exact(y, frame.time)) ** 2))
        rows = np.argsort(y)
        curves[label] = (y[rows], u[rows])
        line = np.linspace(0, gap, 101)
        solutions[f"exact, {label}"] = (line, exact(line, frame.time))
    return errors, curves, solutions

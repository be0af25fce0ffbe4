"""What the flows between two plates share: profiles at some times against the exact ones."""

import numpy as np


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

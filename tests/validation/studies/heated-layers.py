import numpy as np
from study import Level, Outcome, Study

h, cold, rise = 0.01, 300.0, 100.0  # of each layer [m], [K]
conductivity, capacity = np.array([1.0, 10.0]), np.array([1e3, 2e3])  # [W/(m K)], [J/(m3 K)]
slow = h / np.sqrt(conductivity / capacity)  # [s^1/2]


def modes(count):
    """Eigenfunctions of both layers: the roots beta of the condition at the interface."""
    ease = np.sqrt(conductivity * capacity)

    def condition(beta):
        a, b = beta * slow[0], beta * slow[1]
        return ease[0] * np.cos(a) * np.sin(b) + ease[1] * np.sin(a) * np.cos(b)

    grid = np.linspace(1e-3, 1.2 * np.pi * count / slow.sum(), 200 * count)
    values = condition(grid)
    roots = []
    for k in np.flatnonzero(values[:-1] * values[1:] < 0)[:count]:
        low, high = grid[k], grid[k + 1]
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if condition(low) * condition(middle) > 0 else (low, middle)
        roots.append(low)
    return np.array(roots)


def mode(beta, y):
    share = np.sin(beta * slow[0]) / np.sin(beta * slow[1])
    return np.where(y < h, np.sin(beta * slow[0] * y / h), share * np.sin(beta * slow[1] * (2 * h - y) / h))


def steady(y):
    resistance = h / conductivity
    flux = rise / resistance.sum()
    return np.where(y < h, rise - flux * y / conductivity[0], flux * (2 * h - y) / conductivity[1])


def exact(y, t):
    line = (np.arange(20000) + 0.5) * 2 * h / 20000
    weight = np.where(line < h, capacity[0], capacity[1])
    total = steady(y)
    for beta in modes(60):
        shape = mode(beta, line)
        amplitude = -np.sum(weight * shape * steady(line)) / np.sum(weight * shape**2)
        total = total + amplitude * mode(beta, y) * np.exp(-(beta**2) * t)
    return cold + total


def measure(run):
    errors, curves, solutions = {}, {}, {}
    line = np.linspace(0, 2 * h, 101)
    for number, t in ((1, 0.01), (4, 0.04)):
        frame = run.frame(number)
        y, T = frame.position[:, 1], frame.temperature
        errors[f"t = {t:g} s"] = np.sqrt(np.mean((T - exact(y, t)) ** 2)) / rise
        rows = np.argsort(y)
        curves[f"{t:g} s"] = (y[rows], T[rows])
        solutions[f"exact, {t:g} s"] = (line, exact(line, t))
    return Outcome(errors, {}, curves, solutions)


study = Study(
    name="heated-layers",
    title="Conduction through two layers",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.01 s": 0.03, "t = 0.04 s": 0.02},
    measure=measure,
    x_label="y [m]",
    y_label="T [K]",
)

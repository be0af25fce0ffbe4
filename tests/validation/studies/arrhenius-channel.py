import numpy as np
from study import Level, Outcome, Study

H, weight, cold, rise = 0.02, 2000.0, 300.0, 50.0  # plates [m], rho g [N/m3], [K]
line = np.linspace(0, H, 20001)
temperature = cold + rise * line / H
viscosity = 5 * np.exp(66515.7 / 8.31446261815324 * (1 / temperature - 1 / 325))


def integral(f):
    return np.concatenate([[0], np.cumsum((f[1:] + f[:-1]) / 2)]) * (line[1] - line[0])


fluidity, first = integral(1 / viscosity), integral(line / viscosity)
stress = weight * first[-1] / fluidity[-1]  # at the cold plate [Pa]
velocity = stress * fluidity - weight * first


def measure(run):
    frame = run.frame()
    y, u = frame.position[:, 1], frame.velocity[:, 0]
    exact, top = np.interp(y, line, velocity), velocity.max()
    rows = np.argsort(y)
    errors = {
        "profile": np.sqrt(np.mean((u - exact) ** 2)) / top,
        "flow rate": abs(u.mean() / (integral(velocity)[-1] / H) - 1),
        "temperature": np.sqrt(np.mean((frame.temperature - cold - rise * y / H) ** 2)) / rise,
    }
    values = {"fastest / exact": u.max() / top, "at y / H": y[np.argmax(u)] / H}
    return Outcome(errors, values, {"end": (y[rows], u[rows] / top)}, {"exact": (line[::200], velocity[::200] / top)})


study = Study(
    name="arrhenius-channel",
    title="Channel with a viscosity of Arrhenius' law",
    levels=[Level(1), Level(2), Level(4)],
    bars={"profile": 0.03, "flow rate": 0.03, "temperature": 0.002},
    measure=measure,
    x_label="y [m]",
    y_label="u / the fastest",
)

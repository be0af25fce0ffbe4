import numpy as np
from study import Level, Outcome, Study

H, rho, g, mu, kappa = 0.02, 1e3, 10.0, 10.0, 1e6  # depth [m], [kg/m3], [m/s2], [Pa s], [Pa]


def measure(run):
    start, end = run.frame(0), run.frame()
    exact = rho * g * (H - start.position[:, 1])
    middle = abs(start.position[:, 0] - H / 2) < H / np.sqrt(len(end.id))  # the two columns in the middle
    rows = np.flatnonzero(middle)[np.argsort(start.position[middle, 1])]
    slope = np.polyfit(start.position[:, 1], end.pressure, 1)[0]
    sinking = np.mean(start.position[:, 1] - end.position[:, 1]) / (rho * g * H**2 / (3 * kappa))
    errors = {
        "pressure": np.sqrt(np.mean((end.pressure - exact) ** 2)) / (rho * g * H),
        "pressure gradient": abs(slope / (rho * g) + 1),
        "sinking": abs(sinking - 1),
        "speed": run.history["max_speed"][-1] / (rho * g * H**2 / mu),
    }
    values = {"sinking / exact": sinking, "fastest particle [m/s]": run.history["max_speed"][-1]}
    line = np.array([0, H])
    return Outcome(errors, values, {"middle": (start.position[rows, 1], end.pressure[rows])},
                   {"exact": (line, rho * g * (H - line))})


study = Study(
    name="hydrostatic",
    title="Hydrostatic column",
    levels=[Level(1), Level(2), Level(4), Level(8)],
    bars={"pressure": 0.028, "pressure gradient": 0.008, "sinking": 0.5, "speed": 5e-5},
    published={"pressure": 0.03, "pressure gradient": 0.013, "sinking": 0.35, "speed": 5e-6},
    measure=measure,
    x_label="y [m]",
    y_label="pressure [Pa]",
)

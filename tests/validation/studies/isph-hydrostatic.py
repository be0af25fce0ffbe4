import numpy as np
from study import Level, Outcome, Study

H, rho, g = 1.0, 1e3, 9.81  # depth [m], [kg/m3], [m/s2]


def measure(run):
    """Pressures layer by layer, means over the last quarter of the run; the topmost layer, where p = 0, is left out. drift: the
    farthest that the centre of mass goes; pressure at one time: of single particles, which scatter."""
    start = run.frame(0)
    layers = round(np.sqrt(len(start.id)))
    total, count, scatter, drift = np.zeros(layers), np.zeros(layers), [], 0
    for frame in run.frames():
        drift = max(drift, np.linalg.norm((frame.position - start.position).mean(axis=0)))
        if frame.time < 0.75 * run.times[-1]:
            continue
        y = frame.position[:, 1]
        layer = np.clip((y / H * layers).astype(int), 0, layers - 1)
        off = frame.pressure - rho * g * (H - y)
        total += np.bincount(layer, off, layers)
        count += np.bincount(layer, minlength=layers)
        scatter.append(np.sqrt(np.mean(off[layer < layers - 1] ** 2)))
    middle = (np.arange(layers) + 0.5) * H / layers
    mean = total / count
    unit = rho * g * H
    errors = {
        "mean pressure": np.mean(abs(mean[:-1])) / unit,
        "pressure at one time": np.mean(scatter) / unit,
        "pressure gradient": abs(np.polyfit(middle[:-1], mean[:-1], 1)[0]) / (rho * g),
        "drift": drift / H,
    }
    late = run.history["time"] > 0.75 * run.times[-1]
    values = {"fastest particle [m/s]": run.history["max_speed"][late].max(),
              "density error": run.history["density_error"][late].mean()}
    line = np.array([0, H])
    return Outcome(errors, values, {"mean of layers": (middle, mean + rho * g * (H - middle))},
                   {"exact": (line, rho * g * (H - line))})


study = Study(
    name="isph-hydrostatic",
    title="ISPH: tank at rest",
    levels=[Level(0.5), Level(1), Level(2)],
    bars={"mean pressure": 0.001, "pressure at one time": 0.002, "pressure gradient": 0.003, "drift": 5e-4},
    measure=measure,
    x_label="y [m]",
    y_label="pressure [Pa]",
)

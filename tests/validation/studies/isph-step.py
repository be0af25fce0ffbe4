"""A stream that meets a step, against a volume-of-fluid method (reference/step_vof.py)."""

import json

import numpy as np
from study import Level, Outcome, Study, cases
from treacle_data import read_table

late, impact = 0.9, 0.6  # [s]
columns = {"H2": 0.99375, "H3": 1.50625, "H4": 2.64375}  # [m]
reference = json.loads((cases.parent / "reference" / "step_vof.json").read_text())["cells"][-1]


def measure(run):
    """Means over the last tenth of a second, as the reference has them. depths: the largest error of three columns, each the area of the
    particles within a strip of four spacings at r1 over its width."""
    pressure = {name: read_table(run.path / "probes" / f"{name}.csv") for name in ("face", "P1", "P2")}
    values = {name: np.nanmean(table["pressure"][table["time"] > late]) for name, table in pressure.items()}
    face = pressure["face"]
    impulses = face["pressure"] * np.diff(face["time"], prepend=0)  # a reading is the mean since the last one
    values["impulse"] = impulses[face["time"] <= impact].sum()
    area, width = 0.55 * 1.225 / len(run.frame(0).id), 0.05  # of a particle [m2], of a strip [m]
    frames = [frame for frame in run.frames() if frame.time >= late - 1e-6]
    depth = {name: np.mean([area / width * np.sum(abs(frame.position[:, 0] - x) < width / 2) for frame in frames])
             for name, x in columns.items()}
    unit = {"face": " [Pa]", "P1": " [Pa]", "P2": " [Pa]", "impulse": " [Pa s]"}
    errors = {name: abs(value / reference[name + unit[name]] - 1) for name, value in values.items()}
    errors["depths"] = max(abs(value / reference[f"{name} [m]"] - 1) for name, value in depth.items())
    edges = np.linspace(0, 1, 51)
    load = np.interp(edges, np.append(0, face["time"]), np.append(0, impulses.cumsum()))
    middle = (edges[1:] + edges[:-1]) / 2
    return Outcome(errors, {}, {"face of the step, means over 20 ms": (middle, np.diff(load) / np.diff(edges))},
                   {"volume of fluid": (middle, np.array(reference["face over time [Pa]"]))})


study = Study(
    name="isph-step",
    title="ISPH: stream against a step",
    levels=[Level(1), Level(2), Level(4)],
    bars={"face": 0.07, "P1": 0.05, "P2": 0.07, "impulse": 0.13, "depths": 0.05},
    measure=measure,
    x_label="t [s]",
    y_label="pressure [Pa]",
)

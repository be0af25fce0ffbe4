import re

import numpy as np
from studies._slit import h, measurement, wall_stress
from study import Level, Study


def profile(run, place):
    """Of a fluid of 1 Pa s; the yield stress is that of the run."""
    text = (run.path / "case.toml").read_text()
    phi = float(re.search(r"yield_stress = ([0-9.]+)", text)[1]) / wall_stress
    top = wall_stress * h / 2 * (1 - phi) ** 2
    sheared = 1 - ((place - phi) / (1 - phi)) ** 2
    return top * np.where(place < phi, 1, sheared), wall_stress * h / 3 * (1 - 1.5 * phi + 0.5 * phi**3)


study = Study(
    name="bingham-slit",
    title="Poiseuille flow of a Bingham fluid",
    levels=[Level(2, (f"paste.rheology.yield_stress={20 * phi:g}",), f"phi = {phi}") for phi in (0.5, 0.2)]
    + [Level(r, ("paste.rheology.yield_stress=16",), "phi = 0.8") for r in (2, 4, 8)],
    bars={"profile": 0.012, "flow rate": 0.01},
    measure=measurement(profile),
    x_label="y [m]",
    y_label="u / that of the plug",
    refined=False,
)

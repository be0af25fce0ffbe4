import numpy as np
from studies._channels import H, couette, profiles
from study import Level, Outcome, Study

U = 0.2  # of the plate [m/s]


def measure(run):
    errors, curves, solutions = profiles(run, (0.02, 0.08, 0.4), couette, H, U)
    slopes = [np.polyfit(f.position[:, 1] / H, f.velocity[:, 0] / U, 1)[0] for f in run.frames() if f.time > run.times[-1] / 2]
    spacing = H / np.sqrt(run.summary["fluid_particles"])
    values = {"slip / spacing": H * (1 / np.mean(slopes) - 1) / 2 / spacing}
    return Outcome(errors, values, curves, solutions)


study = Study(
    name="isph-couette",
    title="ISPH: start-up of plane Couette flow",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.02 s": 0.0035, "t = 0.08 s": 0.0014, "t = 0.4 s": 0.0012},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

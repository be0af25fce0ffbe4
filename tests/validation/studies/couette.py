import numpy as np
from studies._channels import H, couette, profiles
from study import Level, Outcome, Study

U, mu, length = 0.2, 1.0, 0.02  # plate [m/s], [Pa s], plates [m]


def steady(run):
    """Means over the second half of the run: slope of u / U over y / H, shear stress on the plates / (mu U / H)."""
    half = run.times[-1] / 2
    slopes = [np.polyfit(f.position[:, 1] / H, f.velocity[:, 0] / U, 1)[0] for f in run.frames() if f.time > half]
    late = run.balance["time"] > half
    forces = (run.balance["lower plate_force_x"] - run.balance["upper plate_force_x"])[late] / 2
    return np.mean(slopes), np.mean(forces) / (mu * U / H * length)


def measure(run):
    errors, curves, solutions = profiles(run, (0.02, 0.08, 0.4), couette, H, U)
    slope, stress = steady(run)
    errors["viscosity"] = abs(stress / slope - 1)
    spacing = np.sqrt(H * length / run.summary["fluid_particles"])
    values = {
        "stress / exact": stress,
        "viscosity / mu": stress / slope,
        "slip / spacing": H * (1 / slope - 1) / 2 / spacing,
    }
    return Outcome(errors, values, curves, solutions)


study = Study(
    name="couette",
    title="Start-up of plane Couette flow",
    levels=[Level(1), Level(2), Level(4), Level(8)],
    bars={"t = 0.02 s": 0.008, "t = 0.08 s": 0.004, "t = 0.4 s": 0.001, "viscosity": 0.009},
    published={"t = 0.02 s": 0.07, "t = 0.08 s": 0.055, "t = 0.4 s": 0.03, "viscosity": 0.02},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

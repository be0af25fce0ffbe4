import numpy as np
from studies._channels import H, nu, poiseuille, profiles
from study import Level, Outcome, Study

g, length = 2.0, 0.02  # acceleration [m/s2], plates [m]
U = g * H**2 / (8 * nu)  # steady speed in the middle [m/s]


def steady(run):
    """Means over the second half of the run: viscosity / nu from the curvature of the profile, and how far outside of the plates
    the parabola is zero [m]."""
    fits = [np.polyfit(f.position[:, 1] / H - 0.5, f.velocity[:, 0] / U, 2)
            for f in run.frames() if f.time > run.times[-1] / 2]
    bend, _, top = np.mean(fits, axis=0)
    return -4 / bend, H * (np.sqrt(-top / bend) - 0.5)


def measure(run):
    errors, curves, solutions = profiles(run, (0.02, 0.05, 0.4), poiseuille, H, U)
    viscosity, slip = steady(run)
    errors["viscosity"] = abs(viscosity - 1)
    values = {
        "flow rate / exact": np.mean(run.frame().velocity[:, 0]) / (2 / 3 * U),
        "viscosity / mu": viscosity,
        "slip / spacing": slip / np.sqrt(H * length / run.summary["fluid_particles"]),
    }
    return Outcome(errors, values, curves, solutions)


study = Study(
    name="poiseuille",
    title="Start-up of plane Poiseuille flow",
    levels=[Level(1), Level(2), Level(4), Level(8)],
    bars={"t = 0.02 s": 0.0036, "t = 0.05 s": 0.0032, "t = 0.4 s": 0.0125, "viscosity": 0.008},
    published={"t = 0.02 s": 0.042, "t = 0.05 s": 0.08, "t = 0.4 s": 0.18, "viscosity": 0.05},
    ranges={"published": {"flow rate / exact": (1.15, 1.25)}, "accurate": {}},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

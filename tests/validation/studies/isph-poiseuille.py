import numpy as np
from studies._channels import H, nu, poiseuille, profiles
from study import Level, Outcome, Study

g = 2.0  # [m/s2]
U = g * H**2 / (8 * nu)  # steady speed at the surface [m/s]


def measure(run):
    """Of the lower half of the channel; the last errors and the flow rate are those of the steady flow."""
    errors, curves, solutions = profiles(run, (0.02, 0.05, 0.4), poiseuille, H / 2, U)
    rate, slip = [], []
    for frame in run.frames():
        if frame.time > 0.8 * run.times[-1]:
            y, u = frame.position[:, 1], frame.velocity[:, 0] / U
            rate.append(np.mean(u) / np.mean(poiseuille(y, frame.time)))
            bottom, slope, _ = np.polyfit(y / H, u, 2)[::-1]
            slip.append(H * bottom / slope)
    errors["flow rate"] = abs(np.mean(rate) - 1)
    values = {
        "flow rate / exact": np.mean(rate),
        "slip / spacing": np.mean(slip) / np.sqrt(H**2 / 2 / run.summary["fluid_particles"]),
        "density error": run.history["density_error"][-1],
    }
    return Outcome(errors, values, curves, solutions)


study = Study(
    name="isph-poiseuille",
    title="ISPH: start-up of plane Poiseuille flow",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.02 s": 0.0035, "t = 0.05 s": 0.0075, "t = 0.4 s": 0.004, "flow rate": 0.006},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

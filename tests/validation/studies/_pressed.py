"""What the Couette flows under pressure share: the stress on the plates against the viscosity times the slope of the velocities."""

import numpy as np
from study import Level, Outcome, Study

H, mu, length = 0.02, 10.0, 0.02  # plates [m], [Pa s]
strain = 4.0  # of the layer in a run


def level(rate, resolution=1):
    """A run at a shear rate [1/s]; the step is bounded by 0.4 lambda / kappa, from 0.8 on it is unstable."""
    end = strain / rate
    steps = 20 * int(np.ceil(end / 20 / min(0.02 * 0.5 / rate, 0.02)))
    return Level(resolution, (f'body."upper plate".velocity=[{rate * H:g}, 0]', f"time.end={end:g}", f"time.step={end / steps:.10g}",
                              f"output.interval={end / 20:.10g}"), f"{rate:g} /s")


def measure(run):
    """Over the second half of the run, so of strains from 2 on."""
    half = run.times[-1] / 2
    late = [f for f in run.frames() if f.time > half]
    slope = np.mean([np.polyfit(f.position[:, 1], f.velocity[:, 0], 1)[0] for f in late])
    steps = run.balance["time"] > half
    forces = (run.balance["lower plate_force_x"] - run.balance["upper plate_force_x"])[steps] / 2
    stress = np.mean(forces) / length
    rows = np.argsort(late[-1].position[:, 1])
    y, u = late[-1].position[rows, 1], late[-1].velocity[rows, 0]
    values = {"stress / (mu slope)": stress / (mu * slope), "yield stress [Pa]": stress - mu * slope, "slope [1/s]": slope}
    return Outcome({"stress": abs(stress / (mu * slope) - 1)}, values, {"at the end": (y, u / u.max())})


def study(name, pressure, bar=0.009):
    return Study(
        name=name,
        title=f"Couette flow under a mean pressure of {pressure:g} Pa",
        case="couette-pressure.toml",
        settings=(f"gravity.acceleration=[0, {-pressure / (500 * H):g}]",),
        levels=[level(0.5), level(0.125), level(0.03)],
        refined=False,  # the levels are shear rates
        bars={"stress": bar},
        measure=measure,
        x_label="y [m]",
        y_label="u / U",
    )

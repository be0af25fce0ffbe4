import numpy as np
from studies._vortices import rms
from study import Level, Outcome, Study

k, nu, rho = 2 * np.pi, 1e-2, 1e3  # wave number [1/m], viscosity [m2/s], [kg/m3]; U = 1 m/s, in a square of 1 m


def measure(run):
    """Of the pressures without their mean, which has no meaning."""
    time, energy = run.history["time"], run.history["kinetic_energy"] / (rho / 4)
    errors, values = {}, {}
    for t in (0.1, 0.5, 1.0):
        frame = run.frame(int(np.argmin(abs(run.times - t))))
        x, y = k * frame.position.T
        decay = np.exp(-2 * nu * k**2 * frame.time)
        exact = decay * np.stack([np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y)], axis=1)
        errors[f"velocity, t = {t:g} s"] = rms(frame.velocity - exact) / rms(exact)
        pressure = rho / 4 * decay**2 * (np.cos(2 * x) + np.cos(2 * y))
        off = frame.pressure - frame.pressure.mean() - pressure
        errors[f"pressure, t = {t:g} s"] = np.sqrt(np.mean(off**2) / np.mean(pressure**2))
        row = np.argmin(abs(time - frame.time))
        values[f"rate / exact to {t:g} s"] = -np.log(energy[row]) / time[row] / (4 * nu * k**2)
    line = np.linspace(0, time[-1], 101)
    return Outcome(errors, values, {"particles": (time, energy)}, {"exact": (line, np.exp(-4 * nu * k**2 * line))})


study = Study(
    name="isph-taylor-green",
    title="ISPH: Taylor-Green vortices, Re = 100",
    levels=[Level(1), Level(2), Level(4)],
    # Where the lattice breaks up is left to rounding: other steps change the errors by half.
    bars={"velocity, t = 0.1 s": 0.014, "pressure, t = 0.1 s": 0.08, "velocity, t = 0.5 s": 0.016, "pressure, t = 0.5 s": 0.09,
          "velocity, t = 1 s": 0.012, "pressure, t = 1 s": 0.09},
    measure=measure,
    x_label="t [s]",
    y_label="kinetic energy / that at the start",
)

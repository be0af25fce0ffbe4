"""What the studies of Taylor-Green vortices measure: the errors of the velocities and the decay of the energy."""

import numpy as np
from study import Outcome

k, nu, rho, area = 100 * np.pi, 1e-3, 1e3, 4e-4  # wave number [1/m], viscosity [m2/s], [kg/m3], of the square [m2]


def vortices(position):
    x, y = k * position.T
    return np.stack([np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y)], axis=1)


def rms(vectors):
    return np.sqrt(np.mean((vectors**2).sum(axis=1)))


def measure(run):
    speed = np.sqrt(2) * rms(run.frame(0).velocity)  # U
    time, energy = run.history["time"], run.history["kinetic_energy"] / (rho * area * speed**2 / 4)
    errors, rates = {}, {}
    for t in (0.001, 0.005, 0.01):
        frame = run.frame(int(np.argmin(abs(run.times - t))))
        exact = speed * np.exp(-2 * nu * k**2 * frame.time) * vortices(frame.position)
        errors[f"t = {1e3 * frame.time:g} ms"] = rms(frame.velocity - exact) / rms(exact)
        row = np.argmin(abs(time - frame.time))
        rates[f"rate / exact to {1e3 * frame.time:g} ms"] = -np.log(energy[row]) / time[row] / (4 * nu * k**2)
    line = np.linspace(0, time[-1], 101)
    return Outcome(errors, rates, {"particles": (time, energy)}, {"exact": (line, np.exp(-4 * nu * k**2 * line))})

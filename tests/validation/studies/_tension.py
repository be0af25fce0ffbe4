"""Drops that surface tension holds together."""

import numpy as np
from study import Outcome, Study

reach = 3.5  # of the stress at the surface, in spacings
radius, tension, viscosity = 0.01, 1, 10  # [m], [N/m], [Pa s]
capillary_time = viscosity * radius / tension  # [s]


def spacing_of(frame):
    """The lattice that the particles start on [m]."""
    return np.diff(np.unique(frame.position[:, 0].round(9))).min()


def centred(frame):
    return frame.position - frame.position.mean(axis=0)


def relaxation(exact_rate, ellipticity):
    """A measure of drops that become round: ellipticity, of the second moments of the mass along the axes, decays at a rate [1/s]."""

    def measure(run):
        times = run.times
        shape = np.array([ellipticity((centred(frame)**2).mean(axis=0)) for frame in run.frames()])
        fitted = times > 0.009  # after the start from rest
        rate = -np.polyfit(times[fitted], np.log(shape[fitted]), 1)[0]
        values = {f"rate [1/s] (exact {exact_rate:.4g})": rate}
        return Outcome({"rate": abs(rate / exact_rate - 1)}, values, {"particles": (times, shape / shape[0])},
                       {"exact": (times, np.exp(-exact_rate * times))})

    return measure


def at_rest(dimensions, **words):
    """A disc or a ball at rest. Pressures inside are those of the particles deeper than the stress reaches, over the last half of the
    run; velocities are counted in gamma/mu, at the end."""
    ball = dimensions == 3
    curvature = dimensions - 1  # times 1/R
    volume = 4 / 3 * np.pi if ball else np.pi  # of radius 1

    def measure(run):
        spacing = spacing_of(run.frame(0))
        frames = list(run.frames())
        pressure, speed = [], []
        for frame in frames[1:]:
            x = centred(frame)
            size = (len(x) * spacing**dimensions / volume)**(1 / dimensions)
            inside = np.sqrt((x**2).sum(axis=1)) < size - reach * spacing
            pressure.append(frame.pressure[inside].mean() * size / (curvature * tension))
            speed.append(np.sqrt((frame.velocity**2).sum(axis=1).mean()) * viscosity / tension)
        ratio = np.mean(pressure[len(pressure) // 2:])
        last = frames[-1]
        largest = np.sqrt((last.velocity**2).sum(axis=1).max()) * viscosity / tension
        errors = {"Laplace pressure": abs(ratio - 1), "spurious currents": largest}
        values = {f"pressure over {'2 ' * ball}gamma/R": ratio, "fastest particle over gamma/mu": largest,
                  "mean speed over gamma/mu": speed[-1], "least distance over l": last.nearest_distance.min()}
        times = run.times[1:]
        return Outcome(errors, values, {"particles": (times, np.array(pressure))}, {"exact": (times, np.ones(len(times)))})

    return Study(title=f"Laplace pressure of a {'ball' if ball else 'drop'}", measure=measure, x_label="t [s]",
                 y_label=f"pressure over {'2 ' * ball}gamma/R", **words)

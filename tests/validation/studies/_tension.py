"""Drops that surface tension holds together."""

import numpy as np
from study import Outcome

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

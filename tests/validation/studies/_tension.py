"""Drops that surface tension holds together."""

import numpy as np

radius, tension, viscosity = 0.01, 1, 10  # [m], [N/m], [Pa s]
capillary_time = viscosity * radius / tension  # [s]


def spacing_of(frame):
    """The lattice that the particles start on [m]."""
    return np.diff(np.unique(frame.position[:, 0].round(9))).min()


def centred(frame):
    return frame.position - frame.position.mean(axis=0)

"""What the free rotating drops share: momenta, and rotation as that of a rigid body."""

import numpy as np
from study import Outcome


def cross(x, u):
    """x cross u, as three components also in two dimensions."""
    pad = ((0, 0), (0, 3 - x.shape[1]))
    return np.cross(np.pad(x, pad), np.pad(u, pad))


def measure(run):
    """Momenta against those at the start, in units of one particle's mass, and the angular velocity L / I about the axis
    of the start."""
    times, drift, push, speed = [], [], [], []
    for frame in run.frames():
        x, u = frame.position, frame.velocity
        spin, momentum = cross(x, u).sum(axis=0), u.sum(axis=0)
        if not times:
            start, axis = spin, spin / np.linalg.norm(spin)
            quantity = np.linalg.norm(u, axis=1).sum()  # the momenta of the particles by their size
        padded = np.pad(x, ((0, 0), (0, 3 - x.shape[1])))
        inertia = (padded**2).sum() - (padded @ axis).dot(padded @ axis)
        times.append(frame.time)
        drift.append(np.linalg.norm(spin - start) / np.linalg.norm(start))
        push.append(np.linalg.norm(momentum) / quantity)
        speed.append(spin @ axis / inertia)
    times, speed = np.array(times), np.array(speed) / speed[0]
    return Outcome({"angular momentum": max(drift), "momentum": max(push)}, {"angular velocity at the end / start": speed[-1]},
                   {"angular velocity": (times, speed)})

"""Heaps of a Bingham fluid that come to rest on a floor: their width there, and that it no longer depends on the time."""

import numpy as np
from study import Outcome


def measurement(exact, width_of):
    """exact: the width at rest [m]; width_of(frame): the width [m]. The last way of a Bingham fluid goes like 1/t: the width at rest
    is that of a fit L - C/t to the second half of the run. Creep: what the last fifth of the run adds, over the width."""

    def measure(run):
        times = run.times[1:]
        width = np.array([width_of(frame) for frame in run.frames()][1:])
        late = times > times[-1] / 2 - 1e-9
        at_rest = np.polyfit(1 / times[late], width[late], 1)[1]
        creep = 1 - np.interp(0.8 * times[-1], times, width) / width[-1]
        values = {"width at rest [m]": at_rest, "at the end [m]": width[-1]}
        return Outcome({"width at rest": abs(at_rest / exact - 1), "creep": creep}, values, {"particles": (times, width)},
                       {"with normal stresses": (times, np.full(len(times), exact))})

    return measure

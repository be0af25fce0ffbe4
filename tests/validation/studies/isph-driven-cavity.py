"""The steady flow, against the spectral solution of O. Botella and R. Peyret, Comput. Fluids 27, 1998."""

import numpy as np
from study import Level, Outcome, Study

# The largest and least velocities on the middle lines [m/s].
u_least, v_most, v_least = -0.2140424, 0.1795728, -0.2538030


def fitted(frame, points, radius):
    """Velocities at the points: of quadratic functions fitted to the particles within `radius` [m]."""
    found = []
    for point in points:
        d = (frame.position - point) / radius
        near = np.linalg.norm(d, axis=1) < 1
        x, y = d[near].T
        weight = 1 - np.hypot(x, y)[:, None]
        terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
        found.append(np.linalg.lstsq(weight * terms, weight * frame.velocity[near], rcond=None)[0][0])
    return np.array(found)


def measure(run):
    """Means over the last third of the run."""
    spacing = 1 / np.sqrt(len(run.frame(0).id))
    line = np.linspace(0, 1, 101)[2:-2]
    middle = np.full_like(line, 0.5)
    late = [frame for frame in run.frames() if frame.time > 2 / 3 * run.times[-1]]
    u = np.mean([fitted(frame, np.stack([middle, line], axis=1), 4 * spacing)[:, 0] for frame in late], axis=0)
    v = np.mean([fitted(frame, np.stack([line, middle], axis=1), 4 * spacing)[:, 1] for frame in late], axis=0)
    errors = {"u, least": abs(u.min() / u_least - 1), "v, most": abs(v.max() / v_most - 1), "v, least": abs(v.min() / v_least - 1)}
    return Outcome(errors, {},
                   {"v(x) at y = 0.5 m": (line, v), "u(y) at x = 0.5 m": (line, u)},
                   {"largest and least": (np.array([0.8104, 0.2370, 0.4581]), np.array([v_least, v_most, u_least]))})


study = Study(
    name="isph-driven-cavity",
    title="ISPH: driven cavity, Re = 100",
    levels=[Level(1), Level(2), Level(4)],
    bars={"u, least": 0.085, "v, most": 0.1, "v, least": 0.075},
    measure=measure,
    x_label="x or y [m]",
    y_label="velocity [m/s]",
)

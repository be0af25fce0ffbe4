"""What the hanging filaments share: rates of strain of the rows of particles that lay at one height at the start."""

import numpy as np
from study import Outcome

density, gravity, viscosity = 1000, 10, 100  # [kg/m3], [m/s2], [Pa s]


def measurement(ratio, length, width):
    """measure() of a filament of this length and width [m] whose extensional viscosity is ratio * mu.

    The weight below a row stretches it: with Z its height above the tip at the start and c = rho g Z / (ratio mu), stretch s
    and rate of strain e obey s'/s = e = c s, so that s = 1 / (1 - c t), whatever the cross-section. Rows nearer than
    the width to the tip, and 1.5 widths to the ceiling, are left out, and inertia is neglected."""

    def measure(run):
        start, frame = run.frame(0), run.frame()
        heights = start.position[:, -1]
        rows = np.unique(heights.round(9))
        of = [abs(heights - row) < 1e-8 for row in rows]
        height = np.array([frame.position[k, -1].mean() for k in of])
        speed = np.array([frame.velocity[k, -1].mean() for k in of])

        def across(values):
            return values[2:] - values[:-2]

        rate, stretch = across(speed) / across(height), across(height) / across(rows)
        above = rows[1:-1] + length  # the tip
        middle = (above > width) & (above < length - 1.5 * width)
        rate, stretch, above = rate[middle], stretch[middle], above[middle]
        c = density * gravity * above / (ratio * viscosity)
        exact = c / (1 - c * frame.time)
        measured = np.mean(density * gravity * above * stretch / (rate * viscosity))
        errors = {"extensional viscosity": abs(measured / ratio - 1),
                  "rate of strain": np.sqrt(np.mean((rate - exact) ** 2) / np.mean(exact**2))}
        return Outcome(errors, {f"extensional viscosity / mu (exact {ratio})": measured},
                       {"rows": (above * 1e3, rate)}, {"exact": (above * 1e3, exact)})

    return measure

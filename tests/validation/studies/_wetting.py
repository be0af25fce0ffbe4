"""A drop on a wall, whatever its contact angle, as it is after 114 capillary times mu R / gamma; on walls that it wets it goes on
spreading (docs/surface-tension.md)."""

import numpy as np
from study import Level, Outcome, Study
from studies._tension import spacing_of


def height(angle):
    """Of the centre of a segment of a disc above the wall, over the root of its area."""
    area = angle - np.sin(angle) * np.cos(angle)
    return (2 * np.sin(angle)**3 / (3 * area) - np.cos(angle)) / np.sqrt(area)


angles = np.radians(np.linspace(1, 179, 2000))


def wetting(degrees):
    def measure(run):
        spacing = spacing_of(run.frame(0))
        found = []
        for frame in run.frames():
            y = frame.position[:, 1]
            found.append(np.degrees(np.interp(y.mean() / (np.sqrt(len(y)) * spacing), height(angles), angles)))
        last = np.mean(found[-3:])
        return Outcome({"contact angle in degrees": abs(last - degrees)}, {"contact angle": last},
                       {"particles": (run.times, np.array(found))}, {"exact": (run.times, np.full(len(found), degrees))})

    # Not refined: what is left is not the spacing's, lines still move at the end, by some 3 degrees from run to run.
    return Study(name=f"wetting-drop-{degrees}", title=f"Drop on a wall, {degrees} degrees", case="wetting-drop.toml",
                 settings=(f"wall.contact_angle={degrees}",), levels=[Level(1), Level(2)],
                 bars={"contact angle in degrees": 6}, refined=False, measure=measure, x_label="t [s]", y_label="angle [degrees]")

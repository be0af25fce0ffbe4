"""A drop on a wall, whatever its contact angle, as it is after 114 capillary times mu R / gamma; flat ones go on spreading
(docs/surface-tension.md)."""

import numpy as np
from studies._tension import spacing_of
from study import Level, Outcome, Study


def height_of_disc(angle):
    """Of the centre of a segment of a disc above the wall, over the root of its area."""
    area = angle - np.sin(angle) * np.cos(angle)
    return (2 * np.sin(angle)**3 / (3 * area) - np.cos(angle)) / np.sqrt(area)


def height_of_ball(angle):
    """Of the centre of a cap of a ball above the wall, over the cubic root of its volume."""
    cosine = np.cos(angle)
    volume = np.pi / 3 * (2 + cosine) * (1 - cosine)**2
    return (0.75 * (1 + cosine)**2 / (2 + cosine) - cosine) / np.cbrt(volume)


angles = np.radians(np.linspace(1, 179, 2000))


def wetting(degrees, dimensions=2):
    in_space = dimensions == 3
    heights = (height_of_ball if in_space else height_of_disc)(angles)

    def measure(run):
        spacing = spacing_of(run.frame(0))
        found = []
        for frame in run.frames():
            x = frame.position
            height = x[:, dimensions - 1].mean() / (len(x)**(1 / dimensions) * spacing)
            found.append(np.degrees(np.interp(height, heights, angles)))
        last = np.mean(found[-3:])
        return Outcome({"contact angle in degrees": abs(last - degrees)}, {"contact angle": last},
                       {"particles": (run.times, np.array(found))}, {"exact": (run.times, np.full(len(found), degrees))})

    # Not refined: what is left is not the spacing's, lines differ by some 2 degrees from run to run.
    name = "wetting-drop-3d" if in_space else "wetting-drop"
    return Study(name=f"{name}-{degrees}", title=f"Drop on a wall{' in three dimensions' if in_space else ''}, {degrees} degrees",
                 case=f"{name}.toml", settings=(f"wall.contact_angle={degrees}",), levels=[Level(1), Level(2)],
                 bars={"contact angle in degrees": 9 if in_space and degrees < 90 else 5}, refined=False, measure=measure,
                 x_label="t [s]", y_label="angle [degrees]")

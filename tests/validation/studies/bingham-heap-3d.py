import numpy as np
from studies._heap import measurement
from study import Level, Study

radius = 0.1888  # as bingham-heap, round: 0.1880 to 0.1896 m by how the fluid spreads in the end


def rim(frame):
    """The mean over 24 directions of the particle that is farthest out."""
    x, y = frame.position[:, 0], frame.position[:, 1]
    sector = ((np.arctan2(y, x) + np.pi) / (2 * np.pi) * 24).astype(int) % 24
    distance = np.hypot(x, y)
    return np.mean([distance[sector == k].max() for k in range(24)])


study = Study(
    name="bingham-heap-3d",
    title="A round Bingham heap at rest, 10 times as wide as high",
    levels=[Level(1)],
    bars={"width at rest": 0.03, "creep": 0.01},
    measure=measurement(radius, rim),
    x_label="t [s]",
    y_label="radius [m]",
)

from studies._heap import measurement
from study import Level, Study

width = 0.1921  # of half the heap by the stress on its floor and, to first order in height over width, its normal stresses [m]

study = Study(
    name="bingham-heap",
    title="A Bingham heap at rest, 20 times as wide as high",
    levels=[Level(1), Level(2)],
    bars={"width at rest": 0.08, "creep": 0.01},
    orders={"width at rest": 0.7},
    measure=measurement(width, lambda frame: (frame.position[:, 0].max() - frame.position[:, 0].min()) / 2),
    x_label="t [s]",
    y_label="half the width [m]",
)

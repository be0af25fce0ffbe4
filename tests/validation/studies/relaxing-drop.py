from studies._tension import capillary_time, relaxation
from study import Level, Study

study = Study(
    name="relaxing-drop",
    title="Relaxation of a drop",
    levels=[Level(1), Level(2), Level(4)],
    bars={"rate": 0.055},  # 0.01 at x2
    orders={"rate": 0.9},
    measure=relaxation(1 / capillary_time, lambda m: (m[0] - m[1]) / m.sum()),  # gamma/(mu R), of an ellipse
    x_label="t [s]",
    y_label="ellipticity over that at the start",
)

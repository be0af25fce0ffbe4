from studies._tension import capillary_time, relaxation
from study import Level, Study

study = Study(
    name="relaxing-drop-3d",
    title="Relaxation of a drop in three dimensions",
    levels=[Level(1), Level(2)],
    bars={"rate": 0.03},
    orders={"rate": 0.1},  # 1.2 and 1.0 %
    measure=relaxation(20 / 19 / capillary_time, lambda m: (m[2] - m[:2].mean()) / m.sum()),  # 20/19 gamma/(mu R), of a mode with n = 2
    x_label="t [s]",
    y_label="length over that at the start",
)

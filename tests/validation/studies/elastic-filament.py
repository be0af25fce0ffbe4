from studies._elastic_filament import measurement
from study import Level, Study

study = Study(
    name="elastic-filament",
    title="Elastic filament that stretches under its own weight",
    levels=[Level(1)],
    bars={"elongation at 0.05 s": 0.05, "elongation at 0.15 s": 0.03, "elongation at 0.3 s": 0.03, "rate of strain at 0.3 s": 0.15},
    measure=measurement(3, 0.04, 0.01),
    x_label="initial height above the tip [mm]",
    y_label="stretch",
)

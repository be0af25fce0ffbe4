from studies._elastic_filament import measurement
from study import Level, Study

study = Study(
    name="elastic-sheet",
    title="Elastic sheet that stretches under its own weight",
    levels=[Level(1), Level(2)],
    bars={"elongation at 0.05 s": 0.02, "elongation at 0.15 s": 0.02, "elongation at 0.3 s": 0.02, "rate of strain at 0.3 s": 0.03},
    # Rates are differences between rows of particles, whose noise stays.
    orders={"rate of strain at 0.3 s": 0.4},
    measure=measurement(2, 0.048, 0.012),
    x_label="initial height above the tip [mm]",
    y_label="stretch",
)

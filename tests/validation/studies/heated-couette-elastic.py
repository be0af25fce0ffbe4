from studies._self_heating import study as heating
from study import Level

study = heating(
    "heated-couette-elastic",
    "Heating by elastic stresses in Couette flow",
    [Level(1), Level(2)],
    bars={"profile": 0.02, "middle": 0.02, "balance": 1e-7},
)

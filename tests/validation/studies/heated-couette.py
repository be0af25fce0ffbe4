import numpy as np
from studies._self_heating import study as heating
from study import Level

study = heating(
    "heated-couette",
    "Viscous heating in Couette flow",
    [Level(1), Level(2), Level(4)],
    bars={"profile": 0.02, "middle": 0.02, "balance": 1e-7, "dissipation": 1e-12},
    more=lambda balance: {"dissipation": np.max(abs(balance["viscous_heating"] / balance["shear_dissipation"] - 1))},
)

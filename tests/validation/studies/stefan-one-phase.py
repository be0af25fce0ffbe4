from studies._stefan import liquidus
from studies._stefan import study as stefan

study = stefan(
    "stefan-one-phase",
    "Freezing of a liquid at its melting point",
    liquidus,
    settings=(f"layer.temperature={liquidus}",),
    bars={"front": 0.005, "temperature": 0.003},
)

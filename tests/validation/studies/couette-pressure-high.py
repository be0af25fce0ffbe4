from studies._pressed import study as pressed

study = pressed("couette-pressure-high", 1000, bar=0.024)

from studies._pressed import study as pressed

study = pressed("couette-pressure", 100)

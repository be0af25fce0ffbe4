from studies._cooling import study as cooling

study = cooling("cooled-slab", 1, bars={"t = 0.1 s": 0.005, "t = 0.4 s": 0.003})

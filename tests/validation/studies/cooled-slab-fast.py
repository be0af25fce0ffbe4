from studies._cooling import study as cooling

study = cooling("cooled-slab-fast", 10, bars={"t = 0.1 s": 0.01, "t = 0.4 s": 0.003})

from studies._cavity import study as cavity

study = cavity("heated-cavity-1e4", 1e4, step=5e-4, end=1.8, bars={"Nusselt number": 0.005})

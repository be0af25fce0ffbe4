from studies._cavity import study as cavity

study = cavity("heated-cavity-1e3", 1e3, step=4e-3, end=2.8, bars={"Nusselt number": 0.005})

from studies._cavity import study as cavity

study = cavity("heated-cavity-1e5", 1e5, step=1.5e-4, end=1.2, bars={"Nusselt number": 0.015})

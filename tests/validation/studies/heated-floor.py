from studies._floor import study as floor

study = floor("heated-floor", "Convection above a warm floor, Rayleigh number 2500", 2500, 1.475, bars={"Nusselt number": 0.01})

from studies._floor import study as floor

study = floor("heated-floor-resting", "Rest above a warm floor, Rayleigh number 1366", 1366, 1, bars={"Nusselt number": 0.001})

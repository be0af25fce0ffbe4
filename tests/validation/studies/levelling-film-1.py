from studies._levelling import long_wave

study = long_wave("levelling-film-1", "Levelling of a film, waves of 6.3 depths", 0.126, 1.5, 0.05, 0.04)

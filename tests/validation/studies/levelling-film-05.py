from studies._levelling import long_wave

study = long_wave("levelling-film-05", "Levelling of a film, waves of 12.6 depths", 0.251, 4.5, 0.15, 0.04)

from studies._levelling import levelling

study = levelling("levelling-film", "Levelling of a film by surface tension and gravity", 0.064)

from studies._stefan import study as stefan

study = stefan("stefan-freezing", "Freezing of a warm liquid", 340, bars={"front": 0.02, "temperature": 0.008})

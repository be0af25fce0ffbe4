from studies._layers import layered

study = layered("two-layer-couette", "Two-layer Couette flow, viscosities 1 to 10,000", 1e-3, {"stress": 0.02, "interface velocity": 0.02})

from studies._layers import layered

study = layered("two-layer-couette-1000", "Two-layer Couette flow, viscosities 1 to 1,000", 1e-2,
                {"stress": 0.02, "interface velocity": 0.02})

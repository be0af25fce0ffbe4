from studies._wetting import wetting

study = wetting(45, 3)

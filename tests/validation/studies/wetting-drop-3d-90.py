from studies._wetting import wetting

study = wetting(90, 3)

from studies._wetting import wetting

study = wetting(135, 3)

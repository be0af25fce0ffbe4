from studies._thixotropy import study as thixotropy


def shear_rate(t):
    return 1.0 if t < 3 or t > 5 else 20.0


study = thixotropy(
    "thixotropic-steps",
    "Steps of the shear rate of a thixotropic fluid",
    shear_rate,
    stress=lambda rate, s: 10 * (0.1 + 0.9 * s) * rate,
    skipped=lambda t: t < 0.1 or 3 - 1e-6 < t < 3.1 or 5 - 1e-6 < t < 5.1,
    x_of=lambda t: t,
    x_label="t [s]",
    bar=0.02,
)

import numpy as np
from studies._thixotropy import study as thixotropy


def shear_rate(t):
    return 4 * t if t < 5 else 4 * (10 - t)


study = thixotropy(
    "thixotropic-loop",
    "Loop of the shear rate of a thixotropic paste",
    shear_rate,
    stress=lambda rate, s: 2 * rate + 50 * s * (1 - np.exp(-20 * rate)),
    skipped=lambda t: t < 0.5 or t > 9.5,
    x_of=shear_rate,
    x_label="shear rate [1/s]",
    bar=0.02,
)

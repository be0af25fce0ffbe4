import numpy as np
from studies._squeezed import speed
from studies._squeezed import study as squeezed

mu, tau = 10.0, 50.0  # plastic viscosity [Pa s], yield stress [Pa]


def gradient(x, h):
    """Of the flow speed x between plates: h^2 w (1 - 3/2 phi + phi^3/2) / (6 mu), phi = tau / w, w the stress on the plates."""
    wanted = 6 * mu * speed * x / h**2
    w = tau + wanted
    for _ in range(50):  # Newton
        f = w - 1.5 * tau + 0.5 * tau**3 / w**2 - wanted
        slope = 1 - tau**3 / w**3
        w = np.where(slope > 0, w - f / np.where(slope > 0, slope, 1), w)
    return -2 * w / h


# The theory is that of thin films, which leaves out normal stresses: the error does not fall with the spacing.
study = squeezed("squeezed-paste", "Bingham fluid between plates that close", gradient, 0.05, refined=False)

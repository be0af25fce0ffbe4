"""Convection between two plates, 0.8 and 1.46 times the Rayleigh number at which it begins: 1708 (W. H. Reid, D. L. Harris, Phys. Fluids 1,
1958). Rolls: R. M. Clever, F. H. Busse, J. Fluid Mech. 65, 1974, Prandtl number 0.71."""

import numpy as np
from study import Level, Outcome, Study

height, warm, cold = 0.02, 350.0, 250.0  # [m], [K]
diffusivity = 1.408451e-4  # [m2/s]


def nusselt(frame):
    """The mean over all levels: of conduction between the plates, and of what the flow carries."""
    carried = np.mean(frame.velocity[:, 1] * (frame.temperature - (warm + cold) / 2))
    return 1 + carried * height / (diffusivity * (warm - cold))


def study(name, title, rayleigh, expected, bars):
    """The Nusselt number is the mean of the last quarter of the time."""

    def measure(run):
        times = np.array(run.times)
        numbers = np.array([nusselt(frame) for frame in run.frames()])
        late = times > 0.75 * times[-1] - 1e-9
        found = numbers[late].mean()
        return Outcome({"Nusselt number": abs(found / expected - 1)}, {"Nusselt number": found, "its spread": np.ptp(numbers[late])},
                       {"found": (times, numbers)}, {"exact": (times[[0, -1]], np.array([expected, expected]))})

    return Study(name=name, title=title, case="heated-floor.toml", settings=(f"gravity.acceleration=[0, {-8.80282e-4 * rayleigh:g}]",),
                 levels=[Level(1), Level(2), Level(4)], bars=bars, measure=measure, x_label="t [s]", y_label="Nu")

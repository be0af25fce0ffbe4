"""Fields that pictures are coloured by: their names, units and values, and the range of the colours."""

import numpy as np

from .arrays import Floats
from .errors import PictureError
from .particles import Particles

units = {
    "speed": "m/s",
    "pressure": "Pa",
    "number_density": "",
    "nearest_distance": "spacings",
    "dynamic_viscosity": "Pa s",
    "shear_rate": "1/s",
    "temperature": "K",
    "material": "",
    "body": "",
}


def names(particles: Particles) -> list[str]:
    """Fields that the particles of a frame can be coloured by."""
    found = ["speed"] if "velocity" in particles.fields else []
    return found + [name for name in units if name in particles.fields]


def values(particles: Particles, name: str) -> Floats:
    """One number per particle. Raises PictureError where the frame does not hold the field."""
    if name == "speed" and "velocity" in particles.fields:
        speeds: Floats = np.linalg.norm(particles.fields["velocity"], axis=1)
        return speeds
    if name in particles.fields and name in units:
        return particles.fields[name].astype(float)
    if len(particles) == 0:
        return np.zeros(0)
    raise PictureError(f"field '{name}': the frames hold {', '.join(names(particles) + ['none'])}")


def label(name: str) -> str:
    """With its unit, as beside the colours."""
    unit = f" [{units[name]}]" if units[name] else ""
    return name.replace("_", " ") + unit


def scaled_unit(length: float) -> tuple[str, float]:
    """Of metres: the unit in which a length is between 1 and 1000, and how many of it a metre has."""
    for name, count in (("m", 1), ("mm", 1e3), ("µm", 1e6)):
        if length * count >= 1:
            return name, count
    return "µm", 1e6


class Range:
    """What the colours of a field go from and to in all frames: all but one in 200 of the values at either end, since a
    few particles of a splash would leave one colour for the rest. Speeds begin at zero."""

    def __init__(self, name: str | None) -> None:
        self.name = name
        self.least, self.most = np.inf, -np.inf

    def add(self, numbers: Floats) -> None:
        finite = numbers[np.isfinite(numbers)]
        if len(finite):
            low, high = np.quantile(finite, [0.005, 0.995])
            self.least, self.most = min(self.least, low), max(self.most, high)

    def bounds(self) -> tuple[float, float]:
        """Two numbers, the second one larger."""
        if self.least > self.most:
            return 0.0, 1.0
        least = 0.0 if self.name in ("speed", "shear_rate") else self.least
        if self.most - least > 1e-6 * max(abs(least), abs(self.most)):
            return float(least), float(self.most)
        width = 0.01 * abs(self.most) or 1.0
        return float(least), float(least + width)


def logarithmic(name: str, bounds: tuple[float, float]) -> bool:
    """Whether colours should stand for powers: viscosities that differ by more than a factor of 100."""
    return name == "dynamic_viscosity" and bounds[0] > 0 and bounds[1] > 100 * bounds[0]

"""Which particles can be seen: pictures of the rest would only take time, or hide what they are made for."""

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats

nearest = 8  # balls per square of a spacing; what is behind so many is hidden


def cells(places: Floats, spacing: float) -> NDArray[np.int64]:
    """Numbers of the squares of a spacing that the places are in, as one integer each."""
    squares = np.floor(places[:, :2] / spacing).astype(np.int64)
    found: NDArray[np.int64] = (squares[:, 0] << 32) + squares[:, 1]
    return found


def seen(places: Floats, spacing: float) -> NDArray[np.int64]:
    """Indices of the particles that are among the nearest to the viewer in their square of the picture. places: three
    columns of a View [m]."""
    numbers = cells(places, spacing)
    order = np.lexsort((-places[:, 2], numbers))
    begins = np.flatnonzero(np.diff(numbers[order], prepend=-1 << 62))
    counts = np.diff(np.append(begins, len(order)))
    ranks = np.arange(len(order)) - np.repeat(begins, counts)
    first: NDArray[np.int64] = order[ranks < nearest]
    return first


class FluidBehind:
    """Where the fluid of some frames is in the picture, and how far from the viewer: walls before it are left open, the
    same ones in all frames of a film."""

    def __init__(self, spacing: float) -> None:
        self.spacing = spacing
        self.numbers: NDArray[np.int64] = np.zeros(0, np.int64)
        self.depths: Floats = np.zeros(0)

    def add(self, places: Floats) -> None:
        """Particles of a frame. They count for the squares around them, too."""
        shifts = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]
        numbers, depths = _least(cells(places, self.spacing), places[:, 2])
        near = np.concatenate([numbers + (x << 32) + y for x, y in shifts])
        self.numbers, self.depths = _least(
            np.concatenate([self.numbers, near]), np.concatenate([self.depths, np.tile(depths, len(shifts))])
        )

    def hidden_by(self, places: Floats) -> NDArray[np.bool_]:
        """Mask of the wall particles that are nearer to the viewer than fluid in the same square."""
        if len(self.numbers) == 0:
            return np.zeros(len(places), bool)
        numbers = cells(places, self.spacing)
        found = np.minimum(np.searchsorted(self.numbers, numbers), len(self.numbers) - 1)
        before = places[:, 2] > self.depths[found] + self.spacing
        hidden: NDArray[np.bool_] = (self.numbers[found] == numbers) & before
        return hidden


def _least(numbers: NDArray[np.int64], depths: Floats) -> tuple[NDArray[np.int64], Floats]:
    """The different numbers in order, and the least depth of each."""
    order = np.lexsort((depths, numbers))
    numbers, depths = numbers[order], depths[order]
    first = np.diff(numbers, prepend=-1 << 62) != 0
    return numbers[first], depths[first]

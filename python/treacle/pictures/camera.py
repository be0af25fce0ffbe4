"""Where a picture is seen from: parallel projection, gravity pointing down."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, Floats
from .errors import PictureError

# Azimuth around the vertical and elevation above the horizontal plane [degrees]; from azimuth 0 one sees the first
# horizontal axis go to the right. "corner" is the direction that `treacle plot` draws from.
named = {
    "corner": (34.0, 26.5),
    "front": (0.0, 0.0),
    "right": (90.0, 0.0),
    "back": (180.0, 0.0),
    "left": (270.0, 0.0),
    "top": (0.0, 90.0),
    "bottom": (0.0, -90.0),
}


@dataclass(frozen=True)
class Direction:
    """What --camera says."""

    azimuth: float  # [degrees]
    elevation: float  # [degrees]
    zoom: float = 1.0


def direction(text: str) -> Direction:
    """Of a name or AZIMUTH,ELEVATION[,ZOOM]. Raises PictureError."""
    if text in named:
        return Direction(*named[text])
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise PictureError(f"--camera: expected {'|'.join(named)} or AZIMUTH,ELEVATION[,ZOOM], found '{text}'")
    if abs(numbers[1]) > 90:
        raise PictureError(f"--camera: expected an elevation from -90 to 90 degrees, found {numbers[1]:g}")
    if len(numbers) == 3 and not 0.01 <= numbers[2] <= 100:
        raise PictureError(f"--camera: expected a zoom from 0.01 to 100, found {numbers[2]:g}")
    return Direction(*numbers)


class View:
    """Orthonormal directions of a picture in space, as rows: to the right, up, to the viewer."""

    def __init__(self, axes: ArrayLike) -> None:
        self.axes: Floats = np.asarray(axes, float)

    def __call__(self, positions: Array) -> Floats:
        """Where positions are in the picture and how near to the viewer: three columns [m]."""
        places: Floats = positions @ self.axes.T
        return places

    @staticmethod
    def flat() -> View:
        """Of two dimensions."""
        return View(np.eye(3))

    @staticmethod
    def of(seen: Direction, gravity: Floats) -> View:
        """Along a Direction. Up is against the main axis of gravity, z without one."""
        axis = int(np.argmax(np.abs(gravity))) if np.any(gravity) else 2
        up = np.zeros(3)
        up[axis] = -1.0 if gravity[axis] > 0 else 1.0
        along = np.zeros(3)
        along[1 if axis == 0 else 0] = 1.0
        away = np.cross(up, along)
        azimuth, elevation = math.radians(seen.azimuth), math.radians(seen.elevation)
        level = math.sin(azimuth) * along - math.cos(azimuth) * away
        right = math.cos(azimuth) * along + math.sin(azimuth) * away
        to_viewer = math.cos(elevation) * level + math.sin(elevation) * up
        return View([right, np.cross(to_viewer, right), to_viewer])


class Extent:
    """What a view has to show: the box of all that is added, in its directions."""

    def __init__(self) -> None:
        self.low: Floats = np.full(3, np.inf)
        self.high: Floats = np.full(3, -np.inf)

    def add(self, places: Floats, margin: float = 0.0) -> None:
        """Positions in the view [m], three columns, and what they reach beyond."""
        if len(places):
            self.low = np.minimum(self.low, places.min(axis=0) - margin)
            self.high = np.maximum(self.high, places.max(axis=0) + margin)

    @property
    def empty(self) -> bool:
        return bool(np.any(self.low > self.high))

    @property
    def center(self) -> Floats:
        return (self.low + self.high) / 2

    @property
    def size(self) -> Floats:
        return self.high - self.low

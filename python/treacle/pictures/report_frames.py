"""Frames for the page of a report: some of them, thinned, in few bytes."""

import base64
import zlib
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import fields
from .arrays import Array, Floats
from .particles import Particles, none, read_particles
from .run_files import RunFiles

position_levels = 65535  # of an axis of the box around all frames
colour_levels = 254  # of a field's range; 255 stands for no value


def kept(ids: Array, share: float) -> NDArray[np.bool_]:
    """Mask of a share of the particles, the same ones in all frames: chosen by their identifiers as if by chance."""
    mixed = ids.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    mixed ^= mixed >> np.uint64(32)
    mixed *= np.uint64(0xD6E8FEB86659FD93)
    return (mixed >> np.uint64(40)).astype(float) / 2.0**24 < share


def thinned(particles: Particles, share: float) -> Particles:
    """A share of them; all with a share of 1."""
    if share >= 1 or len(particles) == 0:
        return particles
    return particles.chosen(kept(particles.fields.get("id", np.arange(len(particles))), share))


def packed(arrays: Iterable[Array]) -> str:
    """Bytes of arrays one after the other, compressed (zlib), as text."""
    return base64.b64encode(zlib.compress(b"".join(array.tobytes() for array in arrays), 6)).decode()


class ReportFrames:
    """Some frames of a RunFiles, at most `most_points` particles of each. progress: wraps what goes over the frames."""

    def __init__(self, run: RunFiles, count: int, most_points: int, progress: Callable[[Array], Iterable[int]]) -> None:
        self.run = run
        some = np.unique(np.linspace(0, len(run.fluid) - 1, min(count, len(run.fluid))).round().astype(int))
        self.most = 0  # particles in one of these frames
        self.spread: dict[str, fields.Range] = {}
        self.fluid: list[tuple[float, Particles]] = []
        for k in progress(some):
            particles = read_particles(run.fluid[k].path)
            self.most = max(self.most, len(particles))
            for name in fields.names(particles):
                self.spread.setdefault(name, fields.Range(name)).add(fields.values(particles, name))
            # A frame is thinned as far as it needs; what all frames need is a part of that.
            self.fluid.append((run.fluid[k].time, thinned(particles, most_points / max(1, len(particles)))))
        self.share = min(1.0, most_points / max(1, self.most))
        self.fluid = [(time, thinned(particles, self.share)) for time, particles in self.fluid]
        # Fields of whole numbers are worth a look where they tell particles apart.
        self.names = [
            n for n, found in self.spread.items() if n not in ("material", "body") or found.least < found.most
        ]
        self.ranges = {name: self.spread[name].bounds() for name in self.names}
        self._read_walls(some, most_points)
        parts = [particles.positions for _, particles in self.fluid] + [self.walls[0].positions]
        positions = np.concatenate([part for part in parts if len(part)] or [np.zeros((1, 3))])
        self.low, self.high = positions.min(axis=0).astype(float), positions.max(axis=0).astype(float)

    def _read_walls(self, numbers: Array, most_points: int) -> None:
        """Of the first frame, and of all where they move; thinned like the fluid."""
        files = [self.run.walls[min(k, len(self.run.walls) - 1)].path for k in numbers] if self.run.walls else []
        first = read_particles(files[0]) if files else none()
        last = read_particles(files[-1]) if files else none()
        self.wall_share = min(1.0, most_points / max(1, len(first)))
        moving = len(first) != len(last) or not np.array_equal(first.positions, last.positions)
        self.walls = (
            [thinned(read_particles(path), self.wall_share) for path in files]
            if moving
            else [thinned(first, self.wall_share)]
        )

    def _positions(self, particles: Particles) -> Array:
        """Whole numbers between the corners of the box, axis after axis."""
        span = np.maximum(self.high - self.low, 1e-30)
        levels = (particles.positions - self.low) / span * position_levels
        numbers: Array = np.clip(levels.round(), 0, position_levels).astype("<u2")
        return numbers.T[: self.run.dimensions].copy()

    def _colours(self, particles: Particles, name: str) -> NDArray[np.uint8]:
        low, high = (self._scaled(name, np.array(self.ranges[name]))).tolist()
        levels = (
            np.clip((self._scaled(name, fields.values(particles, name)) - low) / (high - low), 0, 1) * colour_levels
        )
        return np.where(np.isfinite(levels), levels, 255).round().astype(np.uint8)

    def _scaled(self, name: str, values: Floats) -> Floats:
        if not fields.logarithmic(name, self.ranges[name]):
            return values
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log10(values)

    def data(self) -> dict[str, Any]:
        """What the page needs, for JSON."""
        unit, metre = fields.scaled_unit(float((self.high - self.low).max()))
        return {
            "dimensions": self.run.dimensions,
            "spacing": self.run.spacing * metre,
            "diameter": self.run.spacing * metre * self.share ** (-1 / self.run.dimensions),
            "unit": unit,
            "low": (self.low * metre).tolist(),
            "high": (self.high * metre).tolist(),
            "up": (-self.run.gravity).tolist(),
            "fields": [
                {
                    "name": ("log10 " if fields.logarithmic(name, self.ranges[name]) else "") + fields.label(name),
                    "range": self._scaled(name, np.array(self.ranges[name])).tolist(),
                }
                for name in self.names
            ],
            "frames": [
                {
                    "time": time,
                    "count": len(p),
                    "data": packed([self._positions(p), *(self._colours(p, name) for name in self.names)]),
                }
                for time, p in self.fluid
            ],
            "walls": [{"count": len(p), "data": packed([self._positions(p)])} for p in self.walls],
        }

    def remark(self) -> str:
        """What is left out, in words."""
        words = [f"{len(self.fluid)} of {len(self.run.fluid)} frames"]
        if self.share < 1:
            shown = f"of {self.most:,} fluid particles {100 * self.share:.2g} % are shown"
            words.append(f"{shown}, chosen by chance, the same ones in all frames")
        if self.wall_share < 1:
            words.append(f"of the wall particles {100 * self.wall_share:.2g} %")
        return "; ".join(words) + "."

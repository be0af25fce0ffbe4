"""Particles (.grid), or the cuboids that they are made of (.boid)."""

from __future__ import annotations

import os
from array import array
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from ..errors import InputError
from .lines import Lines, Vector, number_text, read_file, type_count

most_particles = 2**32 - 1024
most_cuboids = 255  # as many as bodies of a case
_shortest_row = 14  # characters of a particle: seven words of one, and what parts them
# Keys, and the members that they become.
_of_domain = {"ParticleDistance": "spacing", "LowerDomain": "lower", "UpperDomain": "upper"}
_of_cuboid = {"Spacing": "spacing", "Type": "type", "Lower": "lower", "Upper": "upper", "Velocity": "velocity"}


@dataclass
class Cuboid:
    line: int
    """Where it starts."""
    spacing: float = 0
    type: int = 0
    lower: Vector = (0, 0, 0)
    upper: Vector = (0, 0, 0)
    velocity: Vector = (0, 0, 0)


@dataclass
class Geometry:
    """Cuboids or particles."""

    path: str
    time: float = 0
    """Of the particles [s]."""
    spacing: float = 0
    lower: Vector = (0, 0, 0)
    upper: Vector = (0, 0, 0)
    cuboids: list[Cuboid] = field(default_factory=list)
    numbers: list[array[float]] = field(default_factory=lambda: [array("d") for _ in range(type_count)])
    """Position and velocity of each particle of a type, six numbers."""

    def particles(self, type: int) -> Iterator[tuple[Vector, Vector]]:
        """Position and velocity of those of a type, in their order."""
        n = iter(self.numbers[type])
        return (((x, y, z), (u, v, w)) for x, y, z, u, v, w in zip(n, n, n, n, n, n, strict=True))

    def used_types(self) -> list[int]:
        found = {cuboid.type for cuboid in self.cuboids}
        return [type for type in range(type_count) if type in found or self.numbers[type]]


def read_geometry(path: str) -> Geometry:
    """Raises InputError that begins with the path, and with the line where there is one."""
    extension = os.path.splitext(path)[1]
    if extension == ".grid":
        return read_particles(path, read_file(path))
    if extension == ".boid":
        return read_cuboids(path, read_file(path))
    raise InputError(f"{path}: expected a file with particles, .grid, or cuboids, .boid, found '{extension}'")


def read_particles(path: str, content: bytes) -> Geometry:
    """path: for messages. Raises InputError that begins with path:line and says what was found and expected."""
    lines, g = Lines(path, content), Geometry(path)
    count = _read_header(lines, g)
    found = 0
    while lines.next():
        if found == count:
            lines.fail(f"expected {count} particles, as many as the second row says, found more")
        if len(lines) != 7:
            lines.fail(f"expected 7 values, a type, x, y, z and the velocity along x, y, z, found {len(lines)}")
        type, position = lines.type(0), lines.vector(1)
        g.numbers[type].extend(position + lines.vector(4))
        for axis, lower, x, upper in zip("xyz", g.lower, position, g.upper, strict=True):
            if not lower <= x < upper:
                lines.fail(
                    f"expected a particle inside of the domain, {axis} from {number_text(lower)} to less than "
                    f"{number_text(upper)}, found {number_text(x)}"
                )
        found += 1
    if found < count:
        lines.fail(f"expected {count} particles, the file ends after {found}")
    return g


def _read_header(lines: Lines, g: Geometry) -> int:
    """The first two rows; returns the number of particles."""
    if not lines.next():
        lines.fail("the file is empty; expected a line with the time [s]")
    if len(lines) != 1:
        lines.fail(f"expected one number, the time [s], found {len(lines)} words")
    g.time = lines.number(0)
    if g.time < 0:
        lines.fail(f"expected a time that is not negative, found {number_text(g.time)}")
    header = "the number of particles, their distance, and least and largest x, y and z"
    if not lines.next():
        lines.fail(f"the file ends after the time; expected a line with {header}")
    if len(lines) != 8:
        lines.fail(f"expected 8 numbers, {header}, found {len(lines)} words")
    count = lines.integer(0, 1, most_particles, "the number of particles")
    g.spacing = lines.positive(1)
    extents = []
    for axis, place in zip("xyz", (2, 4, 6), strict=True):
        low, high = lines.number(place), lines.number(place + 1)
        if not low < high:
            lines.fail(
                f"expected the least {axis} and then the largest {axis}, found {number_text(low)} and "
                f"{number_text(high)}"
            )
        extents.append((low, high))
    g.lower, g.upper = zip(*extents, strict=True)
    if count > lines.size // _shortest_row + 1:
        lines.fail(
            f"expected rows of {count} particles, found a file of {lines.size} characters, which has no room for them"
        )
    return count


def read_cuboids(path: str, content: bytes) -> Geometry:
    """path: for messages. Raises InputError that begins with path:line and says what was found and expected."""
    lines, g = Lines(path, content), Geometry(path)
    found: set[str] = set()  # keys outside of cuboids
    while lines.next():
        if lines.word(0) == "StartCuboid":
            lines.require_values(0, "StartCuboid")
            _require_keys(lines, found, ("ParticleDistance",), "what stands before the first cuboid")
            g.cuboids.append(_read_cuboid(lines, g))
            continue
        _read_entry(lines, found, _of_domain, "StartCuboid", g)
        if lines.word(0) != "ParticleDistance" and {"LowerDomain", "UpperDomain"} <= found:
            _require_order(lines, "LowerDomain", g.lower, "UpperDomain", g.upper)
    _require_keys(lines, found, _of_domain, "the file")
    if not g.cuboids:
        lines.fail("the file has no cuboid; expected 'StartCuboid'")
    return g


def _read_cuboid(lines: Lines, g: Geometry) -> Cuboid:
    if len(g.cuboids) == most_cuboids:
        lines.fail(
            f"expected at most {most_cuboids} cuboids, found more; the particles that are made of them (.grid) can be "
            "imported"
        )
    cuboid = Cuboid(lines.line)
    found: set[str] = set()
    while True:
        if not lines.next():
            lines.fail(f"the file ends in the cuboid of line {cuboid.line}")
        if lines.word(0) == "EndCuboid":
            break
        _read_entry(lines, found, _of_cuboid, "EndCuboid", cuboid)
        if lines.word(0) == "Spacing" and abs(cuboid.spacing - g.spacing) > 1e-9 * g.spacing:
            lines.fail(
                f"expected the Spacing to be the ParticleDistance, {number_text(g.spacing)}, found "
                f"{number_text(cuboid.spacing)}; the particles that are made of the cuboids (.grid) can be imported"
            )
    lines.require_values(0, "EndCuboid")
    _require_keys(lines, found, _of_cuboid, "the cuboid")
    _require_order(lines, "Lower", cuboid.lower, "Upper", cuboid.upper)
    return cuboid


def _read_entry(lines: Lines, found: set[str], known: Mapping[str, str], end: str, target: Cuboid | Geometry) -> None:
    """A key that is known, once, with its numbers."""
    key = lines.word(0)
    if key in found:
        lines.fail(f"'{key:.40}' stands twice; expected it once")
    if key not in known:
        lines.fail(f"expected {', '.join(map(repr, known))} or '{end}', found '{key:.40}'")
    found.add(key)
    is_vector = key not in ("ParticleDistance", "Spacing", "Type")
    lines.require_values(3 if is_vector else 1, key)
    read = lines.vector if is_vector else lines.type if key == "Type" else lines.positive
    setattr(target, known[key], read(1))


def _require_keys(lines: Lines, found: set[str], expected: Iterable[str], where: str) -> None:
    for key in expected:
        if key not in found:
            lines.fail(f"expected '{key}' in {where}, which ends without it")


def _require_order(lines: Lines, lower_key: str, lower: Vector, upper_key: str, upper: Vector) -> None:
    for axis, low, high in zip("xyz", lower, upper, strict=True):
        if not low < high:
            lines.fail(
                f"expected the {axis} of {lower_key} to be less than that of {upper_key}, found {number_text(low)} and "
                f"{number_text(high)}"
            )

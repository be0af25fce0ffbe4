"""The bodies of a case that parameters and particles or cuboids become."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..cases import Body, Rotation
from .geometry import Cuboid, Geometry
from .lines import Vector, first_wall, number_text, type_count
from .parameters import Parameters


def name_of_type(type: int) -> str:
    """fluid0, fluid1, wall2, wall3."""
    return f"{'fluid' if type < first_wall else 'wall'}{type}"


def add_bodies(
    p: Parameters, g: Geometry, dimensions: int, name: str, warnings: list[str]
) -> tuple[list[Body], dict[str, str]]:
    """Bodies, and the content of their files by name; name: that of the case file, without its ending."""
    maker = _BodyMaker(p, g, dimensions, warnings)
    bodies = [maker.of_cuboid(number, cuboid) for number, cuboid in enumerate(g.cuboids, 1)]
    tables = {}
    for type in range(type_count):
        if g.numbers[type]:
            file = f"{name}-{name_of_type(type)}.csv"
            body, tables[file] = maker.of_particles(type, file)
            bodies.append(body)
    maker.note_walls()
    maker.note_fractions()
    return bodies, tables


class _BodyMaker:
    def __init__(self, p: Parameters, g: Geometry, dimensions: int, warnings: list[str]) -> None:
        self.p, self.g, self.dimensions, self.warnings = p, g, dimensions, warnings

    def of_cuboid(self, number: int, cuboid: Cuboid) -> Body:
        body = self._body(cuboid.type, f"cuboid{number}", cuboid.velocity, f"{self.g.path}:{cuboid.line}")
        body.shape = "box"
        body.min, body.max = cuboid.lower[: self.dimensions], cuboid.upper[: self.dimensions]
        return body

    def of_particles(self, type: int, file: str) -> tuple[Body, str]:
        """The body, and the content of its file, with velocities only where these differ, and not for walls."""
        d, rows = self.dimensions, list(self.g.particles(type))
        velocity: Vector = rows[0][1] if type < first_wall else (0, 0, 0)
        for _, other in rows if type < first_wall else ():
            self._flattened(other, f"{self.g.path}: the velocity")
        differ = type < first_wall and any(other[:d] != velocity[:d] for _, other in rows)
        body = self._body(type, "particles", (0, 0, 0) if differ else velocity, self.g.path)
        body.shape, body.file, body.file_velocities = "particles", file, True if differ else None
        columns = ["x", "y", "z"][:d] + (["vx", "vy", "vz"][:d] if differ else [])
        lines = [",".join(columns)]
        for position, other in rows:
            lines.append(",".join(map(number_text, position[:d] + other[:d] if differ else position[:d])))
        return body, "\n".join(lines) + "\n"

    def note_walls(self) -> None:
        for cuboid in self.g.cuboids:
            if cuboid.type >= first_wall:
                self._note_wall(cuboid.type, cuboid.lower, cuboid.velocity)
        for type in range(first_wall, type_count):
            for position, velocity in self.g.particles(type):
                self._note_wall(type, position, velocity)

    def note_fractions(self) -> None:
        """A cuboid of which nobody knows here how many particles the program would give it."""
        for cuboid in self.g.cuboids:
            for k in range(self.dimensions):
                n = (cuboid.upper[k] - cuboid.lower[k]) / self.g.spacing
                if math.isfinite(n) and abs(n - round(n)) > 1e-6 * n:
                    self.warnings.append(
                        f"{self.g.path}:{cuboid.line}: the cuboid is {n:.6g} Spacings long along {'xyz'[k]}, not a "
                        "whole number: its particles may be others than those that are made of it (.grid), which can "
                        "be imported"
                    )

    def _body(self, type: int, what: str, velocity: Vector, place: str) -> Body:
        kind = name_of_type(type)
        body = Body(name=f"{kind}-{what}", type="fluid" if type < first_wall else "wall", material=kind)
        if type < first_wall:
            velocity = self._flattened(velocity, f"{place}: the velocity")
        else:
            center, given, omega = self._wall(type)
            velocity = self._flattened(given, f"{self.p.path}: the Velocity of Wall{type}")
            body.rotation = self._rotation(type, center, omega)
        if any(velocity):
            body.velocity = velocity[: self.dimensions]
        return body

    def _rotation(self, type: int, center: Vector, omega: Vector) -> Rotation | None:
        if self.dimensions == 3:
            speed = _norm(omega)
            return Rotation(center=center, axis=omega, speed=speed) if speed != 0 else None
        if omega[0] != 0 or omega[1] != 0:
            self._note(
                f"{self.p.path}: the Omega of Wall{type} has parts along x and y that are left out: the particles are "
                "one layer"
            )
        return Rotation(center=center[:2], speed=omega[2]) if omega[2] != 0 else None

    def _wall(self, type: int) -> tuple[Vector, Vector, Vector]:
        """Centre, velocity and angular velocity of all walls of a type."""
        a, b, c, u, v, w, p, q, r = self.p[f"Wall{type}"]
        return (a, b, c), (u, v, w), (p, q, r)

    def _note_wall(self, type: int, position: Vector, velocity: Vector) -> None:
        """What a wall is given in this file the parameters say better."""
        if not any(velocity):
            return
        center, given, (p, q, r) = self._wall(type)
        x, y, z = (a - b for a, b in zip(position, center, strict=True))
        turning = (q * z - r * y, r * x - p * z, p * y - q * x)
        expected = [a + b for a, b in zip(given, turning, strict=True)]
        if _norm([a - b for a, b in zip(velocity, expected, strict=True)]) > 1e-5 * _norm(expected):
            self._note(
                f"{self.g.path}: velocities of type {type} are not those of the row Wall{type} in {self.p.path}, and "
                "left out"
            )

    def _flattened(self, x: Vector, what: str) -> Vector:
        if self.dimensions == 3:
            return x
        if x[2] != 0:
            self._note(f"{what} has a part along z that is left out: the particles are one layer")
        return x[0], x[1], 0

    def _note(self, text: str) -> None:
        if text not in self.warnings:
            self.warnings.append(text)


def _norm(x: Sequence[float]) -> float:
    return math.sqrt(sum(a * a for a in x))

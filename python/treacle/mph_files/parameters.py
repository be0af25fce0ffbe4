"""The parameters (.data)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from .lines import Lines, first_wall, type_count

_positive = ("Dt", "EndTime", "RadiusRatioP", "RadiusRatioV")
_not_negative = ("OutputInterval", "VtkOutputInterval", "RadiusRatioA")
_constants = ("Density", "BulkModulus", "BulkViscosity", "ShearViscosity")  # of each type
_ratios = tuple(f"InteractionRatio(Type{k})" for k in range(type_count))
_walls = tuple(f"Wall{k}" for k in range(first_wall, type_count))
_required = ("Dt", "EndTime", "RadiusRatioP", "RadiusRatioV", *_constants, "Gravity")


@dataclass
class Parameters:
    """The numbers of each row; a wall has three of its centre, three of its velocity and three of its turning."""

    path: str
    rows: dict[str, Sequence[float]]
    lines: dict[str, int] = field(default_factory=dict)
    """Where the rows stand."""
    warnings: list[str] = field(default_factory=list)
    """Rows that are not known."""

    def __getitem__(self, row: str) -> Sequence[float]:
        return self.rows[row]

    def number(self, row: str) -> float:
        return self.rows[row][0]

    def place(self, row: str) -> str:
        """For messages."""
        return f"{self.path}:{self.lines[row]}: {row}" if row in self.lines else f"{self.path}: {row}"


def read_parameters(path: str, content: bytes) -> Parameters:
    """path: for messages. Raises InputError that begins with path:line and says what was found and expected."""
    lines = Lines(path, content)
    defaults: dict[str, Sequence[float]] = {"SurfaceTension": [0.0] * type_count}
    defaults |= {row: [0.0] for row in _not_negative}
    defaults |= {row: [0.0] * 9 for row in _walls}
    defaults |= {row: [1.0] * type_count for row in _ratios}
    p = Parameters(path, defaults)
    while lines.next():
        key = lines.word(0)
        if key in p.lines:
            lines.fail(f"{key} stands twice, first in line {p.lines[key]}; expected it once")
        values = _values(lines, key)
        if values is None:
            p.warnings.append(f"{path}:{lines.line}: '{key:.40}' is not a row that is known, and is left out")
        else:
            p.rows[key], p.lines[key] = values, lines.line
    missing = [row for row in _required if row not in p.lines]
    if missing:
        lines.fail(
            f"the file ends without the row{'s' if len(missing) > 1 else ''} {', '.join(missing)}; expected a file of "
            f"parameters (.data) with {', '.join(_required)}"
        )
    return p


def _values(lines: Lines, key: str) -> Sequence[float] | None:
    """None: the row is not known."""
    if key in _positive or key in _not_negative:
        lines.require_values(1, key)
        return [lines.positive(1) if key in _positive else lines.not_negative(1)]
    if key in _constants or key in _ratios or key == "SurfaceTension":
        if len(lines) != type_count + 1:
            lines.fail(
                f"{key}: expected {type_count} numbers, one for each of the types 0 to {type_count - 1}, found "
                f"{len(lines) - 1}"
            )
        read = lines.not_negative if key in _constants else lines.number
        return [read(k + 1) for k in range(type_count)]
    if key == "Gravity":
        lines.require_values(3, key)
        return lines.vector(1)
    if key in _walls:
        if len(lines) != 13 or [lines.word(k) for k in (1, 5, 9)] != ["Center", "Velocity", "Omega"]:
            lines.fail(f"{key}: expected 'Center' with 3 numbers, 'Velocity' with 3 and 'Omega' with 3, in this order")
        return lines.vector(2) + lines.vector(6) + lines.vector(10)
    return None

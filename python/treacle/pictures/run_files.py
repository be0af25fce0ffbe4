"""The files of a run directory, those of a run that goes on, too: what is not there yet is empty or None."""

import csv
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import Floats, Table
from .errors import PictureError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@dataclass(frozen=True)
class FrameFile:
    """A line of an index of frames."""

    time: float  # [s]
    path: Path


def read_index(path: Path) -> list[FrameFile]:
    """The frames that a .pvd file names, in order; none where there is no file."""
    try:
        lines = ElementTree.parse(path).iterfind(".//DataSet")
        return [FrameFile(float(line.attrib["timestep"]), path.parent / line.attrib["file"]) for line in lines]
    except FileNotFoundError:
        return []
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise PictureError(f"{path}: not an index of frames as treacle writes it ({error})") from None


def read_table(path: Path) -> Table:
    """Columns of a CSV file by name, as arrays of numbers. A last row that is not whole is left out, and so are columns
    that hold no numbers. Empty where there is no file."""
    try:
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
    except FileNotFoundError:
        return {}
    if not rows:
        return {}
    names, values = rows[0], [row for row in rows[1:] if len(row) == len(rows[0])]
    table = {}
    for column, name in enumerate(names):
        try:
            table[name] = np.array([row[column] or "nan" for row in values], float)
        except ValueError:
            continue
    return table


class RunFiles:
    """A run directory. Raises PictureError if it is none."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        if not self.path.is_dir():
            raise PictureError(f"{path}: no such directory; expected that of a run")
        if not (self.path / "case.toml").is_file() or not (self.path / "run.log").is_file():
            raise PictureError(f"{path}: not the directory of a run: expected case.toml and run.log in it")

    @cached_property
    def case(self) -> dict[str, Any]:
        """The case with all its keys."""
        try:
            found: dict[str, Any] = tomllib.loads((self.path / "case.toml").read_text())
            return found
        except tomllib.TOMLDecodeError as error:
            raise PictureError(f"{self.path / 'case.toml'}: {error}") from None

    @property
    def places(self) -> str:
        """The directory, in words."""
        return str(self.path)

    @property
    def dimensions(self) -> int:
        found: int = self.case["dimensions"]
        return found

    @property
    def spacing(self) -> float:
        """Distance of particles [m]."""
        found: float = self.case["spacing"]
        return found

    @property
    def title(self) -> str:
        title: str = self.case.get("title", "")
        return title or self.path.name

    @cached_property
    def gravity(self) -> Floats:
        """[m/s2], three components."""
        given = self.case.get("gravity", {}).get("acceleration", [])
        return np.array((list(given) + [0, 0, 0])[:3], float)

    @property
    def periodic(self) -> bool:
        """Whether some axis of the domain is."""
        return any(np.atleast_1d(self.case["domain"].get("periodic", False)))

    @cached_property
    def fluid(self) -> list[FrameFile]:
        """Frames of the fluid. Raises PictureError where there is none yet."""
        frames = read_index(self.path / "fluid.pvd")
        if not frames:
            raise PictureError(f"{self.path}: the run has no frame")
        return frames

    @cached_property
    def walls(self) -> list[FrameFile]:
        """Frames of the walls, by the time of the fluid's; there may be fewer, and none in cases without walls."""
        return read_index(self.path / "walls.pvd")

    def surface_file(self, frame: int) -> Path:
        """Where the surface of the fluid in a frame is, if it has been made."""
        return self.fluid[frame].path.with_name(f"surface_{self._digits(frame)}.vtp")

    def origin(self, frame: int) -> tuple[Path, int]:
        """The run directory that a frame is in, and its number there."""
        return self.fluid[frame].path.parents[1], int(self._digits(frame))

    def _digits(self, frame: int) -> str:
        path = self.fluid[frame].path
        found = re.search(r"(\d+)$", path.name.split(".")[0])
        if not found:
            raise PictureError(f"{path}: expected a name that ends in the number of the frame")
        return found[1]

    @cached_property
    def summary(self) -> dict[str, Any] | None:
        """summary.json; None before the run has ended."""
        try:
            found: dict[str, Any] = json.loads((self.path / "summary.json").read_text())
            return found
        except FileNotFoundError:
            return None
        except ValueError as error:
            raise PictureError(f"{self.path / 'summary.json'}: {error}") from None

    @cached_property
    def log(self) -> list[str]:
        return (self.path / "run.log").read_text(errors="replace").splitlines()

    @property
    def warnings(self) -> list[str]:
        """Lines of the log, in order, with their time."""
        return [line for line in self.log if re.match(r"\S+ \S+ (warning|error): ", line)]

    @cached_property
    def history(self) -> Table:
        return read_table(self.path / "history.csv")

    @cached_property
    def balance(self) -> Table:
        return read_table(self.path / "balance.csv")

    @cached_property
    def rigid_bodies(self) -> Table:
        return read_table(self.path / "rigid_bodies.csv")

    @cached_property
    def probes(self) -> dict[str, Table]:
        """What probes have read: tables by the names of the probes."""
        return {file.stem: read_table(file) for file in sorted((self.path / "probes").glob("*.csv"))}

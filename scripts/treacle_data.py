"""Runs treacle and reads what it leaves, as NumPy arrays in SI units. Used by the validation studies and the reproduction
of the papers; needs Python 3.10 and NumPy."""

import csv
import json
import math
import re
import subprocess
import time
import xml.etree.ElementTree as ElementTree
import zlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

vtk_types = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt32": "<u4", "Int64": "<i8", "UInt64": "<u8"}


class RunFailed(Exception):
    """treacle ended with another exit code than 0; the message holds the command and what it printed."""


def json_text(value):
    """Indented JSON with each list of numbers on one line."""
    text = json.dumps(value, indent=1, ensure_ascii=False)
    return re.sub(r"\[[^\[\]{}\"]*\]", lambda numbers: re.sub(r"\s+", " ", numbers[0]), text) + "\n"


def searched(pattern, text, flags=0):
    """The first group of a pattern in a text. Raises ValueError where the text does not have it."""
    if not (found := re.search(pattern, text, flags)):
        raise ValueError(f"expected {pattern} in: {text[:200]}")
    return found[1]


def call(command, **options):
    """Runs a command; returns what it printed to stdout. Raises RunFailed."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        words = " ".join(str(word) for word in command)
        raise RunFailed(f"{words}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


@dataclass
class Frame:
    """Particles at one time: arrays of one row per particle, vectors with as many columns as the case has dimensions."""

    time: float
    fields: dict = field(repr=False)

    def __getattr__(self, name):
        try:
            return self.__dict__["fields"][name]
        except KeyError:
            raise AttributeError(f"the frame holds no '{name}'") from None


def read_vtp(path):
    """A frame as treacle writes it: appended binary data with 64-bit lengths, compressed by zlib or not."""
    content = Path(path).read_bytes()
    mark = content.index(b'<AppendedData encoding="raw">')
    begin = content.index(b"_", mark) + 1
    header = ElementTree.fromstring(content[:mark] + b"</VTKFile>")
    compressed = header.get("compressor") is not None
    dimensions = int(header.findtext(".//DataArray[@Name='dimensions']", ""))
    fields = {}
    for array in header.findall(".//PointData/DataArray") + header.findall(".//Points/DataArray"):
        offset = begin + int(array.attrib["offset"])
        size = int(np.frombuffer(content, "<u8", 1, offset)[0])
        kind = np.dtype(vtk_types[array.attrib["type"]])
        if compressed:
            sizes = np.frombuffer(content, "<u8", size, offset + 24).astype(int)
            ends = offset + 24 + 8 * size + np.cumsum(sizes)
            blocks = [zlib.decompress(content[end - length : end]) for length, end in zip(sizes, ends, strict=True)]
            values = np.frombuffer(b"".join(blocks), kind)
        else:
            values = np.frombuffer(content, kind, size // kind.itemsize, offset + 8)
        if array.get("NumberOfComponents") == "3":
            values = values.reshape(-1, 3)[:, :dimensions]
        fields[array.attrib["Name"]] = values.astype(float) if kind.kind == "f" else values
    return Frame(float(header.findtext(".//DataArray[@Name='TimeValue']", "")), fields)


def read_table(path):
    """A CSV file with a header line: a dictionary of arrays by column."""
    with open(path) as file:
        names = next(csv.reader(file))  # names of bodies may be in quotes
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    return (
        {name: rows[:, column] for column, name in enumerate(names)} if rows.size else {n: np.empty(0) for n in names}
    )


class Run:
    """A run directory of treacle."""

    def __init__(self, path):
        self.path = Path(path)
        self.seconds = math.nan  # that the command took which made it, where it is known

    @cached_property
    def summary(self):
        return json.loads((self.path / "summary.json").read_text())

    @cached_property
    def history(self):
        return read_table(self.path / "history.csv")

    @cached_property
    def balance(self):
        return read_table(self.path / "balance.csv")

    @cached_property
    def rigid_bodies(self):
        return read_table(self.path / "rigid_bodies.csv")

    def _frames(self, index):
        text = (self.path / index).read_text()
        return [(float(t), self.path / f) for t, f in re.findall(r'timestep="([^"]*)".*?file="([^"]*)"', text)]

    @cached_property
    def times(self):
        """Of the frames [s]."""
        return np.array([t for t, _ in self._frames("fluid.pvd")])

    def frame(self, number=-1):
        """The fluid particles of a frame; the last one without a number."""
        return read_vtp(self._frames("fluid.pvd")[number][1])

    def frames(self):
        for number in range(len(self.times)):
            yield self.frame(number)

    def walls(self, number=-1):
        return read_vtp(self._frames("walls.pvd")[number][1])


def run_case(program, case, directory, settings=(), options=()):
    """Runs a case into a directory, replacing an older run there. settings: KEY=VALUE overrides; options: further words of
    the command line. Returns the Run, with the wall-clock time of the whole command as `seconds`. Raises RunFailed."""
    command = [program, "run", case, "-o", directory, "--quiet", "--force"]
    for setting in settings:
        command += ["--set", setting]
    start = time.perf_counter()
    call(command + list(options))
    run = Run(directory)
    run.seconds = time.perf_counter() - start
    return run

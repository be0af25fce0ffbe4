"""Frames as arrays: positions and fields of particles, or points and triangles of surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader

from .arrays import Array
from .errors import PictureError


@dataclass
class Particles:
    """Of one frame; rows whose position is not finite are left out."""

    positions: Array  # [m], three columns
    fields: dict[str, Array]  # of one row per particle
    data: Any  # what VTK has read, all rows

    def __len__(self) -> int:
        return len(self.positions)

    def chosen(self, rows: Array) -> Particles:
        """Those of some rows, or by a mask."""
        return Particles(self.positions[rows], {name: values[rows] for name, values in self.fields.items()}, self.data)


def none() -> Particles:
    return Particles(np.zeros((0, 3)), {}, None)


class Messages(list[str]):
    """What VTK reports, which it calls this with."""

    CallDataType = "string0"  # the report is a text

    def __call__(self, _: object, __: str, text: str = "") -> None:
        self.append(text.strip())


def read_particles(path: Path) -> Particles:
    """A .vtp file, or a .pvtp file and the pieces that it names. Raises PictureError where it cannot be read."""
    messages = Messages()
    reader = vtkXMLPPolyDataReader() if path.suffix == ".pvtp" else vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", messages)
    if hasattr(reader, "GetReaderErrorObserver"):
        reader.SetReaderErrorObserver(None)
    if not path.is_file():
        raise PictureError(f"{path}: no such file, though the index of the run names it")
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    if messages or data is None:
        raise PictureError(f"{path}: cannot be read: {messages[0] if messages else 'no data'}")
    if data.GetNumberOfPoints() == 0:
        return none()
    positions = vtk_to_numpy(data.GetPoints().GetData())
    arrays = data.GetPointData()
    fields = {arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k)) for k in range(arrays.GetNumberOfArrays())}
    particles = Particles(positions, fields, data)
    finite = np.isfinite(positions).all(axis=1)
    return particles if finite.all() else particles.chosen(finite)

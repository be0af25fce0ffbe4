"""Frames as arrays: positions and fields of particles, or points and triangles of surfaces."""

from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader

from .errors import PictureError


@dataclass
class Particles:
    """Of one frame; rows whose position is not finite are left out."""

    positions: np.ndarray  # [m], three columns
    fields: dict  # arrays of one row per particle
    data: object  # what VTK has read, all rows

    def __len__(self):
        return len(self.positions)

    def chosen(self, rows):
        """Those of some rows, or by a mask."""
        return Particles(self.positions[rows], {name: values[rows] for name, values in self.fields.items()}, self.data)


def none():
    return Particles(np.zeros((0, 3)), {}, None)


def read_particles(path):
    """A .vtp file, or a .pvtp file and the pieces that it names. Raises PictureError where it cannot be read."""
    messages = []

    def take(_, __, text=""):
        messages.append(text.strip())

    take.CallDataType = "string0"
    reader = vtkXMLPPolyDataReader() if path.suffix == ".pvtp" else vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", take)
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

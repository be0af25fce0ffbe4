"""Marks on pictures that say how large things are: axes of two dimensions, a bar of some length in three."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401, draws letters
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D, vtkTextActor

from .arrays import Floats, Place
from .fields import scaled_unit

if TYPE_CHECKING:
    from .scene import Colours

ink = (0.15, 0.15, 0.15)
font = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
font_of_file = 4  # VTK_FONT_FILE


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above it."""
    power = 10.0 ** math.floor(math.log10(most))
    return max(factor * power for factor in (1, 2, 5) if factor * power <= most * (1 + 1e-9))


def ticks(low: float, high: float, most: float) -> list[float]:
    """At most so many round numbers in the range, at equal distances."""
    power = 10.0 ** math.floor(math.log10((high - low) / (most + 1)))
    for step in (factor * power for factor in (1, 2, 5, 10, 20, 50, 100)):
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        if last - first < most:
            break
    return [k * step for k in range(first, last + 1)]


def lines(pairs: Iterable[tuple[Place, Place]], width: float = 1) -> vtkActor2D:
    """Straight lines between pairs of places [px]."""
    points, cells = vtkPoints(), vtkCellArray()
    for a, b in pairs:
        cells.InsertNextCell(2)
        for x, y in (a, b):
            cells.InsertCellPoint(points.InsertNextPoint(x, y, 0))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(data)
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(ink)
    actor.GetProperty().SetLineWidth(width)
    return actor


def text(words: str, place: Place, size: int, across: str = "left", along: str = "bottom") -> vtkTextActor:
    """Words at a place [px] of letters so high [px]; across: left, center or right; along: bottom, center or top."""
    actor = vtkTextActor()
    actor.SetInput(words)
    actor.SetPosition(*place)
    style = actor.GetTextProperty()
    style.SetColor(ink)
    style.SetFontFamily(font_of_file)
    style.SetFontFile(str(font))
    style.SetFontSize(size)
    style.SetJustification(("left", "center", "right").index(across))  # as VTK numbers them
    style.SetVerticalJustification(("bottom", "center", "top").index(along))
    return actor


def powers(low: float, high: float, most: int) -> list[float]:
    """At most so many round numbers in a range of powers of ten."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    every = max(1, math.ceil((last - first + 1) / most))
    return [10.0**k for k in range(first, last + 1, every)] or [low, high]


def colour_bar(colours: Colours, words: str, corner: Place, size: Place, end: float, letters: int) -> list[vtkActor2D]:
    """Actors of a bar with numbers beside and words above it. corner: lower left [px]; size: width and height [px];
    end: of the words [px]; letters: their height [px]."""
    (x, y), (width, height) = corner, size
    points, cells, parts = vtkPoints(), vtkCellArray(), 256
    for k in range(parts):
        bottom, top = y + height * k / parts, y + height * (k + 1) / parts
        cells.InsertNextCell(4)
        for place in ((x, bottom), (x + width, bottom), (x + width, top), (x, top)):
            cells.InsertCellPoint(points.InsertNextPoint(*place, 0))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    shades = matplotlib.colormaps[colours.map](np.linspace(0, 1, parts), bytes=True)[:, :3]
    data.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(shades), deep=True, array_type=VTK_UNSIGNED_CHAR))
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(data)
    bar = vtkActor2D()
    bar.SetMapper(mapper)
    low, high = colours.bounds
    scale: Callable[[float], float]
    if colours.logarithmic:
        numbers, scale = powers(low, high, 8), lambda value: math.log(value / low) / math.log(high / low)
    else:
        numbers, scale = ticks(low, high, 7), lambda value: (value - low) / (high - low)
    edge, pairs, actors = x + width, [], [bar]
    for number in numbers:
        at = y + height * scale(number)
        pairs.append(((edge, at), (edge + letters / 3, at)))
        actors.append(text(f"{number:.5g}", (edge + 0.6 * letters, at), letters, "left", "center"))
    return [*actors, lines(pairs), text(words, (end, y + height + letters), letters, "right")]


def axes(low: Floats, high: Floats, place: Callable[[float, float], Place], letters: int) -> list[vtkActor2D]:
    """Actors of a frame around what is between two corners [m], with numbers along x and y. place(x, y): where that is
    [px]; letters: their height [px]."""
    (left, bottom), (right, top) = place(*low), place(*high)
    tick = letters / 3
    unit, count = scaled_unit(max(high[0] - low[0], high[1] - low[1]))
    pairs = [
        ((left, bottom), (right, bottom)),
        ((right, bottom), (right, top)),
        ((right, top), (left, top)),
        ((left, top), (left, bottom)),
    ]
    actors = []
    for x in ticks(low[0], high[0], max(2, (right - left) / (5 * letters))):
        at = place(x, low[1])[0]
        pairs.append(((at, bottom), (at, bottom - tick)))
        actors.append(text(f"{x * count:.6g}", (at, bottom - 1.5 * tick), letters, "center", "top"))
    for y in ticks(low[1], high[1], max(2, (top - bottom) / (3 * letters))):
        at = place(low[0], y)[1]
        pairs.append(((left, at), (left - tick, at)))
        actors.append(text(f"{y * count:.6g}", (left - 1.8 * tick, at), letters, "right", "center"))
    actors.append(text(f"x, y [{unit}]", (right, bottom - 2 * tick - 1.3 * letters), letters, "right", "top"))
    return [lines(pairs), *actors]


def length_bar(metre: float, corner: Place, most: float, letters: int) -> list[vtkActor2D]:
    """Actors of a bar of round length with its length. metre: [px]; corner: lower left [px]; most: its largest length
    [px]."""
    length = round_length(most / metre)
    unit, count = scaled_unit(length)
    x, y = corner
    end = x + length * metre
    tick = letters / 4
    bar = lines([((x, y), (end, y)), ((x, y - tick), (x, y + tick)), ((end, y - tick), (end, y + tick))], 2)
    return [bar, text(f"{length * count:.6g} {unit}", ((x + end) / 2, y + 1.5 * tick), letters, "center")]

"""Pictures of frames, drawn by VTK without a display."""

import ctypes.util
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import vtkLogger

from . import fields, marks
from .arrays import Array, Floats, Place
from .camera import Extent, View
from .errors import PictureError

wall_colour = "#b9bec4"
fluid_colour = "#d99a2b"  # without a field: honey
points_of_faint_walls = 0.06  # opacity


@dataclass(frozen=True)
class Colours:
    """What they stand for, the same in all pictures of a film."""

    field: str | None
    bounds: tuple[float, float] = (0.0, 1.0)
    map: str = "viridis"

    @property
    def logarithmic(self) -> bool:
        return self.field is not None and fields.logarithmic(self.field, self.bounds)


def require_drawing() -> None:
    """Raises PictureError where no library of OpenGL can draw without a display: VTK would crash."""
    window = pyvista.Plotter(off_screen=True, window_size=(16, 16))
    if type(window.render_window).__name__ == "vtkOSOpenGLRenderWindow" and not ctypes.util.find_library("OSMesa"):
        raise PictureError(
            "no OpenGL that draws without a display: expected EGL (apt install libegl1 libgl1-mesa-dri) or OSMesa "
            "(apt install libosmesa6)"
        )
    window.close()


class Scene:
    """A place for one picture after another. flat: of two dimensions."""

    def __init__(self, size: tuple[int, int], colours: Colours, spacing: float, flat: bool) -> None:
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # it tells which displays it has not found
        require_drawing()
        self.size, self.colours, self.spacing, self.flat = size, colours, spacing, flat
        self.letters = max(10, round(size[1] / 32))  # height [px]
        self.plotter = pyvista.Plotter(off_screen=True, window_size=size, lighting="light kit")
        self.plotter.set_background("white")
        self.plotter.enable_parallel_projection()
        self.plotter.enable_anti_aliasing("msaa", multi_samples=4)
        self.stamp = marks.text("", (self.letters, size[1] - self.letters), self.letters, along="top")
        self.plotter.add_actor(self.stamp, reset_camera=False, render=False)
        self.fluid = self.walls = None
        self.marks: list[Any] = []  # actors of VTK

    def close(self) -> None:
        self.plotter.close()

    def aim(self, view: View, extent: Extent) -> None:
        """Looks along a View at an Extent, which fills what title, colours and axes leave of the picture."""
        width, height = self.size
        bar = 0.16 * width if self.colours.field else 0.03 * width
        left, bottom = (5.5 * self.letters, 4.5 * self.letters) if self.flat else (0.03 * width, 3 * self.letters)
        inside = np.array([width - left - bar, height - bottom - 3 * self.letters])
        extents = np.maximum(extent.size, self.spacing)
        metre = float(np.min(inside / extents[:2]))  # [px]
        # The middle of the picture is not that of what is shown.
        shift = (np.array([width, height]) / 2 - np.array([left, bottom]) - inside / 2) / metre
        middle = extent.center + np.array([shift[0], shift[1], 0])
        camera = self.plotter.camera
        camera.focal_point = middle @ view.axes
        camera.position = (middle + [0, 0, 2 * extents.max()]) @ view.axes
        camera.up = view.axes[1]
        camera.parallel_scale = height / 2 / metre
        camera.clipping_range = (0.5 * extents.max(), 6 * extents.max())
        self.view, self.metre = view, metre
        self._mark(extent, lambda x, y: (width / 2 + metre * (x - middle[0]), height / 2 + metre * (y - middle[1])))

    def _mark(self, extent: Extent, place: Callable[[float, float], Place]) -> None:
        for actor in self.marks:
            self.plotter.remove_actor(actor, reset_camera=False, render=False)
        (width, height), edge, small = self.size, self.letters, round(0.8 * self.letters)
        if self.flat:
            self.marks = marks.axes(extent.low[:2], extent.high[:2], place, small)
        else:
            self.marks = marks.length_bar(self.metre, (edge, edge), 0.2 * width, small)
        if self.colours.field:
            corner, shape = (0.865 * width, 0.2 * height), (0.022 * width, 0.55 * height)
            words = fields.label(self.colours.field)
            self.marks += marks.colour_bar(self.colours, words, corner, shape, width - edge, small)
        for actor in self.marks:
            self.plotter.add_actor(actor, reset_camera=False, render=False)

    def draw_walls(self, positions: Array, faint: bool) -> None:
        """Grey balls; faint: translucent ones."""
        self.plotter.remove_actor(self.walls, reset_camera=False, render=False)
        self.walls = None
        if len(positions):
            look = {"opacity": points_of_faint_walls, "lighting": False} if faint else {"lighting": not self.flat}
            self.walls = self._points(positions, color=wall_colour, **look)

    def draw_particles(self, positions: Array, values: Floats | None) -> None:
        """Balls, in two dimensions discs, of one spacing. values: of the colours' field, None without one."""
        self.plotter.remove_actor(self.fluid, reset_camera=False, render=False)
        self.fluid = None
        if len(positions):
            self.fluid = self._points(positions, lighting=not self.flat, **self._colouring(values))

    def draw_surface(self, data: Any, values: Floats | None) -> None:
        """Shaded triangles, a surface as `treacle surface` makes it; data: as VTK reads it."""
        self.plotter.remove_actor(self.fluid, reset_camera=False, render=False)
        self.fluid = None
        if data is not None and data.GetNumberOfPolys():
            mesh = pyvista.wrap(data)
            mesh.GetPointData().SetActiveNormals("normal")
            shine = {"specular": 0.35, "specular_power": 25}
            look = {**shine, **self._colouring(values)}
            self.fluid = self.plotter.add_mesh(mesh, reset_camera=False, show_scalar_bar=False, render=False, **look)

    def picture(self, words: str) -> Array:
        """Pixels, with words at the upper left."""
        self.stamp.SetInput(words)
        self.plotter.render()
        return np.ascontiguousarray(self.plotter.screenshot(return_img=True))

    def _points(self, positions: Array, **look: Any) -> Any:
        return self.plotter.add_mesh(
            pyvista.PolyData(np.asarray(positions, np.float32)),
            style="points",
            render_points_as_spheres=True,
            ambient=0.2 if look.get("lighting", True) else 0,
            point_size=max(1.0, self.metre * self.spacing),
            reset_camera=False,
            show_scalar_bar=False,
            render=False,
            **look,
        )

    def _colouring(self, values: Floats | None) -> dict[str, Any]:
        if values is None:
            return {"color": fluid_colour}
        return {
            "scalars": values,
            "clim": self.colours.bounds,
            "cmap": self.colours.map,
            "log_scale": self.colours.logarithmic,
            "nan_color": "grey",
        }

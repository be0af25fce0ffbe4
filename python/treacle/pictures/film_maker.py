"""The work of `treacle movie`: a pass over the frames for colours and camera, then a picture of each."""

import sys
import time
from argparse import Namespace
from collections.abc import Iterable, Iterator
from typing import TypeVar

import matplotlib
import numpy as np
from tqdm import tqdm

from . import camera, fields, surfaces
from .arrays import Array, Floats
from .continued_run import run_of
from .errors import PictureError
from .film import Film, checked, ffmpeg
from .frame_choice import chosen_frames, decimals
from .hiding import FluidBehind, seen
from .particles import Particles, none, read_particles
from .run_files import RunFiles
from .scene import Colours, Scene

most_frames_looked_at = 50  # for the range of the colours and what the camera has to see
walls_around = 0.15  # how much of them the camera shows beside the fluid, in parts of the fluid's extent


Work = TypeVar("Work")


class FilmMaker:
    """What pictures of a run need beside its frames."""

    def __init__(
        self, run: RunFiles, options: Namespace, size: tuple[int, int], given: tuple[float, float] | None
    ) -> None:
        self.run, self.options, self.size, self.given = run, options, size, given
        self.flat = run.dimensions == 2
        self.frames = chosen_frames(run, options)
        self.field = None if options.field == "none" else options.field
        self.direction = None if self.flat else camera.direction(options.camera)
        self.view = camera.View.of(self.direction, run.gravity) if self.direction else camera.View.flat()
        self.digits = decimals(np.array([run.fluid[k].time for k in self.frames]))
        self.shown: tuple[camera.View, Array] | None = None  # walls that are in the scene, with their view
        self._check()

    def _check(self) -> None:
        if self.flat:
            for name, asked in (
                ("--surface", self.options.surface),
                ("--turntable", self.options.turntable is not None),
                ("--camera", self.options.camera != "corner"),
            ):
                if asked:
                    flat = f"{self.run.path}: a case of two dimensions, which is seen from the front"
                    raise PictureError(f"{flat}; expected three for {name}")
        if self.options.colormap not in matplotlib.colormaps:
            some = "such as viridis, plasma, turbo, coolwarm, gray"
            raise PictureError(f"--colormap: '{self.options.colormap}' is none of Matplotlib's, {some}")

    def progress(self, work: Iterable[Work], total: int, words: str) -> Iterable[Work]:
        return tqdm(work, total=total, desc=words, unit="frame", file=sys.stderr, disable=self.options.quiet)

    def walls(self, frame: int) -> Particles:
        """Wall particles of a frame; while a run goes on they may be those of the frame before."""
        if self.options.walls == "hide" or not self.run.walls:
            return none()
        return read_particles(self.run.walls[min(frame, len(self.run.walls) - 1)].path)

    def look_at_frames(self) -> None:
        """The first pass: what the colours go from and to, what the camera shows, which walls are before the fluid."""
        some = np.unique(np.linspace(0, len(self.frames) - 1, most_frames_looked_at).round().astype(int))
        found = fields.Range(self.field)
        self.extent, self.behind = camera.Extent(), FluidBehind(self.run.spacing)
        low, high = self._domain()
        for k in self.progress(some, len(some), "looking at frames"):
            fluid = read_particles(self.run.fluid[self.frames[k]].path)
            places = self.view(fluid.positions)
            if self.field:
                found.add(fields.values(fluid, self.field))
            inside = np.all((fluid.positions >= low) & (fluid.positions <= high), axis=1)
            self.extent.add(places[inside], self.run.spacing / 2)
            self.behind.add(places)
        self._show_walls()
        if self.options.turntable is not None:
            self._widen_for_turn()
        self._zoom()
        self.colours = Colours(self.field, self.given or found.bounds(), self.options.colormap)

    def _show_walls(self) -> None:
        """In two dimensions all of them, in three those near the fluid: it is to be seen on a large plate, too."""
        places = self.view(self.walls(self.frames[0]).positions)
        if not self.flat and not self.extent.empty:
            around = walls_around * self.extent.size.max()
            places = np.clip(places, self.extent.low - around, self.extent.high + around)
        self.extent.add(places, self.run.spacing / 2)

    def _domain(self) -> list[Floats]:
        """Two corners; with three components in two dimensions, too."""
        domain = self.run.case["domain"]
        return [np.array((list(domain[end]) + [far])[:3]) for end, far in (("min", -np.inf), ("max", np.inf))]

    def _widen_for_turn(self) -> None:
        """To what is seen from all sides."""
        self.middle = self.extent.center @ self.view.axes
        half = np.linalg.norm(self.extent.size) / 2
        self.extent.low[0], self.extent.high[0] = self.extent.center[0] - half, self.extent.center[0] + half

    def _zoom(self) -> None:
        if self.extent.empty:
            raise PictureError(f"{self.run.path}: the frames hold no particle in the domain")
        if self.direction and self.direction.zoom != 1:
            center, half = self.extent.center, self.extent.size / 2 / self.direction.zoom
            self.extent.low[:2], self.extent.high[:2] = (center - half)[:2], (center + half)[:2]

    def draw(self, scene: Scene, frame: int, behind: FluidBehind) -> None:
        """Fluid and walls of a frame, seen along the scene's view."""
        if self.options.surface:
            surface = read_particles(self.run.surface_file(frame))
            scene.draw_surface(surface.data, fields.values(surface, self.field) if self.field else None)
        else:
            fluid = read_particles(self.run.fluid[frame].path)
            shown = seen(scene.view(fluid.positions), self.run.spacing)
            values = fields.values(fluid, self.field)[shown] if self.field else None
            scene.draw_particles(fluid.positions[shown], values)
        self.draw_walls(scene, frame, behind)

    def draw_walls(self, scene: Scene, frame: int, behind: FluidBehind) -> None:
        walls = self.walls(frame).positions
        if self.shown and self.shown[0] is scene.view and np.array_equal(self.shown[1], walls):
            return  # they are in the picture
        self.shown = (scene.view, walls)
        faint = self.options.walls == "faint"
        places = scene.view(walls)
        if not (self.flat or faint):
            walls = walls[~behind.hidden_by(places)]
            places = scene.view(walls)
        scene.draw_walls(walls if faint else walls[seen(places, self.run.spacing)], faint)

    def stamp(self, frame: int) -> str:
        return f"t = {self.run.fluid[frame].time:.{self.digits}f} s"

    def pictures(self, scene: Scene) -> Iterator[Array]:
        """Of all frames, one after another."""
        scene.aim(self.view, self.extent)
        for frame in self.frames:
            self.draw(scene, frame, self.behind)
            yield scene.picture(self.stamp(frame))

    def turn(self, scene: Scene, count: int) -> Iterator[Array]:
        """Pictures of one frame from all sides."""
        assert self.direction  # as in all cases of three dimensions
        frame = self.frames[0]
        fluid = read_particles(self.run.fluid[frame].path)
        size = self.extent.size
        for k in range(count):
            azimuth = self.direction.azimuth + 360 * k / count
            view = camera.View.of(camera.Direction(azimuth, self.direction.elevation), self.run.gravity)
            extent, behind = camera.Extent(), FluidBehind(self.run.spacing)
            extent.low, extent.high = view(self.middle) - size / 2, view(self.middle) + size / 2
            behind.add(view(fluid.positions))
            scene.aim(view, extent)
            self.draw(scene, frame, behind)
            yield scene.picture(self.stamp(frame))


def make(options: Namespace, size: tuple[int, int], given: tuple[float, float] | None) -> None:
    """Makes the film. Raises PictureError, OSError."""
    started = time.perf_counter()
    run = run_of(options.directories)
    turntable = options.turntable is not None
    path = checked(options.output or run.path / ("turntable.mp4" if turntable else "movie.mp4"))
    ffmpeg()  # before the long work
    maker = FilmMaker(run, options, size, given)
    if options.surface:
        surfaces.require_surfaces(run, maker.frames, lambda work: maker.progress(work, len(work), "making surfaces"))
    maker.look_at_frames()
    scene = Scene(size, maker.colours, run.spacing, maker.flat)
    count = max(2, round(options.seconds * options.fps)) if turntable else len(maker.frames)
    pictures = maker.turn(scene, count) if turntable else maker.pictures(scene)
    with Film(path, size, options.fps) as film:
        for picture in maker.progress(pictures, count, "drawing"):
            film.add(picture)
    scene.close()
    if not options.quiet:
        seconds, megabytes = time.perf_counter() - started, path.stat().st_size / 1e6
        what = f"{count} pictures of {size[0]}x{size[1]}, {count / options.fps:.3g} s"
        print(f"{path}: {what}, {megabytes:.3g} MB, made in {seconds:.3g} s")

"""Films of runs: `treacle movie DIR` (docs/pictures.md)."""

import argparse
import math
import sys
from collections.abc import Sequence

from ._command import command
from .pictures.errors import PictureError, require


def arguments_of(argv: Sequence[str]) -> argparse.Namespace:
    """What the command line says."""
    parser = argparse.ArgumentParser(
        prog="treacle movie", description="Make a film of the frames of a run, or of one frame from all sides"
    )
    parser.add_argument(
        "directories", nargs="+", metavar="DIR", help="run directory, and those of runs that continued it, in order"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", help=".mp4, .webm or .webp; default: DIR/movie.mp4, or turntable.mp4"
    )
    parser.add_argument(
        "--field",
        default="speed",
        metavar="NAME",
        help="what the colours show: speed (default), pressure, temperature, dynamic_viscosity, …, or none",
    )
    parser.add_argument("--range", metavar="A,B", help="of the colours; default: that of the values in all frames")
    parser.add_argument("--colormap", default="viridis", metavar="NAME", help="one of Matplotlib's; default: viridis")
    parser.add_argument(
        "--surface", action="store_true", help="the shaded surface of the fluid instead of particles (3D)"
    )
    parser.add_argument(
        "--walls",
        choices=["show", "hide", "faint"],
        default="show",
        help="default: show, but for those before the fluid",
    )
    parser.add_argument(
        "--camera",
        default="corner",
        metavar="NAME|A,E[,ZOOM]",
        help="corner (default), front, back, left, right, top, bottom, or azimuth and elevation [degrees]",
    )
    parser.add_argument("--fps", type=float, default=25, metavar="N", help="pictures per second; default: 25")
    parser.add_argument("--size", default="1280x720", metavar="WxH", help="of the pictures [px]; default: 1280x720")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="every Nth frame only")
    parser.add_argument("--from", dest="begin", type=float, metavar="T", help="first time [s]")
    parser.add_argument("--to", dest="end", type=float, metavar="T", help="last time [s]")
    parser.add_argument("--turntable", metavar="FRAME", help="one frame, its number or last, from all sides (3D)")
    parser.add_argument("--seconds", type=float, default=8, metavar="S", help="of a turn of the table; default: 8")
    parser.add_argument("-q", "--quiet", action="store_true", help="print nothing but errors")
    return parser.parse_args(argv)


def size_of(text: str) -> tuple[int, int]:
    """Width and height [px]: even numbers, since H.264 halves them for its colours."""
    words = text.lower().split("x")
    if len(words) != 2 or not all(word.isdecimal() for word in words):
        raise PictureError(f"--size: expected WIDTHxHEIGHT, found '{text}'")
    width, height = map(int, words)
    if not (160 <= width <= 7680 and 120 <= height <= 4320):
        raise PictureError(f"--size: expected 160x120 to 7680x4320, found '{text}'")
    if width % 2 or height % 2:
        raise PictureError(f"--size: expected even numbers, which films need, found '{text}'")
    return width, height


def range_of(text: str) -> tuple[float, float]:
    """Two numbers, the second one larger."""
    try:
        low, high = (float(word) for word in text.split(","))
    except ValueError:
        low = high = math.nan
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise PictureError(f"--range: expected A,B with A less than B, found '{text}'")
    return low, high


def check(options: argparse.Namespace) -> None:
    """Numbers that no run is needed for."""
    for name, value, low, high in (("fps", options.fps, 0.1, 240), ("seconds", options.seconds, 0.1, 600)):
        if not low <= value <= high:
            raise PictureError(f"--{name}: expected a number from {low:g} to {high:g}, found {value:g}")
    if options.every < 1:
        raise PictureError(f"--every: expected a whole number from 1, found {options.every}")


def make(options: argparse.Namespace) -> None:
    """Makes the film and prints what it is."""
    check(options)
    size = size_of(options.size)
    given = range_of(options.range) if options.range else None
    require("numpy", "vtk", "pyvista", "tqdm")
    from .pictures import film_maker

    film_maker.make(options, size, given)


def main(argv: Sequence[str] | None = None) -> int:
    """The command; returns its exit code."""
    return command(arguments_of, make, argv)


if __name__ == "__main__":
    sys.exit(main())

"""One page of HTML about a run: `treacle report DIR` (docs/pictures.md)."""

import argparse
import sys
from collections.abc import Sequence

from ._command import command
from .pictures.errors import PictureError, require


def arguments_of(argv: Sequence[str]) -> argparse.Namespace:
    """What the command line says."""
    parser = argparse.ArgumentParser(
        prog="treacle report",
        description="Write summary, curves and frames of a run as one page of HTML, which needs no network",
    )
    parser.add_argument(
        "directories", nargs="+", metavar="DIR", help="run directory, and those of runs that continued it, in order"
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="default: DIR/report.html")
    parser.add_argument(
        "--frames", type=int, default=20, metavar="N", help="of the view, at equal distances; default: 20"
    )
    parser.add_argument(
        "--max-points", type=int, default=20000, metavar="N", help="particles of a frame in the view; default: 20000"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="print nothing but errors")
    return parser.parse_args(argv)


def make(options: argparse.Namespace) -> None:
    """Makes the page and prints what it is."""
    for name, value, high in (("frames", options.frames, 1000), ("max-points", options.max_points, 1000000)):
        if not 1 <= value <= high:
            raise PictureError(f"--{name}: expected a whole number from 1 to {high}, found {value}")
    require("numpy", "vtk", "plotly", "tqdm")
    from .pictures import report_maker

    report_maker.make(options)


def main(argv: Sequence[str] | None = None) -> int:
    """The command; returns its exit code."""
    return command(arguments_of, make, argv)


if __name__ == "__main__":
    sys.exit(main())

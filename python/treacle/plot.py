"""Curves, for `treacle plot --history`, `treacle plot --probe` and `treacle convergence` (docs/command.md)."""

import argparse
import sys
from collections.abc import Sequence

from ._command import command
from .pictures.errors import PictureError, require


def arguments_of(argv: Sequence[str]) -> argparse.Namespace:
    """What the program says: a directory, and which of its tables becomes which picture."""
    parser = argparse.ArgumentParser(prog="treacle plot", description="Draw curves of a run, or of compared solvers")
    parser.add_argument("directory", metavar="DIR", help="run directory, or that of treacle convergence")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--history", action="store_true", help="curves of iterations, energies and extents over time")
    what.add_argument("--probe", metavar="NAME", help="what a probe of the case has read")
    what.add_argument("--convergence", action="store_true", help="residuals of compared solvers over iterations")
    parser.add_argument("--field", default="speed", metavar="NAME", help="colours of a plane; default: speed")
    parser.add_argument("--title", default="", help="of --convergence")
    parser.add_argument("--remark", default="", help="beside the title of --convergence")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="PNG file")
    return parser.parse_args(argv)


def make(options: argparse.Namespace) -> None:
    """Draws the picture and prints where it is."""
    try:
        require("numpy", "matplotlib")
    except PictureError as error:
        if not options.convergence:
            raise
        print(f"treacle: warning: {options.output} is not drawn: {error}", file=sys.stderr)  # what was compared is told
        return
    from .pictures import curve_maker

    curve_maker.make(options)


def main(argv: Sequence[str] | None = None) -> int:
    """The command; returns its exit code."""
    return command(arguments_of, make, argv)


if __name__ == "__main__":
    sys.exit(main())

"""The command `treacle`: films and reports are Python, the rest is the program that the package carries. What that
leaves to Python is run by this interpreter."""

from __future__ import annotations

import importlib
import os
import sys
from pathlib import Path

_OF_PYTHON = ("movie", "report")


def main(arguments: list[str] | None = None) -> int:
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments and arguments[0] in _OF_PYTHON:
        return importlib.import_module(f".{arguments[0]}", __package__).main(arguments[1:]) or 0
    program = Path(__file__).parent / "bin" / "treacle"
    if not program.exists():
        print(f"treacle: error: this installation does not have the program: no {program}", file=sys.stderr)
        return 3
    os.environ.setdefault("TREACLE_PYTHON", sys.executable)
    os.execv(program, ["treacle", *arguments])


if __name__ == "__main__":
    sys.exit(main())

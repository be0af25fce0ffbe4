"""Cases of the program of the authors of [K23]: `treacle import DATA PARTICLES` (docs/import.md)."""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence

from ._command import command, program, say, write_files
from .errors import InputError, RunError
from .mph_files.convert import Imported, import_files


def arguments_of(argv: Sequence[str]) -> argparse.Namespace:
    """What the command line says."""
    parser = argparse.ArgumentParser(
        prog="treacle import", description="Write a case from the files of the program of the method's authors"
    )
    parser.add_argument("parameters", metavar="DATA", help="parameters (.data)")
    parser.add_argument("geometry", metavar="PARTICLES", help="particles (.grid) or cuboids (.boid)")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="case file; default: the name of DATA with .toml, in the current directory",
    )
    parser.add_argument("--force", action="store_true", help="replace files that are there")
    return parser.parse_args(argv)


def encoded(text: str) -> bytes:
    """A text with names of files as the system has them."""
    return text.encode(errors="surrogateescape")


def stem(path: str) -> str:
    """The name of a file without its ending."""
    return os.path.splitext(os.path.basename(path))[0]


def require_writable(path: str, options: argparse.Namespace) -> None:
    """Raises InputError for a file that is imported, or that is there and may not be replaced."""
    for given in (options.parameters, options.geometry):
        with contextlib.suppress(OSError):
            if os.path.samefile(path, given):
                raise InputError(f"{path}: would replace a file that is imported; choose another one with --output")
    if os.path.isfile(path) and not options.force:
        raise InputError(f"{path}: is already there; --force replaces it")


def check(imported: Imported, options: argparse.Namespace) -> tuple[list[str], str]:
    """What the program warns of as it makes the case's particles, and their numbers. Raises InputError where the case
    cannot be run, RunError where there is not enough memory."""
    found = program()
    if not found:
        raise InputError(
            "the program treacle, which checks what is imported, is not found; expected it in PATH or in the "
            "environment variable TREACLE_PROGRAM"
        )
    with tempfile.TemporaryDirectory() as folder:
        files = imported.tables | {"case.toml": imported.text}
        write_files({os.path.join(folder, name): encoded(text) for name, text in files.items()})
        command = [found, "check", os.path.join(folder, "case.toml")]
        try:
            done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace")
        except OSError as error:
            raise InputError(f"{found}: {error.strerror}") from None
    told = done.stderr.replace(f"{folder}/", "").strip()
    if done.returncode == 0:
        fluid, wall = re.findall(r"^# particles: (\d+) fluid, (\d+) wall$", done.stdout, re.M)[0]
        return (
            told.removeprefix("treacle: warning: ").split("\ntreacle: warning: ") if told else [],
            f"{imported.case.dimensions} dimensions, {fluid} fluid and {wall} wall particles",
        )
    what = told.rpartition("treacle: error: ")[2] or f"{found} check: exit code {done.returncode}"
    if done.returncode != 2:
        raise RunError(what)
    # What is wrong with the case begins with a place in it or with a key, what is wrong with particles does not.
    if wrong := re.match(r"case\.toml(:\d+:\d+)?: |(?=[\w.]+: )", what):
        what = re.sub(r"^(\w+) in \[([\w.]+)\]: ", r"\2.\1: ", what[wrong.end() :].replace(" in the case file", "", 1))
        raise InputError(f"{options.parameters}, {options.geometry}: cannot be a case: {what}")
    raise InputError(f"{options.geometry}: {what}")


def make(options: argparse.Namespace) -> None:
    """Writes the case and prints what it is."""
    output = options.output or f"{stem(options.parameters)}.toml"
    imported = import_files(options.parameters, options.geometry, stem(output))
    warnings, numbers = check(imported, options)
    folder = os.path.dirname(output)
    contents = {os.path.join(folder, name): text for name, text in imported.tables.items()} | {output: imported.text}
    for path in contents:
        require_writable(path, options)
    write_files({path: encoded(text) for path, text in contents.items()})
    say("\n".join([*contents, numbers]))
    for warning in imported.warnings + warnings:
        print(f"treacle: warning: {warning}", file=sys.stderr)


def main(argv: Sequence[str] | None = None) -> int:
    """The command; returns its exit code."""
    return command(arguments_of, make, argv)


if __name__ == "__main__":
    sys.exit(main())

"""Surfaces of the fluid, made by the program where a run has none yet."""

import os
import shutil
import subprocess
import sys

from .errors import PictureError


def program():
    """The program treacle: what TREACLE_PROGRAM names, else the one that the shell finds. Raises PictureError."""
    found = os.environ.get("TREACLE_PROGRAM") or shutil.which("treacle")
    if not found:
        raise PictureError(
            "--surface: the run has no surfaces, and the program treacle, which makes them, is not found; expected it "
            "in PATH or in the environment variable TREACLE_PROGRAM"
        )
    return found


def require_surfaces(run, frames, quiet):
    """Makes the surfaces of frames of a RunFiles that have none. Raises PictureError with what the program says."""
    missing = [frame for frame in frames if not run.surface_file(frame).is_file()]
    if not missing:
        return
    command = [program(), "surface", str(run.path)]
    if len(missing) == 1:
        command += ["--frame", str(missing[0])]
    if not quiet:
        print(f"making surfaces of frames: {' '.join(command)}", file=sys.stderr)
    try:
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise PictureError(f"--surface: {command[0]}: {error.strerror}") from None
    if done.returncode != 0:
        raise PictureError(f"--surface: {' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()}")

"""Surfaces of the fluid, made by the program where a run has none yet."""

import os
import shutil
import subprocess

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


def require_surfaces(run, frames, progress):
    """Makes the surfaces of frames of a RunFiles that have none. progress: wraps what goes over the frames. Raises
    PictureError with what the program says."""
    missing = [frame for frame in frames if not run.surface_file(frame).is_file()]
    for frame in progress(missing) if missing else []:
        directory, number = run.origin(frame)
        command = [program(), "surface", str(directory), "--frame", str(number)]
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        except OSError as error:
            raise PictureError(f"--surface: {command[0]}: {error.strerror}") from None
        if done.returncode != 0:
            raise PictureError(f"--surface: {' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()}")

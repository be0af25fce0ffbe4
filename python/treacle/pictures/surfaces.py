"""Surfaces of the fluid, made by the program where a run has none yet."""

import subprocess
from collections.abc import Callable, Iterable, Sequence

from .._command import program
from .errors import PictureError
from .run_files import RunFiles


def require_surfaces(run: RunFiles, frames: Sequence[int], progress: Callable[[list[int]], Iterable[int]]) -> None:
    """Makes the surfaces of frames of a RunFiles that have none. progress: wraps what goes over the frames. Raises
    PictureError with what the program says."""
    missing = [frame for frame in frames if not run.surface_file(frame).is_file()]
    for frame in progress(missing) if missing else []:
        directory, number = run.origin(frame)
        found = program()
        if not found:
            raise PictureError(
                "--surface: the run has no surfaces, and the program treacle, which makes them, is not found; expected "
                "it in PATH or in the environment variable TREACLE_PROGRAM"
            )
        command = [found, "surface", str(directory), "--frame", str(number)]
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        except OSError as error:
            raise PictureError(f"--surface: {command[0]}: {error.strerror}") from None
        if done.returncode != 0:
            raise PictureError(f"--surface: {' '.join(command)}: exit code {done.returncode}: {done.stderr.strip()}")

"""Which frames a film shows, and how their times are written."""

from argparse import Namespace

import numpy as np

from .arrays import Floats
from .errors import PictureError
from .run_files import RunFiles


def chosen_frames(run: RunFiles, options: Namespace) -> list[int]:
    """Numbers of the frames of the film."""
    if options.turntable is not None:
        return [frame_number(options.turntable, len(run.fluid))]
    begin = -np.inf if options.begin is None else options.begin
    end = np.inf if options.end is None else options.end
    slack = 1e-9 * abs(run.fluid[-1].time)
    found = [k for k, frame in enumerate(run.fluid) if begin - slack <= frame.time <= end + slack]
    if not found:
        there = f"the run has {len(run.fluid)}, from {run.fluid[0].time:g} to {run.fluid[-1].time:g} s"
        raise PictureError(f"--from, --to: no frame between them; {there}")
    return found[:: options.every]


def frame_number(text: str, count: int) -> int:
    """Of a number or "last"."""
    if text == "last":
        return count - 1
    if not text.isdecimal() or int(text) >= count:
        raise PictureError(f"--turntable: expected 'last' or a number from 0 to {count - 1}, found '{text}'")
    return int(text)


def decimals(times: Floats) -> int:
    """Digits after the point that tell the times of frames apart."""
    apart = np.diff(times).min() if len(times) > 1 else max(abs(times[0]), 1e-3)
    return next((n for n in range(9) if np.all(np.abs(np.round(times, n) - times) < 0.01 * apart)), 9)

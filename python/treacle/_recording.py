"""Run directories."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable

from . import _treacle
from .errors import RunError, SimulationWarning


class Recording:
    """A run directory that grows with the steps."""

    def __init__(self, session: _treacle.Session, directory: str | os.PathLike[str], force: bool) -> None:
        self._session = session
        self._native = _treacle.Recording(session, os.fspath(directory), bool(force))
        self._step = session.step

    def record(self) -> None:
        self._step = self._session.step  # whatever comes of it
        self._native.record()
        warn(self._native.take_warnings())

    def end(self, error: BaseException | None) -> None:
        """Completes the directory. `error`: what has ended the run."""
        try:
            if error is not None and self._session.step == self._step + 1:
                self.record()  # the step was made, and then somebody has pressed Ctrl-C
        finally:
            self._finish(error)

    def _finish(self, error: BaseException | None) -> None:
        try:
            self._native.finish(_reason(error))
        except RunError as failure:
            if error is None:
                raise
            warn([f"the run directory could not be completed: {failure}"])  # what came first is what is raised
        warn(self._native.take_warnings())


def _reason(error: BaseException | None) -> str:
    if error is None:
        return ""
    return str(error) if isinstance(error, RunError) else f"stopped by {type(error).__name__}"


def warn(texts: Iterable[str]) -> None:
    for text in texts:
        warnings.warn(text, SimulationWarning, stacklevel=4)

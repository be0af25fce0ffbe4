"""What can go wrong, and what is to be warned of."""

from __future__ import annotations

__all__ = ["InputError", "RunError", "SimulationWarning"]


class InputError(ValueError):
    """What was given cannot be used. The message says where, what was expected and what was found.

    Where it is known, `file`, `line` and `column` (from 1) are the place in a case file and `key` is the last part
    of the way to the key; otherwise they are None.
    """

    file: str | None
    line: int | None
    column: int | None
    key: str | None

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        key: str | None = None,
    ) -> None:
        super().__init__(message)
        self.file, self.line, self.column, self.key = file, line, column, key


class RunError(RuntimeError):
    """A simulation that started well failed, or another thread uses it. `diagnosis` says why; the simulation keeps its
    last good state."""

    diagnosis: str

    def __init__(self, diagnosis: str) -> None:
        super().__init__(diagnosis)
        self.diagnosis = diagnosis


class SimulationWarning(UserWarning):
    """Something about a case or a step that may spoil the results."""

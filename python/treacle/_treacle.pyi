# Written by scripts/python-types from the compiled module.
"""The program's rooms, as the package treacle uses them."""

from collections.abc import Sequence
import os
from typing import Any


class CaseData:
    """A case that has been read and checked."""

    @property
    def text(self) -> str:
        """The case as TOML, every key explicit."""

def read_case(path: str | os.PathLike[str], overrides: Sequence[str]) -> CaseData: ...

def parse_case(text: str, overrides: Sequence[str]) -> CaseData: ...

class StepReport:
    """What a time step has told."""

    @property
    def step(self) -> int:
        """Number of steps done."""

    @property
    def time(self) -> float:
        """Time after the step [s]."""

    @property
    def time_step(self) -> float:
        """Length of the step [s]."""

    @property
    def error(self) -> float:
        """By which automatic steps are chosen [-]."""

    @property
    def rejected(self) -> int:
        """Longer steps that were tried before."""

    @property
    def iterations(self) -> int:
        """Of all linear solves of the step."""

    @property
    def residual(self) -> float:
        """|r|^2 / |b|^2 at the end of the last solve."""

    @property
    def fallbacks(self) -> int:
        """Ways of the linear solver that failed."""

    @property
    def failures(self) -> str:
        """Which ways those are, and why they failed."""

    @property
    def warnings(self) -> list[str]:
        """What the watch has noticed in the step."""

    @property
    def kinetic_energy(self) -> float:
        """[J; per metre of depth in 2D]"""

    @property
    def potential_energy(self) -> float:
        """[J; per metre of depth in 2D]"""

    @property
    def front_x(self) -> float:
        """Largest x of the fluid [m]."""

    @property
    def top(self) -> float:
        """Largest coordinate of the fluid against gravity [m]."""

    @property
    def max_speed(self) -> float:
        """[m/s]"""

    @property
    def seconds(self) -> float:
        """Wall-clock time of the step [s]."""

    def __repr__(self) -> str: ...

class Session:
    """A case, its simulation and what its steps have told."""

    @staticmethod
    def make(case: CaseData, backend: str, precision: str, threads: int | None, checkpoint: str) -> Session: ...

    def advance(self) -> StepReport: ...

    def change(self, case: CaseData) -> None: ...

    def steer(self, body: str, velocity: Sequence[float] | None, spin: float | None, speed: float | None, flow_rate: float | None) -> None: ...

    def take_warnings(self) -> list[str]: ...

    @property
    def step(self) -> int: ...

    @property
    def time(self) -> float: ...

    @property
    def at_end(self) -> bool: ...

    @property
    def version(self) -> int: ...

    @property
    def step_seconds(self) -> float: ...

    @property
    def on_device(self) -> bool: ...

    @property
    def device(self) -> str: ...

    @property
    def case_text(self) -> str: ...

    @property
    def dimensions(self) -> int: ...

    @property
    def title(self) -> str: ...

    @property
    def spacing(self) -> float: ...

    @property
    def end(self) -> float: ...

    @property
    def step_length(self) -> float: ...

    @property
    def steps_vary(self) -> bool: ...

    @property
    def fluid_count(self) -> int: ...

    @property
    def wall_count(self) -> int: ...

    @property
    def bytes(self) -> int: ...

    @property
    def newtonian_viscosities(self) -> list[float]: ...

    @property
    def state_names(self) -> list[str]: ...

    @property
    def material_names(self) -> list[str]: ...

    @property
    def body_names(self) -> list[str]: ...

    @property
    def probe_names(self) -> list[str]: ...

    @property
    def history(self) -> dict[str, Any]: ...

    @property
    def balance(self) -> dict[str, Any]: ...

    @property
    def rigid_bodies(self) -> dict[str, Any]: ...

    def probe(self, name: str) -> dict[str, Any]: ...

    def has_field(self, name: str) -> bool: ...

    def copied_field(self, name: str) -> Any: ...

    def field_in_place(self, name: str) -> Any: ...

    def field_address(self, name: str) -> tuple[int, tuple[int, ...], str]: ...

    def give_fluid(self, positions: object | None, velocities: object | None, temperatures: object | None, viscosity_factors: object | None, states: dict[str, object]) -> None: ...

    @property
    def viscosities(self) -> Any: ...

    @property
    def walls(self) -> dict[str, Any]: ...

    def write_frame(self, path: str | os.PathLike[str], walls: bool) -> int: ...

    def write_checkpoint(self, path: str | os.PathLike[str]) -> None: ...

class Recording:
    """The run directory of a session's steps."""

    def __init__(self, session: Session, directory: str | os.PathLike[str], force: bool) -> None: ...

    def record(self) -> None: ...

    def finish(self, failure: str) -> None: ...

    def take_warnings(self) -> list[str]: ...

def read_frame(path: str | os.PathLike[str]) -> tuple[float, int, dict[str, Any]]: ...

def case_tables() -> list[tuple[str, list[tuple[str, str, str]]]]:
    """(name, [(key, type, unit), ...]) of every table that a case can have."""

def cuda_devices() -> list[tuple[str, int, int, int, bool]]: ...

version: str

commit: str

cuda_compiled: bool

"""Simulations."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from tqdm.auto import tqdm

from . import _treacle
from ._arguments import KnownNames, argument
from ._fluid import Fluid
from ._frames import Frame, frame_of
from ._recording import Recording, warn
from ._toml import case_text, override_texts
from ._treacle import StepReport
from .cases import Case
from .errors import InputError

Backend = Literal["auto", "cpu", "cuda"]
Precision = Literal["mixed", "double"]
Overrides = Mapping[str, Any] | Iterable[str] | None

_WHOLE = {"step", "iterations", "fallbacks", "particles", "inflow_particles", "outflow_particles"}


class Simulation(KnownNames):
    """A case that is computed step by step.

    `case` is a dict as its TOML file would be, a `treacle.Case`, or the path of a case file. Files that a dict or
    dataclass names are relative to the current folder.

    - `backend`: "cpu", "cuda", or "auto", which takes the GPU where there is one.
    - `resolution` divides spacing and time step.
    - `precision`: "mixed" or "double"; the case's if it is None.
    - `overrides`: changes of single keys, `{"time.end": 1, "honey.density": 1400}`, or a list of texts as
      `treacle run --set` takes them, `["time.end=1", "honey.density=1400"]`.
    - `threads`: number of threads of the CPU, from 1, whichever thread of Python calls; by default as many as
      `treacle run` takes.

    Errors: InputError for what is wrong with the case or the arguments; RunError for a machine with too little memory.
    """

    def __init__(
        self,
        case: Case | Mapping[str, Any] | str | os.PathLike[str],
        *,
        backend: Backend = "auto",
        resolution: float | None = None,
        precision: Precision | None = None,
        overrides: Overrides = None,
        threads: int | None = None,
    ) -> None:
        self._start(case, "", backend, resolution, precision, overrides, threads)

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        backend: Backend = "auto",
        resolution: float | None = None,
        precision: Precision | None = None,
        overrides: Overrides = None,
        threads: int | None = None,
    ) -> Simulation:
        """The simulation of a case file. Arguments and errors: those of the class; the errors say file and line."""
        return cls(
            Path(path),
            backend=backend,
            resolution=resolution,
            precision=precision,
            overrides=overrides,
            threads=threads,
        )

    @classmethod
    def from_checkpoint(
        cls,
        path: str | os.PathLike[str],
        case: Case | Mapping[str, Any] | str | os.PathLike[str] | None = None,
        *,
        backend: Backend = "auto",
        resolution: float | None = None,
        precision: Precision | None = None,
        overrides: Overrides = None,
        threads: int | None = None,
    ) -> Simulation:
        """Goes on from a checkpoint, as `treacle run --resume` does.

        `case` is the case that was run; by default `case.toml` beside the checkpoint, where run directories have it.
        Errors: those of the class, and InputError for a checkpoint that cannot be used or does not fit the case.
        """
        self = cls.__new__(cls)
        if case is None:
            case = Path(path).parent / "case.toml"
            if not Path(path).exists():
                raise InputError(f"checkpoint {path}: no such file", file=os.fspath(path))
            if not case.exists():
                raise InputError(f"checkpoint {path}: expected case.toml beside it, or the case as second argument")
        self._start(case, os.fspath(path), backend, resolution, precision, overrides, threads)
        return self

    def _start(
        self,
        case: Any,
        checkpoint: str,
        backend: Backend,
        resolution: float | None,
        precision: Precision | None,
        overrides: Overrides,
        threads: int | None,
    ) -> None:
        texts = override_texts(overrides)
        if resolution is not None:
            texts += override_texts({"resolution": resolution})
        data = (
            _treacle.read_case(os.fspath(case), texts)
            if isinstance(case, (str, os.PathLike))
            else _treacle.parse_case(case_text(case), texts)
        )
        self._session = _treacle.Session.make(
            data,
            argument("backend", backend, str),
            "" if precision is None else argument("precision", precision, str),
            None if threads is None else argument("threads", threads, int),
            checkpoint,
        )
        self._fluid = Fluid(self._session)
        warn(self._session.take_warnings())

    def __repr__(self) -> str:
        return (
            f"Simulation({self.title!r}, step {self.step_count}, t = {self.time:g} s, {self._session.fluid_count} fluid "
            f"and {self._session.wall_count} wall particles, {self.backend})"
        )

    @property
    def time(self) -> float:
        """Time that is reached [s]."""
        return self._session.time

    @property
    def step_count(self) -> int:
        """Number of steps done, those before a checkpoint included."""
        return self._session.step

    @property
    def end(self) -> float:
        """Time at which the case ends [s]. Steps can be made beyond it."""
        return self._session.end

    @property
    def at_end(self) -> bool:
        """Whether the case is at its end."""
        return self._session.at_end

    @property
    def backend(self) -> str:
        """What computes: "cpu" or "cuda"."""
        return "cuda" if self._session.on_device else "cpu"

    @property
    def device(self) -> str:
        """Name of the processor or GPU that computes."""
        return self._session.device

    @property
    def dimensions(self) -> int:
        """2 or 3."""
        return self._session.dimensions

    @property
    def spacing(self) -> float:
        """Between particles [m]."""
        return self._session.spacing

    @property
    def title(self) -> str:
        """Title of the case."""
        return self._session.title

    @property
    def materials(self) -> list[str]:
        """Names of the materials, in the order that `fluid.materials` counts them in."""
        return self._session.material_names

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order that `fluid.bodies` counts them in."""
        return self._session.body_names

    @property
    def case_text(self) -> str:
        """The case as a complete TOML file: resolution and overrides applied, every key explicit."""
        return self._session.case_text

    @property
    def fluid(self) -> Fluid:
        """The particles of the fluid."""
        return self._fluid

    @property
    def walls(self) -> Frame:
        """A copy of all wall particles on the host, in the order of their ids."""
        return frame_of(self.time, self.dimensions, self._session.walls)

    def step(self) -> StepReport:
        """Makes one time step, and tells what it was.

        Other threads of Python go on meanwhile; those that use the simulation get a RunError. Errors: RunError with the
        diagnosis (no convergence, a particle outside an open domain, a bound of the watch, ...); the simulation then
        still has the state before the step.
        """
        report = self._session.advance()
        if report.warnings:
            warn([f"step {report.step}: {text}" for text in report.warnings])
        return report

    def run(
        self,
        until: float | None = None,
        *,
        callback: Callable[[Simulation], object] | None = None,
        output: str | os.PathLike[str] | None = None,
        force: bool = False,
        progress: bool = True,
    ) -> None:
        """Makes steps up to a time [s], by default the end of the case.

        Steps of one length end with the one nearest to `until`; those that vary in length end with the first one at or
        after it, and meet the end of the case exactly.
        `callback(sim)` is called after every step; where it returns False, the run ends. `output` is a run directory,
        written as `treacle run` does; one that holds a run is replaced with `force` alone. `progress` shows a bar in
        terminals and notebooks.

        Errors: those of `step()`, InputError for a directory that cannot be taken, and RunError where it cannot be
        written. Ctrl-C ends the run after the step at hand, with KeyboardInterrupt. The simulation then is as after the
        last step, and a run directory is complete up to there.
        """
        until = None if until is None else argument("until", until, float)
        recording = None if output is None else Recording(self._session, output, force)
        try:
            self._make_steps(until, callback, recording, progress)
        except BaseException as error:
            if recording is not None:
                recording.end(error)
            raise
        if recording is not None:
            recording.end(None)

    def _make_steps(
        self,
        until: float | None,
        callback: Callable[[Simulation], object] | None,
        recording: Recording | None,
        progress: bool,
    ) -> None:
        session = self._session
        start, end = session.time, session.end if until is None else until
        if math.isnan(end):
            raise InputError("until: expected a time [s], found nan")
        with tqdm(
            total=max(end - start, 0.0),
            disable=None if progress else True,
            unit="s",
            desc=session.title or "treacle",
            bar_format="{desc}: {percentage:3.0f}%|{bar}| {n:.4g}/{total:.4g} s [{elapsed}<{remaining}{postfix}]",
        ) as bar:
            while not self._is_there(until):
                self.step()
                if recording is not None:
                    recording.record()
                bar.update(max(min(session.time, end) - start - bar.n, 0.0))
                if callback is not None and _is_false(callback(self)):
                    return

    def _is_there(self, until: float | None) -> bool:
        if until is None:
            return self._session.at_end
        slack = 1e-9 * abs(until) if self._session.steps_vary else 0.5 * self._session.step_length
        return self._session.time >= until - slack

    def change(self, overrides: Overrides) -> None:
        """Goes on with other values of keys, as `{"honey.dynamic_viscosity": 5, "gravity.acceleration": [0, -1.6]}`.

        Constants of materials, gravity, and what [rheology], [heat], [solver] and [watch] say can change between steps,
        and the end of the time. It takes about as long as the start of a simulation, and for a moment the memory of
        another one. Errors: InputError for other keys, for values that cannot be, and during a run with `output`;
        nothing is changed then.
        """
        self._session.change(_treacle.parse_case(self.case_text, override_texts(overrides)))

    def steer(
        self,
        body: str,
        *,
        velocity: ArrayLike | None = None,
        angular_velocity: float | None = None,
        speed: float | None = None,
        flow_rate: float | None = None,
    ) -> None:
        """A wall or a nozzle goes on with these velocities, until it is steered again; what is None stays as it is.

        - `velocity` (D,) [m/s]: of the wall, of its centre if it rotates, or of the nozzle of an inflow.
        - `angular_velocity` [rad/s]: of a wall or nozzle that has a rotation, about its axis.
        - `speed` [m/s] or `flow_rate` [m3/s; m2/s in two dimensions]: of an inflow, whichever its case gives.

        The motion of the body in `case_text`, and in the run directory if one is written, becomes tables that keep its
        past, so that checkpoints fit and a run of that case goes the same way. The first time takes about as long as
        the start of a simulation for a body without such tables, and for a moment the memory of another one. Errors:
        InputError for a body that does not have what is steered, or moves by an oscillation or a formula.
        """
        given = {"angular_velocity": angular_velocity, "speed": speed, "flow_rate": flow_rate}
        self._session.steer(
            argument("body", body, str),
            None if velocity is None else [argument("velocity", v, float) for v in np.atleast_1d(velocity).tolist()],
            *(None if value is None else argument(name, value, float) for name, value in given.items()),
        )

    @property
    def history(self) -> dict[str, NDArray[Any]]:
        """What the steps of this object have told: the columns of `history.csv`, one entry per step."""
        return _table(self._session.history)

    @property
    def balance(self) -> dict[str, NDArray[Any]]:
        """The columns of `balance.csv`, one entry per step; empty unless `output.balance` of the case is true."""
        return _table(self._session.balance)

    @property
    def rigid_bodies(self) -> dict[str, NDArray[Any]]:
        """The columns of `rigid_bodies.csv`, one entry per step; empty in cases without rigid bodies."""
        return _table(self._session.rigid_bodies)

    @property
    def probes(self) -> list[str]:
        """Names of the probes of the case."""
        return self._session.probe_names

    def probe(self, name: str) -> dict[str, NDArray[Any]]:
        """What a probe has read so far, at its interval: the columns of its file.

        Errors: InputError for a name that is none.
        """
        return _table(self._session.probe(argument("name", name, str)))

    def write_frame(self, path: str | os.PathLike[str], *, walls: bool = False) -> None:
        """Writes the fluid, or the walls, as a .vtp file with the fields that `output` of the case says.

        Errors: RunError if the file cannot be written; no part of it is then left.
        """
        self._session.write_frame(os.fspath(path), bool(walls))

    def write_checkpoint(self, path: str | os.PathLike[str]) -> None:
        """Writes the complete state as an .h5 file, for `from_checkpoint` or `treacle run --resume`.

        Errors: RunError if the file cannot be written; an older one then stays.
        """
        self._session.write_checkpoint(os.fspath(path))


def _is_false(answer: object) -> bool:
    """Whether that is False, of Python or of a library of arrays."""
    kind = getattr(answer, "dtype", type(answer).__name__)
    return str(kind).rsplit(".")[-1] == "bool" and not answer


def _table(columns: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    return {name: values.astype(np.int64) if name in _WHOLE else values for name, values in columns.items()}

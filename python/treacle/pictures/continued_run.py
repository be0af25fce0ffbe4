"""A run and the runs that have continued it (`treacle run --resume`), as one."""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from .arrays import Table
from .errors import PictureError
from .run_files import FrameFile, RunFiles

rounding = 1e-9  # of times


def run_of(directories: Sequence[str]) -> RunFiles:
    """The run of one directory or of several, in the order of time. Raises PictureError."""
    return RunFiles(directories[0]) if len(directories) == 1 else ContinuedRun(directories)


class ContinuedRun(RunFiles):
    """Several run directories, each but the first begun from a checkpoint of the one before. What that one has of later
    times than the checkpoint's is left out. Case and output are those of the last."""

    def __init__(self, directories: Sequence[str]) -> None:
        super().__init__(directories[-1])
        self.parts = [RunFiles(directory) for directory in directories]
        self.begins = [part.fluid[0].time for part in self.parts]
        for k in range(1, len(self.parts)):
            self._check(self.parts[k - 1], self.parts[k], self.begins[k - 1 : k + 1])

    def _check(self, before: RunFiles, after: RunFiles, begins: Sequence[float]) -> None:
        """Whether one continues the other."""
        end = max([before.fluid[-1].time, *before.history.get("time", [])[-1:]])
        expected = f"expected a run that continues {before.path}, by --resume"
        if not begins[0] < begins[1]:
            raise PictureError(
                f"{after.path}: begins at {begins[1]:g} s, not after {before.path}, at {begins[0]:g} s; {expected}"
            )
        if begins[1] > end * (1 + rounding):
            raise PictureError(f"{after.path}: begins at {begins[1]:g} s, {before.path} ends at {end:g} s; {expected}")
        if (before.dimensions, before.spacing) != (after.dimensions, after.spacing):
            raise PictureError(f"{after.path}: has other dimensions or another spacing; {expected}")

    @property
    def places(self) -> str:
        return " → ".join(str(part.path) for part in self.parts)

    @property
    def _kept(self) -> list[tuple[RunFiles, float]]:
        """Parts, each with the time from which the next one has its frames [s]."""
        return list(zip(self.parts, [*self.begins[1:], np.inf], strict=True))

    @cached_property
    def fluid(self) -> list[FrameFile]:
        return [frame for part, until in self._kept for frame in part.fluid if earlier(frame.time, until)]

    @cached_property
    def walls(self) -> list[FrameFile]:
        found = []
        for part, until in self._kept:
            count = sum(earlier(frame.time, until) for frame in part.fluid)
            found += [part.walls[min(k, len(part.walls) - 1)] for k in range(count) if part.walls]
        return found

    def _joined(self, table_of: Callable[[RunFiles], Table]) -> Table:
        """A table of all parts that have it, with the columns that all of these have."""
        tables = [(table_of(part), until) for part, until in self._kept]
        return joined([(table, until) for table, until in tables if len(table.get("time", []))])

    @cached_property
    def history(self) -> Table:
        return self._joined(lambda part: part.history)

    @cached_property
    def balance(self) -> Table:
        return self._joined(lambda part: part.balance)

    @cached_property
    def rigid_bodies(self) -> Table:
        return self._joined(lambda part: part.rigid_bodies)

    @cached_property
    def probes(self) -> dict[str, Table]:
        names = sorted({name for part in self.parts for name in part.probes})

        def of(name: str) -> Table:
            return self._joined(lambda part: part.probes.get(name, {}))

        return {name: of(name) for name in names}

    @cached_property
    def log(self) -> list[str]:
        return [line for part in self.parts for line in part.log]

    @cached_property
    def summary(self) -> dict[str, Any] | None:
        """That of the last part, but with what adds up over all steps; where a part was killed and has no summary,
        without what only summaries know."""
        last = self.parts[-1].summary
        if last is None:
            return None
        there = [part.summary for part in self.parts if part.summary]
        found = last | of_steps(self.history) | {"fluid_particles": there[0]["fluid_particles"]}
        for key in ("peak_memory_bytes", "peak_device_memory_bytes"):
            found[key] = max(summary[key] for summary in there)
        sums = {key: sum(summary[key] for summary in there) for key in ("wall_seconds", "rejected_steps")}
        sums["seconds_per_phase"] = {
            phase: sum(summary["seconds_per_phase"].get(phase, 0) for summary in there)
            for phase in last["seconds_per_phase"]
        }
        sums["frames"] = {"count": len(self.fluid), "bytes": sum(summary["frames"]["bytes"] for summary in there)}
        complete = len(there) == len(self.parts)
        return {key: value for key, value in (found | sums).items() if complete or key not in sums}


def earlier(times: Any, until: float) -> Any:
    """Which times are before another one, but for rounding."""
    return times < until * (1 - rounding)


def joined(tables: Sequence[tuple[Table, float]]) -> Table:
    """One table of several, with the columns that all of them have. tables: (table, until), where rows after `until` are
    left out, and those from the first time of the next table on."""
    found: Table = {}
    for k, (table, until) in enumerate(tables):
        following = tables[k + 1][0]["time"][0] if k + 1 < len(tables) else np.inf
        rows = (table["time"] <= until * (1 + rounding)) & earlier(table["time"], following)
        part = {name: values[rows] for name, values in table.items()}
        found = {name: np.append(found[name], part[name]) for name in found if name in part} if k else part
    return found


def of_steps(history: Table) -> dict[str, Any]:
    """What a summary has of all steps; nothing without any."""
    if not len(history.get("time", [])):
        return {}
    steps, iterations = history["time_step"], history["iterations"]
    return {
        "time_step": {"least": steps.min(), "mean": steps.mean(), "longest": steps.max()},
        "iterations": {"mean": iterations.mean(), "first": int(iterations[0]), "last": int(iterations[-1])},
        "fallbacks": int(history["fallbacks"].sum()),
    }

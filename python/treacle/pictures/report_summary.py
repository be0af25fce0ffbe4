"""The table of a report, and what the log warns of."""

import re
from collections.abc import Callable, Mapping
from typing import Any

from .run_files import RunFiles


def number(value: float, digits: int = 4) -> str:
    """With few digits and groups of thousands."""
    if isinstance(value, int) or (isinstance(value, float) and value.is_integer() and abs(value) < 1e12):
        return f"{int(value):,}"
    return f"{value:.{digits}g}"


def duration(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.3g} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def status(run: RunFiles) -> tuple[str, str]:
    """A word and what it means: done, failed or not ended."""
    if run.summary is None:
        return "not ended", "The run goes on, or was killed: there is no summary yet."
    return run.summary["status"], run.summary.get("message", "")


def rows(run: RunFiles) -> list[tuple[str, str]]:
    """Pairs of names and values of the table, from the summary; of a run that has not ended from case and history."""
    case, summary = run.case, run.summary or {}
    method = case["method"]["name"].upper() + (
        f", {case['method']['scheme']} scheme" if "scheme" in case["method"] else ""
    )
    found = [("Method", f"{method}, {run.dimensions}D"), ("Spacing", f"{run.spacing * 1e3:.4g} mm")]

    def add(name: str, key: str, form: Callable[[Any], str] = number) -> None:
        value: Any = summary
        for part in key.split("."):
            value = value.get(part) if isinstance(value, dict) else None
        if value is not None:
            found.append((name, form(value)))

    add("Fluid particles", "fluid_particles")
    if len(run.history.get("particles", [])):
        found.append(("Fluid particles at the end", number(int(run.history["particles"][-1]))))
    add("Wall particles", "wall_particles")
    if run.summary is None:
        found += _of_history(run)
    add("Steps", "steps")
    add("Simulated time", "time", lambda t: f"{t:.6g} s")
    add(
        "Time step",
        "time_step",
        lambda s: (
            f"{s['mean']:.3g} s"
            if s["least"] == s["longest"]
            else f"{s['least']:.3g} to {s['longest']:.3g} s, mean {s['mean']:.3g} s"
        ),
    )
    if summary.get("rejected_steps"):
        add("Rejected steps", "rejected_steps")
    add("Iterations", "iterations", lambda i: f"mean {i['mean']:.3g}, first {i['first']}, last {i['last']}")
    add("Fallbacks of the solver", "fallbacks")
    add("Density inside", "density.inside")
    add(
        "Nearest distance at the end",
        "nearest_distance",
        lambda d: f"{d['least']:.3g} spacings, 1 % below {d['low']:.3g}" if d["least"] is not None else "unknown",
    )
    add("Machine", "device", str)
    add(
        "Backend",
        "backend",
        lambda backend: ", ".join([backend, f"{summary['precision']} precision", *_many(summary, "thread", "process")]),
    )
    add("Wall-clock time", "wall_seconds", duration)
    add("Memory", "peak_memory_bytes", lambda b: f"{b / 1e6:,.0f} MB")
    if summary.get("peak_device_memory_bytes"):
        add("Memory of the GPU", "peak_device_memory_bytes", lambda b: f"{b / 1e6:,.0f} MB")
    add("Frames", "frames", lambda f: f"{f['count']:,}, {f['bytes'] / 1e6:.3g} MB")
    return found


def _many(summary: Mapping[str, Any], *words: str) -> list[str]:
    """How many threads and processes; one process is not worth a word."""
    counts = [summary.get("threads", 1), summary.get("processes", 1)]
    found = [f"{counts[0]} {words[0]}{'s' if counts[0] > 1 else ''}"]
    return found + ([f"{counts[1]} {words[1]}es"] if counts[1] > 1 else [])


def _of_history(run: RunFiles) -> list[tuple[str, str]]:
    history = run.history
    if not len(history.get("time", [])):
        return []
    return [
        ("Steps up to now", number(int(history["step"][-1]))),
        ("Simulated time up to now", f"{history['time'][-1]:.6g} s"),
    ]


def begun(run: RunFiles) -> str:
    """Version, backend and machine as the log begins with, and when."""
    first = re.match(r"(\S+ \S+?)(?:\.\d+)? info: (.*)", run.log[0]) if run.log else None
    return f"{first[2]}; begun {first[1]}" if first else ""


def phases(run: RunFiles) -> list[tuple[str, float]]:
    """Seconds by phase of a step, the longest first."""
    seconds = (run.summary or {}).get("seconds_per_phase", {})
    return sorted(((name, value) for name, value in seconds.items() if value > 0), key=lambda pair: -pair[1])

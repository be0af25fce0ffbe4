#!/usr/bin/env python3
"""benchmarks/steps.py --program FILE [--backend cpu|cuda] [--threads N,...] [--scheme accurate,published] [--repeat N]
                    [--case NAME:RESOLUTION[:END],...] OUT.json

Times whole runs of the dam breaks, without frames but the first and last. The repeated runs take turns, and the one
with the fastest steps is written: milliseconds of each phase per step, microseconds per fluid particle and step of all
phases but the waiting for output, iterations and memory."""

import argparse
import itertools
import json
import subprocess
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parent.parent
defaults = "dam-break-2d:1,dam-break-2d:2,dam-break-2d:4,dam-break-3d:0.5,dam-break-3d:1"
copied = ["backend", "threads", "fluid_particles", "wall_particles", "time", "steps", "fallbacks", "iterations",
          "wall_seconds", "peak_device_memory_bytes", "peak_memory_bytes"]


def run(options, spec, scheme, threads, directory):
    """The summary of one run; spec: NAME:RESOLUTION[:END]."""
    case, resolution, *end = spec.split(":")
    out = Path(directory) / "run"
    command = [options.program, "run", str(root / "cases" / f"{case}.toml"), "-o", str(out), "--force", "--quiet",
               "--backend", options.backend, "--threads", threads, "--set", f"resolution={resolution}",
               "--set", f"method.scheme={scheme}", "--set", "output.interval=1"]
    subprocess.run(command + (["--end-time", end[0]] if end else []), check=True)
    return json.loads((out / "summary.json").read_text())


def seconds(summary):
    """Of all steps."""
    return sum(s for phase, s in summary["seconds_per_phase"].items() if phase != "output")


def record(summary, spec, scheme):
    case, resolution, *_ = spec.split(":")
    phases = {phase: 1e3 * s / summary["steps"] for phase, s in summary["seconds_per_phase"].items()}
    return {"case": case, "resolution": float(resolution), "scheme": scheme,
            **{k: summary[k] for k in copied if k in summary},
            "milliseconds_per_step": phases,
            "microseconds_per_particle_and_step": 1e6 * seconds(summary) / summary["steps"] / summary["fluid_particles"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--backend", choices=["cpu", "cuda"], default="cpu")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--scheme", default="accurate")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--case", default=defaults)
    parser.add_argument("out")
    options = parser.parse_args()
    kinds = list(itertools.product(options.scheme.split(","), options.threads.split(",")))
    runs, build = [], {}
    with tempfile.TemporaryDirectory() as directory:
        for spec in options.case.split(","):
            best: dict[tuple[str, str], dict] = {}
            for scheme, threads in kinds * options.repeat:
                kind, summary = (scheme, threads), run(options, spec, scheme, threads, directory)
                build = {k: summary[k] for k in ("commit", "device", "precision")}
                if kind not in best or seconds(summary) < seconds(best[kind]):
                    best[kind] = summary
            runs += [record(best[kind], spec, kind[0]) for kind in kinds]
    what = "whole runs of the dam breaks, means per step; accurate is the default scheme"
    Path(options.out).write_text(json.dumps({**build, "what": what, "runs": runs}, indent=1) + "\n")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""benchmarks/cpu_steps.py --program FILE --device TEXT [--threads N,...] [--repeat N] [--case NAME:RESOLUTION[:END],...] OUT.json

Runs of the dam breaks by the default scheme on so many threads of the CPU, without frames but the first and last; of the repeated
runs, in turn, the one with the fastest steps. Written: seconds of each phase, summed over the steps, and microseconds per fluid
particle and step of all phases but the waiting for output."""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parent.parent
defaults = "dam-break-2d:1,dam-break-2d:2,dam-break-2d:4,dam-break-3d:0.5,dam-break-3d:1"


def run(program, case, resolution, end, threads, directory):
    """The summary of one run."""
    out = Path(directory) / "run"
    command = [program, "run", str(root / "cases" / f"{case}.toml"), "-o", str(out), "--force", "--quiet", "--threads", str(threads),
               "--set", f"resolution={resolution}", "--set", "output.interval=1"]
    subprocess.run(command + (["--end-time", end] if end else []), check=True)
    return json.loads((out / "summary.json").read_text())


def seconds(summary):
    """Of all steps."""
    return sum(s for phase, s in summary["seconds_per_phase"].items() if phase != "output")


def record(summary, case, resolution):
    per_step = seconds(summary) / summary["steps"] / summary["fluid_particles"]
    kept = ["threads", "fluid_particles", "wall_particles", "time", "steps", "iterations", "fallbacks", "seconds_per_phase", "wall_seconds"]
    return {"case": case, "resolution": float(resolution), **{k: summary[k] for k in kept}, "microseconds_per_particle_and_step": 1e6 * per_step}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--device", required=True)
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--case", default=defaults)
    parser.add_argument("out")
    options = parser.parse_args()
    runs, commit = [], None
    with tempfile.TemporaryDirectory() as directory:
        for case, resolution, *end in (c.split(":") for c in options.case.split(",")):
            best = {}
            for _ in range(options.repeat):
                for threads in options.threads.split(","):
                    summary = run(options.program, case, resolution, end[0] if end else None, threads, directory)
                    commit = summary["commit"]
                    if threads not in best or seconds(summary) < seconds(best[threads]):
                        best[threads] = summary
            runs += [record(summary, case, resolution) for summary in best.values()]
    what = "runs of the dam breaks by the default scheme; seconds per phase are sums over all steps"
    Path(options.out).write_text(json.dumps({"commit": commit, "device": options.device, "what": what, "runs": runs}, indent=1) + "\n")


if __name__ == "__main__":
    main()

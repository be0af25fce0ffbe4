#!/usr/bin/env python3
"""benchmarks/cluster_steps.py --program FILE [--launch "mpirun -n {n} ..."] [--timeout S] [--set KEY=VALUE ...]
    [--run CASE:RESOLUTION:WIDTH:END:PROCESSES[:LINK] ...] OUT.json

The first steps of runs by one process and by several, without frames but the first and last. CASE: thin-dam-break-3d (beside this
file) or a case with [width]; WIDTH: its width.factor; LINK: peer, nccl or mpi, what processes on GPUs talk by at best
(TREACLE_LINK). --set goes to all runs. Written for each run: milliseconds per step of each phase, at the process that conducts,
without the first step, in which particles go to their owners; iterations, memory, and what each process had to do."""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

here = Path(__file__).resolve().parent
# Weak and strong scaling on two devices.
defaults = ["thin-dam-break-3d:4:1:0.005:1", "thin-dam-break-3d:4:2:0.005:2", "thin-dam-break-3d:4:2:0.005:2:nccl",
            "thin-dam-break-3d:4:1:0.005:2", "thin-dam-break-3d:10:1:0.0004:1", "thin-dam-break-3d:10:2:0.0004:2",
            "thin-dam-break-3d:10:1:0.0004:2"]


def case_file(name):
    return next(p for p in (here / f"{name}.toml", here.parent / "cases" / f"{name}.toml") if p.exists())


def run(options, spec, directory):
    """The record of one run, and its summary; None where it failed."""
    case, resolution, width, end, processes, *link = spec.split(":")
    out = Path(directory) / "run"
    launch = options.launch.format(n=processes).split() if int(processes) > 1 else []
    command = launch + [options.program, "run", str(case_file(case)), "-o", str(out), "--force", "--quiet", "--end-time", end,
                        "--timings", "--set", f"resolution={resolution}", "--set", f"width.factor={width}", "--set",
                        "output.interval=0"]
    for setting in options.set:
        command += ["--set", setting]
    environment = dict(os.environ, **({"TREACLE_LINK": link[0]} if link and link[0] != "peer" else {}))
    try:
        subprocess.run(command, check=True, timeout=options.timeout, env=environment)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
        print(f"{spec}: {error}", file=sys.stderr)
        return None
    summary = json.loads((out / "summary.json").read_text())
    with open(out / "history.csv", newline="") as table:
        first, *rows = csv.DictReader(table)
    if not rows:
        print(f"{spec}: a single step, the first; expected a later end", file=sys.stderr)
        return None
    phases = {key.removesuffix("_s"): 1e3 * sum(float(row[key]) for row in rows) / len(rows) for key in first if key.endswith("_s")}
    of_all = [1e3 * float(row["seconds"]) for row in (first, *rows)]
    kept = ["processes", "fluid_particles", "wall_particles", "steps", "time", "iterations", "fallbacks", "wall_seconds"]
    return {"case": case, "resolution": float(resolution), "width": float(width), "link": (link or ["peer"])[0] if launch else None,
            "settings": options.set,
            **{k: summary[k] for k in kept}, "milliseconds_per_step": phases, "milliseconds_per_step_of_all": sum(of_all[1:]) / len(rows),
            "milliseconds_of_first_step": of_all[0],
            "peak_device_memory_bytes": summary.get("peak_device_memory_bytes"), "shares": summary.get("shares")}, summary


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--launch", default="mpirun -n {n}")
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--run", nargs="*", default=defaults)
    parser.add_argument("out")
    options = parser.parse_args()
    runs: list[dict] = []
    record = {"what": "the first steps of runs by one process and by several; milliseconds per step without output", "runs": runs}
    with tempfile.TemporaryDirectory() as directory:
        for spec in options.run:
            if not (done := run(options, spec, directory)):
                continue
            ran, summary = done
            record |= {"commit": summary["commit"], "device": summary["device"], "precision": summary["precision"]}
            runs.append(ran)
            print(f"{spec}: {ran['milliseconds_per_step_of_all']:.2f} ms a step, {ran['iterations']['mean']:.2f} iterations", flush=True)
            Path(options.out).write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()

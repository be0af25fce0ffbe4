#!/usr/bin/env python3
"""What Python adds to a time step: python_overhead.py OUTPUT.json [--backend cuda|cpu] [--steps N].

Runs the dam break of 6,400 particles from Python, once by Simulation.run() and once step by step with the velocities looked
at after each, and takes the time that the steps themselves took, as the module measures it around them, from the whole.
Needs the package treacle; with PyTorch the velocities are looked at by DLPack, without a copy."""

import argparse
import json
import platform
import time
from pathlib import Path

import numpy as np
import treacle

CASE = Path(__file__).parents[1] / "cases/published/dam-break-2d.toml"
WARM_UP = 20  # steps


def ran(sim, steps):
    sim.run(until=sim.time + steps * step_length(sim), progress=False)


try:
    from torch import from_dlpack
except ImportError:
    from_dlpack = np.asarray


def looked_at(sim, steps):
    view = np.asarray if sim.backend == "cpu" else from_dlpack
    for _ in range(steps):
        sim.step()
        view(sim.fluid.velocities)


def step_length(sim):
    return sim.history["time_step"][-1] if sim.step_count > 0 else 1e-3


def measure(backend, steps, way):
    sim = treacle.Simulation.from_file(CASE, backend=backend, resolution=4)
    way(sim, WARM_UP)
    before, start = sim._session.step_seconds, time.perf_counter()
    first = sim.step_count
    way(sim, steps)
    whole = time.perf_counter() - start
    inside = sim._session.step_seconds - before
    made = sim.step_count - first
    return sim, {
        "steps": made,
        "step_ms": 1e3 * inside / made,
        "python_ms": 1e3 * (whole - inside) / made,
        "share": (whole - inside) / inside,
    }


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("output", type=Path)
    arguments.add_argument("--backend", default="auto")
    arguments.add_argument("--steps", type=int, default=200)
    options = arguments.parse_args()
    record = {}
    for name, way in (("run", ran), ("step_and_view", looked_at)):
        sim, record[name] = measure(options.backend, options.steps, way)
        r = record[name]
        print(f"{name}: step {r['step_ms']:.3f} ms, Python {r['python_ms']:.4f} ms, {100 * r['share']:.2f} %")
    record = {
        "version": treacle.__version__,
        "commit": treacle._treacle.commit,
        "device": sim.device,
        "backend": sim.backend,
        "python": platform.python_version(),
        "fluid_particles": len(sim.fluid),
        **record,
    }
    options.output.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()

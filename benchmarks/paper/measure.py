"""Measures with treacle, once: every measurement is a JSON file, and what is there is not made again."""

import json
import math
import os
import shutil
import sys
import time
import tomllib

import numpy as np
import treacle_data
from cases import isph_solvers, solvers, trial_steps
from outputs import bucket_levels, parameters, read_quoted
from spec import Spec


class Laboratory:
    def __init__(self, program, backend, out, runs, cases, threads=0, largest=None, isph_end=math.inf, quick=False):
        """largest: the most fluid particles of a case that is measured, by its series; others are left out. isph_end: latest
        time of a system of ISPH [s]. quick: marks the measurements."""
        self.program, self.backend, self.threads = program, backend, threads
        self.out, self.runs, self.cases = out, runs, cases
        self.largest, self.isph_end, self.quick = largest or {}, isph_end, quick
        self.failed = set()

    def path(self, spec):
        return self.out / "measurements" / f"{spec.key}.json"

    def has(self, spec):
        """Whether it was measured; what a quick trial measured does not count but for another one."""
        path = self.path(spec)
        before = json.loads(path.read_text()) if path.exists() else {"failed": "not made"}
        return "failed" not in before and (self.quick or not before.get("quick"))

    def states_for(self, specs):
        """The states that these measurements begin from and that are not on this machine."""
        cases = dict.fromkeys(spec.case for spec in specs if spec.kind in ("trial", "picture"))
        states = [Spec("state", case) for case in cases if not (self.state_directory(case) / "checkpoint.h5").exists()]
        return [state for state in states if self.reason_against(state) is None]

    def measure(self, spec):
        """Returns whether the measurement is there, or never will be on this machine; False after a failure."""
        if self.has(spec) and (spec.kind != "state" or (self.state_directory(spec.case) / "checkpoint.h5").exists()):
            return True
        if reason := self.reason_against(spec):
            print(f"  {spec.key}: left out, {reason}", flush=True)
            return True
        path = self.path(spec)
        begin = time.perf_counter()
        try:
            if spec.kind in ("trial", "picture"):
                self.need_state(spec.case)
                begin = time.perf_counter()
            result = getattr(self, spec.kind)(spec)
        except Exception as failure:  # whatever it is, the other measurements go on
            result = {"failed": f"{type(failure).__name__}: {failure}"}
            self.failed.add(spec)
            print(f"reproduce: {spec.key}: {failure}", file=sys.stderr, flush=True)
        result |= {"quick": True} if self.quick else {}
        result["wall_seconds"] = round(time.perf_counter() - begin, 2)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(treacle_data.json_text(result))
        print(f"  {spec.key}: {result['wall_seconds']:.1f} s", flush=True)
        return "failed" not in result

    def reason_against(self, spec):
        """Why it is not wanted or not possible here; None if it is."""
        if spec.kind != "check" and spec.case.particles > self.largest.get(spec.case.series, math.inf):
            return f"{spec.case.particles} particles are more than wanted"
        if spec.threads > (os.cpu_count() or 1):
            return f"the machine has {os.cpu_count()} processors"
        return None

    def options(self, spec):
        backend = self.backend if spec.backend == "device" else spec.backend
        threads = spec.threads or self.threads
        words = ["--backend", backend] + (["--threads", str(threads)] if threads else [])
        return words + (["--precision", spec.precision] if spec.precision else [])

    def describe(self, spec, run):
        """What every measurement of a run says."""
        keys = (
            "version",
            "commit",
            "backend",
            "device",
            "threads",
            "precision",
            "steps",
            "time",
            "fluid_particles",
            "fallbacks",
        )
        return {"case": spec.case.name, **{k: run.summary[k] for k in keys}}

    def check(self, spec):
        words = [w for setting in spec.case.settings for w in ("--set", setting)]
        return parameters(treacle_data.call([self.program, "check", self.cases / spec.case.file, *words]))

    def run_to_end(self, spec, directory):
        settings = [*spec.case.settings, "output.interval=0"]
        options = ["--timings", "--end-time", repr(spec.case.end), *self.options(spec)]
        run = treacle_data.run_case(self.program, self.cases / spec.case.file, directory, settings, options)
        h = run.history
        return run, self.describe(spec, run) | {
            "iterations": {**run.summary["iterations"], "largest": int(h["iterations"].max())},
            "step_seconds": float(h["seconds"].mean()),
            **{k: float(h[k][-1]) for k in ("front_x", "top", "kinetic_energy", "potential_energy")},
        }

    def state_directory(self, case):
        return self.runs / f"state-{case.name}"

    def state(self, spec):
        directory = self.state_directory(spec.case)
        self.path(spec).unlink(missing_ok=True)  # a run that is stopped leaves a checkpoint, too
        run, result = self.run_to_end(spec, directory)
        case = tomllib.loads((directory / "case.toml").read_text())
        spacing, domain = case["spacing"] / case.get("resolution", 1), case["domain"]
        edge = spacing * max(case["method"]["viscosity_radius"], 2 * case["method"]["pressure_radius"])
        low, high = np.array(domain["min"]), np.array(domain["max"])
        return result | {"highest_level": bucket_levels(run.frame().position, low, high - low, edge)}

    def run(self, spec):
        directory = self.runs / spec.key
        _, result = self.run_to_end(spec, directory)
        shutil.rmtree(directory)
        return result

    def need_state(self, case):
        """Makes the state that a measurement begins from, if it is not there: also where only its measurement was carried."""
        spec = Spec("state", case)
        if spec in self.failed or not self.measure(spec):
            raise treacle_data.RunFailed(f"there is no state of {case.name}")

    def trial(self, spec):
        checkpoint = self.state_directory(spec.case) / "checkpoint.h5"
        directory = self.runs / spec.key
        steps = trial_steps(spec.case)
        end = spec.case.end + steps * spec.case.step
        settings = [*spec.case.settings, "output.interval=0", "output.fields=[]"]
        settings += [f"solver.{key}" for key in solvers[spec.solver]]
        options = ["--resume", checkpoint, "--end-time", repr(end), "--timings", *self.options(spec)]
        run = treacle_data.run_case(self.program, self.cases / spec.case.file, directory, settings, options)
        h, described = run.history, self.describe(spec, run)
        shutil.rmtree(directory)
        phases = ("search", "lists", "coefficients", "coarse", "solve", "update")
        timed = 1 + np.argsort(h["seconds"][1:])[(len(h["seconds"]) - 2) // 2]
        return described | {
            "solver": spec.solver,
            "time": spec.case.end,
            "steps": len(h["step"]),
            "iterations": int(h["iterations"][0]),
            "iterations_mean": float(h["iterations"].mean()),
            "timed_iterations": int(h["iterations"][timed]),
            "step_seconds": float(h["seconds"][timed]),
            "phases": {p: float(h[p + "_s"][timed]) for p in phases},
        }

    def convergence(self, spec):
        directory = self.runs / spec.key
        at = min(spec.case.end, self.isph_end)
        words = [w for setting in spec.case.settings for w in ("--set", setting)]
        words += [w for keys in isph_solvers.values() for w in ("--solver", keys)]
        call = [self.program, "convergence", self.cases / spec.case.file, "--at", repr(at), "-o", directory]
        treacle_data.call(call + words + self.options(spec))
        rows, histories = read_quoted(directory / "solvers.csv"), read_quoted(directory / "convergence.csv")
        found = {}
        for label, row in zip(isph_solvers, rows, strict=True):
            residuals = [float(f"{float(h['relative_residual']):.4g}") for h in histories if h["solver"] == row["solver"]]
            found[label] = {
                "name": row["solver"],
                "outcome": row["outcome"],
                "iterations": int(row["iterations"]),
                "setup_s": float(row["setup_s"]),
                "solve_s": float(row["solve_s"]),
                "residuals": residuals,
            }
        shutil.rmtree(directory)
        return {"case": spec.case.name, "time": at, "full_time": spec.case.end, "solvers": found, **self.machine()}

    def machine(self):
        """For commands that leave no summary: what a run of one step of the smallest case says."""
        if not hasattr(self, "_machine"):
            directory = self.runs / "machine"
            options = ["--end-time", "1e-3", "--backend", self.backend]
            run = treacle_data.run_case(self.program, self.cases / "dam-break-2d.toml", directory, (), options)
            self._machine = {k: run.summary[k] for k in ("version", "commit", "backend", "device", "threads")}
            shutil.rmtree(directory)
        return self._machine

    def picture(self, spec):
        self.out.mkdir(parents=True, exist_ok=True)
        treacle_data.call([self.program, "plot", self.state_directory(spec.case), "-o", self.out / "k23-fig12.png"])
        return {"case": spec.case.name, "time": spec.case.end, "picture": "k23-fig12.png"}

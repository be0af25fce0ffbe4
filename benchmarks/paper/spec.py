"""What can be measured, and what was."""

import json
from dataclasses import dataclass

from cases import Case


@dataclass(frozen=True)
class Spec:
    """One measurement. kind: "check" (the numbers of the case), "state" (a run to the case's end that leaves a checkpoint),
    "trial" (steps from that checkpoint with one solver), "run" (a run of its own), "convergence" (solvers on one system),
    "picture". backend: "device" is the one of the command line. threads: 0 for all."""

    kind: str
    case: Case
    solver: str = "ours"
    backend: str = "device"
    threads: int = 0
    precision: str = ""

    @property
    def key(self):
        words = [self.kind, self.case.name]
        if self.kind == "trial":
            words.append(self.solver.replace(" ", "-"))
        if self.kind in ("trial", "run"):
            words += [self.backend, str(self.threads or "all")] if self.backend == "cpu" else [self.backend]
        return "_".join(words + ([self.precision] if self.precision else []))


class Results:
    """Measurements by key. What is missing, failed or was left out is None everywhere."""

    def __init__(self, measurements):
        self.all = measurements

    @classmethod
    def load(cls, folders):
        """Those of several output folders; of the same one, the last that did not fail."""
        found = {}
        for folder in folders:
            for path in sorted((folder / "measurements").glob("*.json")):
                result = json.loads(path.read_text())
                if "failed" not in result or path.stem not in found:
                    found[path.stem] = result
        return cls(found)

    def get(self, spec):
        result = self.all.get(spec.key)
        return None if result is None or "failed" in result else result

    def trial(self, case, solver, backend="device", threads=0):
        return self.get(Spec("trial", case, solver, backend, threads))

    def iterations(self, case, solver):
        """Of the system at the end of the state; of our solver, which takes its modes along, the mean over the steps."""
        trial = self.trial(case, solver)
        return trial and trial["iterations_mean" if solver == "ours" else "iterations"]

    def unit_time(self, case, solver, backend="device", threads=0):
        """Time of a step per fluid particle [us]."""
        trial = self.trial(case, solver, backend, threads)
        return trial and 1e6 * trial["step_seconds"] / trial["fluid_particles"]

    def breakdown(self, case, backend="device", threads=0):
        """Unit times [us] of the parts of a step with MGCR and CR, or None. MGCR's main iterations are taken to cost what CR's
        cost on the same system; the rest of its iterations is preconditioning."""
        mg, cr = (self.trial(case, solver, backend, threads) for solver in ("MGCR", "CR"))
        if not (mg and cr):
            return None
        unit = 1e6 / mg["fluid_particles"]
        main = cr["phases"]["solve"] / cr["timed_iterations"] * mg["timed_iterations"]
        return {
            "MGCR total": unit * mg["step_seconds"],
            "MGCR main": unit * main,
            "MGCR preconditioning": unit * (mg["phases"]["solve"] - main),
            "MGCR set-up": unit * mg["phases"]["coarse"],
            "CR total": unit * cr["step_seconds"],
            "CR solver": unit * cr["phases"]["solve"],
        }

    def isph(self, case, solver):
        """Of a comparison, the solver's; None unless it converged."""
        comparison = self.get(Spec("convergence", case))
        found = comparison and comparison["solvers"].get(solver)
        return found if found and found["outcome"] == "converged" else None

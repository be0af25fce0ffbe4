"""All items, the portions they are measured in, and how long each measurement should take on an H200 with 16 processors."""

import re

import iterations
import other_items
import tables
import times
from cases import isph_solvers, trial_steps


def place(item):
    """In the order of the papers: tables, figures, ours."""
    if not (words := re.fullmatch(r"(k23|o23|backends)-?([a-z]*)(\d*)", item.name)):
        raise ValueError(f"{item.name}: expected a table or figure of k23 or o23, or backends")
    paper, kind, number = words.groups()
    return ("k23", "o23", "backends").index(paper), kind != "table", int(number or 0)


found = [item for module in (tables, iterations, times, other_items) for item in module.items]
items = {item.name: item for item in sorted(found, key=place)}

portions = {
    1: "2D x1 … x1/16, small cases, parameters",
    2: "2D x1/32",
    3: "2D x1/64 (shortened), 3D, ISPH",
    4: "CPU times, comparison of backends",
}


def portion_of(spec):
    if spec.kind == "run" or spec.backend == "cpu":
        return 4
    if spec.kind == "check" or spec.case.series == "small":
        return 1
    if spec.case.series == "2d":
        return {32: 2, 64: 3}.get(spec.case.factor, 1)
    return 3


def needed(names):
    """The measurements of these items, each once; small ones first, states before what begins from them."""
    specs = dict.fromkeys(spec for name in names for spec in items[name].needs)
    return in_order(specs)


def in_order(specs):
    kinds = {"check": 0, "state": 1}
    return sorted(specs, key=lambda s: (portion_of(s), s.case.particles, kinds.get(s.kind, 2)))


def step_seconds(case):
    """Of our default solver on the GPU."""
    return 3e-3 + case.particles * (1.6e-7 if case.series == "3d" or case.particles < 2e5 else 9e-8)


def solver_iterations(spec):
    ratio = spec.case.factor**2 if spec.case.series == "small" else spec.case.particles / 400
    grown = {"CR": 415 * ratio**0.27, "CG": 480 * ratio**0.3}
    return grown.get(spec.solver, 280 * ratio**0.06)


def estimate(spec):
    """Seconds, without the state that it may have to make first."""
    n, case = spec.case.particles, spec.case
    start = 1.5 + 3e-6 * n
    if spec.kind == "check":
        return 0.1 + 1e-6 * n
    if spec.kind == "convergence":
        return start + case.end / case.step * (2.6e-3 + 9.5e-9 * n) + len(isph_solvers) * 1e-7 * n
    if spec.kind == "picture":
        return 2
    steps = case.end / case.step if spec.kind != "trial" else trial_steps(case)
    if spec.backend == "cpu":
        per_particle = 3e-5 if case.series == "3d" else 1e-5
        if spec.kind == "trial" and spec.solver != "ours":
            per_particle = 4e-8 * solver_iterations(spec)
        return 0.3 + steps * n * per_particle / (0.7 * spec.threads + 0.3 if spec.threads else 8)
    if spec.kind == "trial" and spec.solver != "ours":
        return start + steps * solver_iterations(spec) * (2.5e-5 + n * (1.6e-9 if case.series == "3d" else 6e-10))
    return start + steps * step_seconds(case)

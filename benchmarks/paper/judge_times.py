"""Judgements on times."""

from itertools import pairwise

from cases import cpu_resolutions, cube, cube_resolutions, resolutions, scaled, thread_counts, thread_resolutions
from item import number
from judging import both, iteration_points, sizes, smaller, time_points, verdict

against = (("MGCR", "CR"), ("MGCG", "CG"))


def best_of_four(r):
    fewest = [smaller(iteration_points(r, sizes(r), "MGCR", s), f"iterations MGCR/{s}") for s in ("MGCG", "CR", "CG")]
    largest = [scaled(cpu_resolutions[-1])]
    fastest = [
        smaller(time_points(r, largest, "MGCR", s, "cpu", 1), f"µs on one thread MGCR/{s}") for s in ("MGCG", "CR", "CG")
    ]
    return both(*fewest, *fastest)


def proportional(r):
    found = [(f, r.unit_time(scaled(f), "MGCR", "cpu", 1)) for f in cpu_resolutions]
    found = [(scaled(f).label, v) for f, v in found if v is not None]
    if len(found) < 2:
        return None
    spread = max(v for _, v in found) / min(v for _, v in found)
    numbers = ", ".join(f"{c} {number(v)}" for c, v in found)
    return verdict(spread < 1.5, spread < 2.5), f"MGCR, µs per particle and step: {numbers}; largest/least {spread:.2f}"


def small_slower(r):
    cases = [scaled(f) for f in (1, 2, 4)]
    return both(*(smaller(time_points(r, cases, plain, mg), f"µs on the GPU, {plain}/{mg}") for mg, plain in against))


def large_faster(r):
    cases = [scaled(f) for f in resolutions if f >= 8]
    return both(*(smaller(time_points(r, cases, mg, plain), f"µs on the GPU, {mg}/{plain}") for mg, plain in against))


def cube_times(r):
    small_cases, large_cases = [cube(f) for f in cube_resolutions[:2]], [cube(f) for f in cube_resolutions[2:]]
    return both(
        smaller(time_points(r, small_cases, "CR", "MGCR"), "small, µs, CR/MGCR"),
        smaller(time_points(r, large_cases, "MGCR", "CR"), "large, µs, MGCR/CR"),
    )


def solver_share(r):
    found = [(scaled(f), r.breakdown(scaled(f), "cpu", 1)) for f in cpu_resolutions]
    found = [(c.label, (b["MGCR main"] + b["MGCR preconditioning"]) / b["MGCR total"]) for c, b in found if b]
    if not found:
        return None
    return verdict(
        all(v > 0.5 for _, v in found), any(v > 0.5 for _, v in found)
    ), "iterations in MGCR's step: " + ", ".join(f"{c} {v:.0%}" for c, v in found)


def preconditioning_minor(r):
    found = [(scaled(f).label, r.breakdown(scaled(f), "cpu", 1)) for f in cpu_resolutions]
    return smaller(
        [(c, b["MGCR preconditioning"], b["MGCR main"]) for c, b in found if b], "µs, preconditioning/main, one thread"
    )


def preconditioning_falls(r):
    found = [(c.label, b["MGCR preconditioning"]) for c in sizes(r) for b in [r.breakdown(c)] if b]
    points = [(f"{b[0]} against {a[0]}", b[1], a[1]) for a, b in pairwise(found)]
    return smaller(points, "preconditioning, µs on the GPU")


def gpu_solver_share(r):
    found = [(scaled(f).label, r.breakdown(scaled(f))) for f in resolutions]
    shares = [
        (c, (b["MGCR main"] + b["MGCR preconditioning"]) / b["MGCR total"], b["CR solver"] / b["CR total"])
        for c, b in found
        if b
    ]
    if not shares:
        return None
    least = min(min(m, c) for _, m, c in shares)
    text = "iterations in the step of MGCR, CR: " + ", ".join(f"{c} {m:.0%}, {p:.0%}" for c, m, p in shares)
    return verdict(least > 0.5, any(min(m, c) > 0.5 for _, m, c in shares)), text


def cr_turns(r):
    """Unit times of CR have their least value inside the series."""
    found = [(c.label, r.unit_time(c, "CR")) for c in sizes(r)]
    found = [(c, v) for c, v in found if v is not None]
    if len(found) < 3:
        return None
    least = min(range(len(found)), key=lambda k: found[k][1])
    text = "CR, µs on the GPU: " + ", ".join(f"{c} {number(v)}" for c, v in found) + f"; least at {found[least][0]}"
    return verdict(0 < least < len(found) - 1, False), text


def main_constant(r):
    found = [(c.label, r.breakdown(c)) for c in sizes(r) if c.factor >= 16]
    found = [(c, b["MGCR main"]) for c, b in found if b]
    if len(found) < 2:
        return None
    spread = max(v for _, v in found) / min(v for _, v in found)
    text = "main iterations of MGCR, µs on the GPU: " + ", ".join(f"{c} {number(v)}" for c, v in found)
    return verdict(spread < 1.5, spread < 2.5), f"{text}; largest/least {spread:.2f}"


def overhead_of_threads(r):
    """Threads pay less in small cases: the speed-up of the most threads grows with the size."""
    found = []
    for f in thread_resolutions:
        times = [r.unit_time(scaled(f), "MGCR", "cpu", n) for n in thread_counts]
        known = [(n, t) for n, t in zip(thread_counts, times, strict=True) if t]
        if len(known) > 1 and times[0]:
            found.append((scaled(f).label, times[0] / known[-1][1], known[-1][0]))
    if len(found) < 2:
        return None
    text = ", ".join(f"{c} {number(s)}" for c, s, _ in found)
    return verdict(found[-1][1] > found[0][1], False), f"MGCR, {found[-1][2]} threads against one, times as fast: {text}"

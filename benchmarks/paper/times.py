"""Figs. 6-11 and 14 of [K23]: unit calculation times, a step's time over the number of fluid particles, in microseconds."""

from cases import cpu_resolutions, cube, cube_resolutions, four, resolutions, scaled, thread_counts, thread_resolutions
from item import Item, Plot, curves, number, told_growth, whole
from iterations import at_end, early, trials
from spec import Spec

with_ours = (*four, "ours")
parts = ("MGCR total", "MGCR main", "MGCR preconditioning", "MGCR set-up", "CR total", "CR solver", "ours total")
y_label = "time of a step / fluid particles [µs]"
derived = (
    "The time of MGCR's main iterations is the time of CR's iterations on the same system, times the number of MGCR's; the rest is "
    "preconditioning. Where it is negative, both times vary by more than that. Set-up makes the coarse operators."
)


def table(cases, backend, threads):
    def rows(results):
        made = [
            {"case": c.label, "particles": c.particles, "time": c.end}
            | {s: results.unit_time(c, s, backend, threads) for s in with_ours}
            for c in cases
        ]
        return [r for r in made if whole(r[s] for s in with_ours)]

    return rows


def breakdown(cases, backend, threads):
    def rows(results):
        made = []
        for c in cases:
            if found := results.breakdown(c, backend, threads):
                ours = results.unit_time(c, "ours", backend, threads)
                made.append({"case": c.label, "particles": c.particles, "time": c.end, **found, "ours total": ours})
        return made

    return rows


def compared(rows, a, b):
    """How much faster a is than b, from the least to the largest factor."""
    found = [r[b] / r[a] for r in rows if r.get(a) and r.get(b)]
    name = a[0].upper() + a[1:]
    return [f"{name} is {number(min(found))} to {number(max(found))} times as fast as {b}."] if found else []


def faster(rows):
    """Where the multigrid solvers beat those without a preconditioner."""
    text = []
    for mg, plain in (("MGCR", "CR"), ("MGCG", "CG")):
        text += compared(rows, mg, plain)
    return text + compared(rows, "ours", "MGCR")


def times_reading(rows, _):
    return [t for t in [told_growth(at_end(rows), with_ours) + early(rows), *faster(rows)] if t]


def gpu_reading(rows, results):
    text = times_reading(rows, results)
    small = [r for r in rows if r["particles"] <= 6400 and r["MGCR"] and r["CR"]]
    on_gpu = any(m["backend"] == "cuda" for m in results.all.values() if "backend" in m)
    if small and on_gpu and all(r["MGCR"] < r["CR"] for r in small):
        text.append(
            "The multigrid is not slower in small cases here, because the Krylov loop is one CUDA graph without the host, and coarse "
            "levels of at most 1100 unknowns are one dense matrix ([notes](notes/performance.md#mph-i-on-a-gpu))."
        )
    return text


def breakdown_reading(rows, _):
    text = []
    for r in at_end(rows)[-1:]:
        solver = (r["MGCR main"] + r["MGCR preconditioning"]) / r["MGCR total"]
        share = r["MGCR preconditioning"] / (r["MGCR main"] + r["MGCR preconditioning"])
        text.append(
            f"In {r['case']} iterations are {solver:.0%} of MGCR's step and {r['CR solver'] / r['CR total']:.0%} of CR's, and "
            f"preconditioning is {share:.0%} of MGCR's iterations."
        )
    return text + ([derived] if rows else [])


def threads_name(n):
    return f"{n} thread{'s' * (n > 1)}"


def thread_table(solver):
    def rows(results):
        made = []
        for f in thread_resolutions:
            c = scaled(f)
            found = {threads_name(n): results.unit_time(c, solver, "cpu", n) for n in thread_counts}
            if whole(found.values()):
                made.append({"case": c.label, "particles": c.particles, "time": c.end} | found)
        return made

    return rows


thread_names = [threads_name(n) for n in thread_counts]


def thread_reading(rows, _):
    text = []
    for r in rows[:1] + rows[-1:]:
        if len(found := [(n, r[n]) for n in thread_names if r[n]]) > 1:
            text.append(f"In {r['case']} {found[-1][0]} are {number(found[0][1] / found[-1][1])} times as fast as {found[0][0]}.")
    return list(dict.fromkeys(text))


def plot(names):
    return lambda rows, _: Plot(curves(at_end(rows), "particles", names), "fluid particles", y_label)


def cpu_trials(resolutions_, solvers, threads):
    cases = [scaled(f) for f in resolutions_]
    return tuple(Spec("state", c) for c in cases) + tuple(
        Spec("trial", c, s, "cpu", n) for c in cases for n in threads for s in solvers
    )


single, sizes = [scaled(f) for f in cpu_resolutions], [scaled(f) for f in resolutions]
cubes = [cube(f) for f in cube_resolutions]
items = [
    Item(
        "k23-fig6",
        "[K23] Fig. 6: times on one CPU thread [µs per particle and step]",
        "Times per particle and step grow with CR and CG; “when using the MGCR and MGCG methods, the unit calculation time is "
        "almost constant even for large problems” (sect. 4.2, Xeon Gold 6252).",
        cpu_trials(cpu_resolutions, with_ours, (1,)),
        table(single, "cpu", 1),
        times_reading,
        plot(with_ours),
    ),
    Item(
        "k23-fig7",
        "[K23] Fig. 7: break-down on one CPU thread [µs per particle and step]",
        "“Most of the calculation time was spent by the solvers”; “the preconditioning time was not dominant in all the time spent "
        "by the MGCR solver” (sect. 4.2).",
        cpu_trials(cpu_resolutions, ("MGCR", "CR", "ours"), (1,)),
        breakdown(single, "cpu", 1),
        breakdown_reading,
        plot(parts),
    ),
    Item(
        "k23-fig8",
        "[K23] Fig. 8: times on a GPU [µs per particle and step]",
        "“In the relatively small cases with 400–6400 particles, the CR and CG methods were faster than the MGCR and MGCG methods, "
        "but in the larger cases with over 25,600 particles, the multigrid methods were faster” (sect. 4.3, A100).",
        trials(sizes, with_ours),
        table(sizes, "device", 0),
        gpu_reading,
        plot(with_ours),
    ),
    Item(
        "k23-fig9",
        "[K23] Fig. 9: break-down on a GPU [µs per particle and step]",
        "The solvers dominate; the unit time of CR falls to x1/16 and rises from there; that of MGCR falls, from x1/16 more slowly; "
        "preconditioning takes more than the main iterations up to x1/16 and less from x1/32; the main iterations' unit time is "
        "constant from 102,400 particles on (sect. 4.3).",
        trials(sizes, ("MGCR", "CR", "ours")),
        breakdown(sizes, "device", 0),
        breakdown_reading,
        plot(parts),
    ),
    Item(
        "k23-fig10",
        "[K23] Fig. 10: MGCR on CPU threads [µs per particle and step]",
        "With more threads the overhead is larger and dominates in a wider range; “the unit calculation time was mostly constant in "
        "the sufficiently large cases” (sect. 4.3).",
        cpu_trials(thread_resolutions, ("MGCR",), thread_counts),
        thread_table("MGCR"),
        thread_reading,
        plot(thread_names),
    ),
    Item(
        "k23-fig11",
        "[K23] Fig. 11: CR on CPU threads [µs per particle and step]",
        "The overhead and its range are smaller than with MGCR; the unit time of CR increases in the sufficiently large cases "
        "(sect. 4.3).",
        cpu_trials(thread_resolutions, ("CR",), thread_counts),
        thread_table("CR"),
        thread_reading,
        plot(thread_names),
    ),
    Item(
        "k23-fig14",
        "[K23] Fig. 14: times in 3D on a GPU [µs per particle and step]",
        "“The MGCR method was slower than the CR method in the small cases. In contrast, the MGCR method was faster in the large "
        "cases” (sect. 4.4).",
        trials(cubes, ("MGCR", "CR", "ours")),
        breakdown(cubes, "device", 0),
        breakdown_reading,
        plot(parts),
    ),
]

"""Judgements on iterations, and those of [O23]."""

from cases import cube, cube_resolutions, diffusion_factors, isph, small, widths
from item import growth, number
from iterations import at_end, table
from judging import both, iteration_points, sizes, smaller, verdict

against = (("MGCR", "CR"), ("MGCG", "CG"))


def suppressed(r):
    cases = sizes(r) + [cube(f) for f in cube_resolutions]
    return both(*(smaller(iteration_points(r, cases, mg, plain), f"{mg}/{plain}") for mg, plain in against))


def residuals_below_gradients(r):
    return both(*(smaller(iteration_points(r, sizes(r), a, b), f"{a}/{b}") for a, b in (("CR", "CG"), ("MGCR", "MGCG"))))


def hardly_depends(r):
    rows = at_end(table(sizes(r), ("MGCR", "CR", "ours"), r))
    found = growth(rows, "MGCR")
    if not found:
        return None
    p, low, high, a, b = found
    text = f"MGCR {number(low)} at {a['case']}, {number(high)} at {b['case']}: as N^{p:.3f}"
    for s in ("CR", "ours"):
        if other := growth(rows, s):
            text += f"; {s} {number(other[1])} → {number(other[2])}, as N^{other[0]:.2f}"
    return verdict(p < 0.06, p < 0.1), text


def better_scalability(r):
    rows = at_end(table(sizes(r), ("MGCR", "MGCG"), r))
    a, b = growth(rows, "MGCR"), growth(rows, "MGCG")
    if not (a and b):
        return None
    return verdict(a[0] < b[0], False), f"iterations grow as N^{a[0]:.3f} with MGCR, N^{b[0]:.3f} with MGCG"


def converged(wanted):
    """Whether every trial of these solvers that was made came to its tolerance."""

    def judge(r):
        made = [m for k, m in r.all.items() if k.startswith("trial_") and any(f"_{s}_" in k for s in wanted)]
        failed = sum("failed" in m for m in made)
        return (
            (verdict(failed == 0, failed < len(made)), f"{len(made) - failed} of {len(made)} trials converged")
            if made
            else None
        )

    return judge


def small_cases(r):
    cases = [small(k) for k in diffusion_factors]
    return both(*(smaller(iteration_points(r, cases, mg, plain), f"{mg}/{plain}") for mg, plain in against))


def scaled_below_small(r):
    cases = [c for c in sizes(r) if c.factor > 1]
    return smaller(
        [(c.label, r.iterations(c, "MGCR"), r.iterations(small(c.factor), "MGCR")) for c in cases], "MGCR, scaled/small"
    )


def cube_iterations(r):
    rows = table([cube(f) for f in cube_resolutions], ("MGCR", "CR"), r)
    a, b = growth(rows, "MGCR"), growth(rows, "CR")
    if not (a and b):
        return None
    return verdict(a[0] < b[0] / 2, a[0] < b[0]), f"MGCR {number(a[1])} → {number(a[2])}, CR {number(b[1])} → {number(b[2])}"


def isph_reduced(r):
    points = [
        (f"width {w}", *(f and f["iterations"] for f in (r.isph(isph(w), "MGCG(2,4)"), r.isph(isph(w), "CG"))))
        for w in widths
    ]
    return smaller(points, "iterations, MGCG(2,4)/CG")


def isph_levels(r):
    points = [
        (f"width {w}", *(f and f["iterations"] for f in (r.isph(isph(w), "MGCG(2,4)"), r.isph(isph(w), "MGCG(1,4)"))))
        for w in widths
    ]
    return smaller(points, "iterations, MGCG(2,4)/MGCG(1,4)")


def isph_sizes(r):
    grown = {}
    for s in ("CG", "MGCG(1,4)", "MGCG(2,4)", "MGCG(all,4)", "ours"):
        rows = [{"particles": 58621 * w, "case": w, "n": f["iterations"]} for w in widths for f in [r.isph(isph(w), s)] if f]
        if found := growth(rows, "n"):
            grown[s] = found
    if "CG" not in grown or "MGCG(2,4)" not in grown:
        return None
    text = ", ".join(f"{s} {f[1]} → {f[2]}" for s, f in grown.items())
    cg, mg = grown["CG"], grown["MGCG(2,4)"]
    return verdict(
        cg[2] > cg[1] and mg[2] - mg[1] < cg[2] - cg[1], cg[2] > cg[1]
    ), f"width {cg[3]['case']} → {cg[4]['case']}: {text}"


def isph_practical(r):
    def total(w, s):
        found = r.isph(isph(w), s)
        return found and 1e3 * (found["setup_s"] + found["solve_s"])

    return both(
        smaller(
            [(f"width {w}", total(w, "MGCG(2,4)"), total(w, "CG")) for w in widths], "set-up and solve, ms, MGCG(2,4)/CG"
        ),
        smaller([(f"width {w}", total(w, "ours"), total(w, "CG")) for w in widths], "ours/CG"),
    )

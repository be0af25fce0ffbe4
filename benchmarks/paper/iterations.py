"""Figs. 3-5 and 13 of [K23]: iterations of the solvers."""

import published
from cases import cube, cube_resolutions, diffusion_factors, four, resolutions, scaled, small
from item import Item, Plot, curves, number, told_growth
from spec import Spec

with_ours = (*four, "ours")
scaled_solvers = (*four, "MGCR as printed", "ours")


def trials(cases, solvers):
    return tuple(Spec("state", c) for c in cases) + tuple(Spec("trial", c, s) for c in cases for s in solvers)


def table(cases, solvers, results):
    rows = []
    for case in cases:
        state = results.get(Spec("state", case))
        row = {"case": case.label, "particles": case.particles, "time": state and state["time"]}
        rows.append(
            row
            | {s: results.iterations(case, s) for s in solvers}
            | {"authors' CR": published.authors_cr.get(case.name), "authors' MGCR": published.authors_mgcr.get(case.name)}
        )
    return [r for r in rows if any(r[s] is not None for s in solvers)]


def at_end(rows):
    """Those at 0.2 s: others do not belong into the same comparison of sizes."""
    return [r for r in rows if r["time"] is not None and abs(r["time"] - 0.2) < 1e-9]


def early(rows):
    return "".join(
        f" {r['case']}, at t = {r['time']:g} s, is left out."
        for r in rows
        if r["time"] is not None and r not in at_end(rows)
    )


def sizes_reading(rows, _):
    text = [told_growth(at_end(rows), [s for s in scaled_solvers if rows and s in rows[0]]) + early(rows)]
    printed = [
        (r["MGCR"], r["MGCR as printed"], r["case"]) for r in at_end(rows) if r.get("MGCR") and r.get("MGCR as printed")
    ]
    if printed:
        a, b, case = printed[-1]
        text.append(
            f"MGCR is that of the authors' program (1/A_ii on particles, sweeps 2, 3, 4). With the D̂ of the text and sweeps "
            f"2, 2, 4 it needs {number(b)} instead of {number(a)} iterations at {case}."
        )
    return [t for t in text if t]


def small_table(results):
    return [row | {"factor": k} for k in diffusion_factors for row in table([small(k)], with_ours, results)]


def small_reading(rows, _):
    if not rows:
        return []
    a, b = rows[0], rows[-1]
    told = ", ".join(f"{s} {number(a[s])} → {number(b[s])}" for s in with_ours if a[s] and b[s])
    return [f"From {a['case']} to {b['case']}, diffusion numbers times {b['factor'] / a['factor']:g}: {told}."]


def compared(results):
    rows = []
    for k in diffusion_factors:
        big, little = scaled(k), small(k)
        row = {"factor": k, "case": big.label}
        for s in with_ours:
            row |= {f"{s} scaled": results.iterations(big, s), f"{s} small": results.iterations(little, s)}
        state = results.get(Spec("state", big))
        if state and abs(state["time"] - 0.2) < 1e-9 and any(v is not None for v in list(row.values())[2:]):
            rows.append(row)
    return rows


def compared_reading(rows, _):
    if not rows:
        return []
    more = [r["case"] for r in rows if r["MGCR scaled"] and r["MGCR small"] and r["MGCR scaled"] > r["MGCR small"]]
    return [f"With MGCR the scaled case takes more iterations than the small one in {len(more)} of {len(rows)} cases."]


def plot(names, x="particles", label="fluid particles"):
    return lambda rows, _: Plot(curves(at_end(rows) if x == "particles" else rows, x, names), label, "iterations")


diffusion = "diffusion numbers / those of x1"
sizes, smalls = [scaled(f) for f in resolutions], [small(k) for k in diffusion_factors]
cubes = [cube(f) for f in cube_resolutions]
items = [
    Item(
        "k23-fig3",
        "[K23] Fig. 3: iterations at 0.2 s against size, 2D",
        "“When the CR and CG solvers were adopted, the number of iterations drastically increased with the problem size. On the "
        "other hand, with the MGCR and MGCG solvers, the increase in the number of iterations was limited.” CR and MGCR take fewer "
        "than CG and MGCG (sect. 4.1).",
        trials(sizes, scaled_solvers),
        lambda r: table(sizes, scaled_solvers, r),
        sizes_reading,
        plot(scaled_solvers),
    ),
    Item(
        "k23-fig4",
        "[K23] Fig. 4: iterations against diffusion numbers at one size",
        "“The number of iterations is smaller with the MGCR and MGCG solvers than with the CR and CG solvers, respectively” "
        "(sect. 4.1).",
        trials(smalls, with_ours),
        small_table,
        small_reading,
        plot(with_ours, "factor", diffusion),
    ),
    Item(
        "k23-fig5",
        "[K23] Fig. 5: scaled against small cases",
        "“The number of iterations in the scaled cases is kept smaller than that in the corresponding small cases” with the "
        "multigrid; MGCR shows better scalability than MGCG (sect. 4.1).",
        trials(sizes, with_ours) + trials(smalls, with_ours),
        compared,
        compared_reading,
        plot(["MGCR scaled", "MGCR small", "MGCG scaled", "MGCG small", "ours scaled", "ours small"], "factor", diffusion),
    ),
    Item(
        "k23-fig13",
        "[K23] Fig. 13: iterations at 0.2 s against size, 3D",
        "“While the CR method suffered from a large number of iterations in the large cases, the MGCR method could suppress the "
        "iterations even in the large cases” (sect. 4.4).",
        trials(cubes, with_ours),
        lambda r: table(cubes, with_ours, r),
        sizes_reading,
        plot(with_ours),
    ),
]

"""Fig. 12 of [K23], Figs. 7 and 8 of [O23], and the comparison of backends."""

from cases import cube, isph, isph_solvers, scaled, widths
from item import Item, Plot, curves, told_growth
from spec import Spec

shown = cube(2)


def histories(rows, results):
    found = results.get(Spec("convergence", isph(1))) or {"solvers": {}}
    lines = {s: (list(range(len(v["residuals"]))), v["residuals"]) for s, v in found["solvers"].items()}
    return Plot(lines, "iteration", "|r| / |b|", log_x=False)


def convergence_rows(results):
    found = results.get(Spec("convergence", isph(1)))
    if not found:
        return []
    return [
        {
            "solver": s,
            "outcome": v["outcome"],
            "iterations": v["iterations"],
            "set-up [ms]": 1e3 * v["setup_s"],
            "solve [ms]": 1e3 * v["solve_s"],
            "time": found["time"],
        }
        for s, v in found["solvers"].items()
    ]


def convergence_reading(rows, _):
    count = {r["solver"]: r["iterations"] for r in rows if r["outcome"] == "converged"}
    if "CG" not in count:
        return []
    return [
        f"Iterations are those to |r| / |b| = 1e-6 at t = {rows[0]['time']:g} s. The length of the paper's tank is not known; ours is "
        "153 m long. The counts of the picture cannot be read."
    ]


def width_rows(results):
    rows = []
    for w in widths:
        if found := results.get(Spec("convergence", isph(w))):
            counts = {s: v and v["iterations"] for s in isph_solvers for v in [results.isph(isph(w), s)]}
            times = {
                f"{s} [ms]": v and 1e3 * (v["setup_s"] + v["solve_s"])
                for s in isph_solvers
                for v in [results.isph(isph(w), s)]
            }
            rows.append({"case": f"width {w}", "particles": 58621 * w, "time": found["time"]} | counts | times)
    return rows


def width_reading(rows, _):
    text = [told_growth(rows, isph_solvers), "Milliseconds are those of set-up and solve." if rows else ""]
    return [t for t in text if t]


compared = {"CPU, double": ("cpu", "double"), "GPU, double": ("device", "double"), "GPU, mixed": ("device", "mixed")}
quantities = ("front_x", "top", "kinetic_energy", "potential_energy")
bounds = {"GPU, double": 1e-5, "GPU, mixed": 1e-4}


def backend_run(case, name):
    backend, precision = compared[name]
    return Spec("run", case, backend=backend, precision=precision)


def backend_rows(results):
    rows = []
    for case, label in ((scaled(4), "2D x1/4"), (cube(1), "3D x1")):
        reference = results.get(backend_run(case, "CPU, double"))
        for name in compared:
            found = results.get(backend_run(case, name))
            if not found:
                continue
            row = {
                "case": label,
                "run": name,
                "on": found["device"],
                **{q: f"{found[q]:.9g}" for q in quantities},
                "iterations": found["iterations"]["mean"],
                "largest difference": None,
                "iterations, difference": None,
            }
            if reference and name in bounds:
                row["largest difference"] = max(abs(found[q] / reference[q] - 1) for q in quantities)
                row["iterations, difference"] = found["iterations"]["mean"] / reference["iterations"]["mean"] - 1
            rows.append(row)
    return rows


def backend_reading(rows, _):
    compared = [r for r in rows if r["largest difference"] is not None]
    bad = [r for r in compared if r["largest difference"] > bounds[r["run"]] or abs(r["iterations, difference"]) > 0.05]
    told = ", ".join(f"{bound:g} ({name})" for name, bound in bounds.items())
    if not compared:
        return []
    return [f"Bounds are {told}, and 5 % for iterations. "
            + ("NOT MET: " + "; ".join(f"{r['case']}, {r['run']}" for r in bad) + "." if bad else "All are met.")]


items = [
    Item(
        "k23-fig12",
        "[K23] Fig. 12: dam break in 3D",
        "A picture of the 3D case (sect. 4.4).",
        (Spec("state", shown), Spec("picture", shown)),
        lambda r: [],
        lambda rows, r: (
            [f"{shown.label} at 0.2 s, drawn by `treacle plot`. Colours show the speed."]
            if r.get(Spec("picture", shown))
            else []
        ),
    ),
    Item(
        "o23-fig7",
        "[O23] Fig. 7: convergence at t = 3.2 s",
        "“Compared to the CG solver, the MGCG solver improves the decreasing trend of residuals to convergence and reduces the "
        "number of iterations”; MGCG(2,4) takes significantly fewer than MGCG(1,4) (sect. 4.2).",
        (Spec("convergence", isph(1)),),
        convergence_rows,
        convergence_reading,
        histories,
    ),
    Item(
        "o23-fig8",
        "[O23] Fig. 8: iterations against size",
        "“The number of iterations increases in the CG solver. In contrast, the number of iterations is suppressed in the MGCG "
        "solver” (sect. 4.2).",
        tuple(Spec("convergence", isph(w)) for w in widths),
        width_rows,
        width_reading,
        lambda rows, _: Plot(curves(rows, "particles", isph_solvers), "fluid particles", "iterations", log_y=False),
    ),
    Item(
        "backends",
        "CPU against GPU",
        "This comparison is not in the papers. It gives the largest relative difference of front, top and energies at 0.2 s between "
        "the backends, and mean iterations.",
        tuple(backend_run(c, n) for c in (scaled(4), cube(1)) for n in compared),
        backend_rows,
        backend_reading,
    ),
]

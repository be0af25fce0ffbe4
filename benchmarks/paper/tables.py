"""Tables 1-4 of [K23] and Table 1 of [O23]: the parameters of our cases, as the program reads them, against the printed ones."""

import math

import published
from cases import cube, cube_resolutions, diffusion_factors, isph, resolutions, scaled, small
from item import Item, number
from spec import Spec

length = 0.02  # of the fluid [m], L in [K23 eqs. (50)-(52)]


def derived(c):
    """The estimates of [K23] from a case's parameters: degrees of freedom, nonzeros by eq. (46), condition number by eqs. (49),
    (52), (53)."""
    d, h = c["dimensions"], c["viscosity_radius"]
    dof = c["particles"] * d
    nnz = dof * (2 * math.pi * h**2 if d == 2 else 4 * math.pi * h**3)
    inertia, viscosity = c["density"] / c["step"], c["dynamic_viscosity"] + c["bulk_viscosity"]
    largest = inertia + viscosity * 4 / (h * c["spacing"]) ** 2
    least = inertia + viscosity * (math.pi / (2 * length)) ** 2
    return {"dof": dof, "nnz": nnz, "condition": largest / least}


def row(case, quantity, printed, ours):
    missing = printed is None or ours is None
    return {
        "case": case,
        "quantity": quantity,
        "printed": printed,
        "ours": ours,
        "difference": None if missing else ours / printed - 1,
    }


def parameters(case, printed, results):
    found = results.get(Spec("check", case)) or {}
    return [row(case.label, name, value, found.get(name)) for name, value in printed.items()]


def series(case_of, printed, results):
    rows = []
    for f, values in printed.items():
        case = case_of(f)
        found = results.get(Spec("check", case))
        state = results.get(Spec("state", case)) or {}
        ours = {**found, **derived(found), "highest_level": state.get("highest_level")} if found else {}
        told = {"spacing": 1e-3 / f, "step": 1e-3 / f, **dict(zip(published.columns, values, strict=True))}
        rows += [row(case.label, name, value, ours.get(name)) for name, value in told.items()]
    return rows


def table3(results):
    rows = []
    for k in diffusion_factors:
        d = {"gravity": 10 * k, "dynamic_viscosity": 10 * k, "bulk_viscosity": 1e4 * k, "d_mu": 10 * k, "d_lambda": 1e3 * k}
        rows += [{**r, "case": f"d x{k}"} for r in parameters(small(k), d, results)]
    return rows


def table_osaki(results):
    rows = parameters(isph(1), {k: v for k, v in published.o23.items() if k != "kinematic_viscosity"}, results)
    found = results.get(Spec("check", isph(1)))
    ours = found and found["dynamic_viscosity"] / found["density"]
    return rows + [row("width 1", "kinematic_viscosity", published.o23["kinematic_viscosity"], ours)]


def reading(rows, _):
    """How many agree, and why the others do not."""
    compared = [r for r in rows if r["difference"] is not None]
    if not compared:
        return []
    apart = [r for r in compared if abs(r["difference"]) > 0.006]
    text = [f"{len(compared) - len(apart)} of {len(compared)} numbers agree."]
    if others := [r for r in apart if r["quantity"] not in ("d_lambda", "highest_level", "kinematic_viscosity")]:
        told = (f"{r['quantity']} of {r['case']} is {number(r['ours'])} for {number(r['printed'])}" for r in others)
        text.append("; ".join(told) + ".")
    if any(r["quantity"] == "d_lambda" for r in apart):
        text.append(
            "λ Δt/(ρ l²) with the printed λ of 10^4 Pa s is ten times the printed d_λ. The printed condition numbers follow "
            "from λ = 10^4 Pa s, so d_λ is misprinted."
        )
    if any(r["quantity"] == "highest_level" for r in apart):
        text.append(
            "The highest level is larger than the printed one: like the authors' program, ours goes on until one bucket is "
            "left."
        )
    if any(r["quantity"] == "kinematic_viscosity" for r in apart):
        text.append("The kinematic viscosity of water is 1e-6 m²/s: the printed 1e6 has the wrong sign of the exponent.")
    return text


def checks(cases):
    return tuple(Spec("check", c) for c in cases)


all_scaled = [scaled(f) for f in resolutions]
all_cubes = [cube(f) for f in cube_resolutions]
items = [
    Item(
        "k23-table1",
        "[K23] Table 1: the base case",
        "Parameters of the high-viscosity dam break, case x1 (sect. 4.1).",
        checks([scaled(1)]),
        lambda r: parameters(scaled(1), published.k23_base, r),
        reading,
    ),
    Item(
        "k23-table2",
        "[K23] Table 2: scaled cases",
        "Sizes, diffusion numbers, nonzeros by eq. (46), condition numbers by eqs. "
        "(49)-(53) and levels of x1 … x1/64 (sect. 4.1).",
        checks(all_scaled) + tuple(Spec("state", c) for c in all_scaled),
        lambda r: series(scaled, published.k23_scaled, r),
        reading,
    ),
    Item(
        "k23-table3",
        "[K23] Table 3: small cases",
        "The size of x1 with gravity and viscosities times 2 … 64 (sect. 4.1).",
        checks([small(k) for k in diffusion_factors]),
        table3,
        reading,
    ),
    Item(
        "k23-table4",
        "[K23] Table 4: scaled cases in 3D",
        "As Table 2, for x2 … x1/4 in three dimensions (sect. 4.4).",
        checks(all_cubes) + tuple(Spec("state", c) for c in all_cubes),
        lambda r: series(cube, published.k23_cube, r),
        reading,
    ),
    Item(
        "o23-table1",
        "[O23] Table 1: ISPH dam break",
        "Conditions of the three-dimensional dam break (sect. 4.1).",
        checks([isph(1)]),
        table_osaki,
        reading,
    ),
]

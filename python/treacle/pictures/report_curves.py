"""Curves for the page of a report: what the tables of a run hold over time, thinned so that peaks stay."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Floats, Table

most_points = 1200  # of a curve

Chart = dict[str, Any]  # for the script of the page; a curve of it, too

column_units = {
    "pressure": "Pa", "dynamic_viscosity": "Pa s", "shear_rate": "1/s", "temperature": "K", "height": "m",
    "volume": "m³", "mass": "kg", "volume_flow_rate": "m³/s", "mass_flow_rate": "kg/s", "power": "W", "torque": "N m",
}  # fmt: skip
column_starts = {"velocity": "m/s", "center": "m", "force": "N", "torque": "N m"}


def thin(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """At most some thousand points of a curve: the least and the greatest value of each of many parts, in order."""
    keep = np.isfinite(x) & np.isfinite(y)
    x, y = x[keep], y[keep]
    if len(x) <= most_points:
        return x, y
    edges = np.linspace(0, len(x), most_points // 2 + 1).astype(int)
    chosen = {0, len(x) - 1}
    for a, b in pairwise(edges):
        chosen |= {a + int(np.argmin(y[a:b])), a + int(np.argmax(y[a:b]))}
    rows = sorted(chosen)
    return x[rows], y[rows]


def numbers(values: Iterable[float]) -> list[float]:
    """For JSON, with six digits."""
    return [float(f"{value:.6g}") for value in values]


def curve(name: str, x: ArrayLike, y: ArrayLike) -> Chart:
    x, y = thin(np.asarray(x, float), np.asarray(y, float))
    return {"name": name.replace("_", " "), "x": [float(f"{value:.9g}") for value in x], "y": numbers(y)}


def chart(
    title: str, y: str, curves: list[Chart], x: str = "time [s]", logarithmic: bool = False, remark: str = ""
) -> Chart | None:
    """A chart as the page draws it, or None where no curve has a point."""
    curves = [one for one in curves if one["x"]]
    return {"title": title, "x": x, "y": y, "log": logarithmic, "curves": curves, "remark": remark} if curves else None


def of_history(table: Table) -> list[Chart]:
    """Charts of history.csv."""
    if not len(table.get("time", [])):
        return []
    t = table["time"]

    def of(title: str, y: str, *names: str) -> Chart | None:
        return chart(title, y, [curve(name, t, table[name]) for name in names if name in table])

    charts = [
        of("Energy", "J", "kinetic_energy", "potential_energy"),
        of("Front and top", "m", "front_x", "top"),
        of("Largest speed", "m/s", "max_speed"),
        of("Iterations per step", "", "iterations", "fallbacks"),
        of("Time step", "s", "time_step") if np.ptp(table.get("time_step", [0])) > 1e-9 * t[-1] else None,
        of("Computing time per step", "s", "seconds"),
        of("Fluid particles", "", "particles", "inflow_particles", "outflow_particles"),
    ]
    if np.any(table.get("density_error", 0)):
        charts.append(of("Error of density", "", "density_error"))
    return [one for one in charts if one]


def of_balance(balance: Table, history: Table) -> list[Chart]:
    """Charts of balance.csv: where energy has gone since the first step, powers, forces on walls."""
    if not len(balance.get("time", [])):
        return []
    t = balance["time"]
    names = [
        "shear_dissipation",
        "bulk_dissipation",
        "inertial_loss",
        "elastic_power",
        "wall_power",
        "repulsion_power",
        "surface_power",
        "buoyancy_power",
    ]
    powers = [name for name in names if name in balance and np.any(balance[name])]
    charts = [
        _energy_since(balance, history, powers),
        chart("Power", "W", [curve(name, t, balance[name]) for name in powers]),
    ]
    heat = [name for name in ("viscous_heating", "heat_from_walls", "heat_from_surface") if name in balance]
    charts.append(chart("Heat", "W", [curve(name, t, balance[name]) for name in heat]))
    for quantity, unit in (("force", "N"), ("torque", "N m")):
        loads = [name for name in balance if f"_{quantity}" in name and np.any(balance[name])]
        charts.append(
            chart(f"{quantity.capitalize()} on walls", unit, [curve(name, t, balance[name]) for name in loads])
        )
    return [one for one in charts if one]


def _energy_since(balance: Table, history: Table, powers: Sequence[str]) -> Chart | None:
    """Energies less those after the first step, and what was taken and given since, which is the same but for the
    solver's tolerance (docs/output.md)."""
    step, energies = history.get("step", np.zeros(0)), ("kinetic_energy", "potential_energy")
    rows = min(len(step), len(balance["step"]))
    if rows < 2 or not np.array_equal(step[:rows], balance["step"][:rows]):
        return None
    t, lengths = balance["time"][:rows], history["time_step"][:rows].copy()
    lengths[0] = 0
    sums = {name: np.cumsum(balance[name][:rows] * lengths) for name in powers}
    losses = ("shear_dissipation", "bulk_dissipation", "inertial_loss")
    total = sum(history[name][:rows] - history[name][0] for name in energies)
    given = sum((-amount if name in losses else amount for name, amount in sums.items()), np.zeros(rows))
    curves = [curve(name, t, history[name][:rows] - history[name][0]) for name in energies]
    curves += [curve(name.replace("_power", "_work"), t, amount) for name, amount in sums.items()]
    curves.append(curve("not accounted for", t, total - given))
    return chart(
        "Where the energy went",
        "J",
        curves,
        remark="Since the first step. Losses and dissipation are taken from the flow, work is given to it.",
    )


def of_rigid_bodies(table: Table) -> list[Chart]:
    """Places and velocities."""
    if not len(table.get("time", [])):
        return []
    velocity = [name for name in table if "velocity" in name and "angular" not in name]
    turning = [name for name in table if "angular_velocity" in name]
    places = [
        name for name in table if name[-2:] in ("_x", "_y", "_z") and "velocity" not in name and "axis" not in name
    ]
    parts = (("places", "m", places), ("velocities", "m/s", velocity), ("angular velocities", "1/s", turning))
    charts = [
        chart(f"Rigid bodies: {what}", unit, [curve(n, table["time"], table[n]) for n in names])
        for what, unit, names in parts
    ]
    return [one for one in charts if one]


def unit_of(column: str) -> str:
    return column_units.get(column) or next(
        (unit for start, unit in column_starts.items() if column.startswith(start)), ""
    )


def of_probe(name: str, kind: str | None, table: Table) -> list[Chart]:
    """Charts of what a probe has read, by its type in the case."""
    if not len(table.get("time", [])):
        return []
    if kind in ("line", "plane"):
        return _of_places(name, kind, table)
    groups: dict[str, list[str]] = {}
    for column in table:
        if column not in ("time", "x", "y", "z"):
            groups.setdefault(unit_of(column), []).append(column)
    charts = []
    for unit, columns in groups.items():
        what = columns[0] if len(columns) == 1 else columns[0].rsplit("_", 1)[0]
        charts.append(
            chart(f"Probe {name}: {what.replace('_', ' ')}", unit, [curve(c, table["time"], table[c]) for c in columns])
        )
    return [one for one in charts if one]


def _of_places(name: str, kind: str, table: Table) -> list[Chart]:
    """Profiles along a line at some times; of a plane nothing but how speeds are spread at these."""
    times = np.unique(table["time"])
    some = times[np.unique(np.linspace(0, len(times) - 1, 5).round().astype(int))]
    speed = np.sqrt(sum(table[c] ** 2 for c in table if c.startswith("velocity_")))
    charts = []
    for what, values, unit in (("speed", speed, "m/s"), ("pressure", table["pressure"], "Pa")):
        curves = []
        for time in some:
            rows = table["time"] == time
            if kind == "line":
                curves.append(curve(f"{time:.4g} s", table["distance"][rows], values[rows]))
            else:
                ranked = np.sort(values[rows][np.isfinite(values[rows])])
                curves.append(curve(f"{time:.4g} s", np.arange(1, len(ranked) + 1) / max(1, len(ranked)), ranked))
        x = "distance [m]" if kind == "line" else "share of the plane's places that is below"
        charts.append(chart(f"Probe {name}: {what}", unit, curves, x=x))
    return [one for one in charts if one]

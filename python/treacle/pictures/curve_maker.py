"""Pictures of a run's tables: its history, what a probe has read, and residuals of solvers."""

import csv
from argparse import Namespace
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._command import say
from .arrays import Floats, Table
from .errors import PictureError
from .panels import Panel, draw_panels, draw_plane, draw_residuals
from .report_curves import unit_of
from .run_files import RunFiles

most_profiles = 4  # of a line

Part = tuple[str, str, slice]  # of a table: a name, the column of the x axis, rows


def make(options: Namespace) -> None:
    """Draws what the options of treacle.plot ask for."""
    directory = Path(options.directory)
    if options.convergence:
        draw_residuals(options.output, residuals_of(directory), options.title, options.remark)
        return say(f"picture: {options.output}")
    run = RunFiles(directory)
    if options.history:
        table = read_numbers(directory / "history.csv", "step")
        if not len(table["step"]):
            raise PictureError(f"{directory / 'history.csv'}: the history holds no steps")
        draw_panels(options.output, run.case.get("title", ""), "time [s]", history_panels(table))
    else:
        draw_probe(options, run)
    return say(options.output)


def read_numbers(path: Path, first: str) -> Table:
    """Columns of a table by name; first: the name of its first one. A last line that is not whole is left out. Raises
    PictureError with path and line."""
    try:
        lines = path.read_text(errors="replace").split("\n")[:-1]
    except OSError as error:
        raise PictureError(f"{path}: {error.strerror}") from None
    names = lines[0].split(",") if lines else []
    if names[:1] != [first]:
        raise PictureError(f"{path}:1: expected a header, {first},…, found '{','.join(names):.80}'")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        try:
            rows.append([float(word or "nan") for word in line.split(",")])
        except ValueError:
            rows.append([])
        if len(rows[-1]) != len(names):
            raise PictureError(f"{path}:{number}: expected {len(names)} numbers, found '{line:.80}'")
    return dict(zip(names, np.array(rows).reshape(-1, len(names)).T, strict=True))


def history_panels(table: Table) -> list[Panel]:
    """Of history.csv."""
    shown = [
        ("iterations", "", {"": "iterations"}),
        ("kinetic energy", "J", {"": "kinetic_energy"}),
        ("potential energy", "J", {"": "potential_energy"}),
        ("extent", "m", {"front x": "front_x", "top": "top"}),
        ("largest speed", "m/s", {"": "max_speed"}),
        ("mass in and out", "kg", {"in": "inflow_mass", "out": "outflow_mass"}),
    ]
    t = table["time"]
    return [
        Panel(label, unit, [(name, t, table[column]) for name, column in columns.items()])
        for label, unit, columns in shown
        if all(column in table for column in columns.values())
    ]


def draw_probe(options: Namespace, run: RunFiles) -> None:
    """A line's profiles at some times, a plane at its last time, of all others the curves over time."""
    probe = next((one for one in run.case.get("probe", []) if one["name"] == options.probe), None)
    if probe is None:
        raise PictureError(f"--probe {options.probe}: the case has no such probe")
    table = read_numbers(run.path / "probes" / f"{options.probe}.csv", "time")
    if not len(table["time"]):
        raise PictureError(f"probe '{options.probe}' has read nothing yet")
    case_title = run.case.get("title", "")
    title = f"{case_title}: {options.probe}" if case_title else options.probe
    if probe["type"] == "plane":
        last = blocks_of(table["time"])[-1]
        draw_plane_of(options, title, probe, {name: column[last] for name, column in table.items()})
    elif probe["type"] == "line":
        draw_panels(options.output, title, "distance [m]", probe_panels(table, profiles_of(table)))
    else:
        draw_panels(options.output, title, "time [s]", probe_panels(table, [("", "time", slice(None))]))


def blocks_of(time: Floats) -> list[slice]:
    """Slices of rows of one time each, as many as the first one has; a last one with fewer is not whole yet."""
    starts = np.flatnonzero(np.diff(time, prepend=-np.inf))
    size = starts[1] if len(starts) > 1 else len(time)
    return [slice(start, start + size) for start in starts if start + size <= len(time)]


def profiles_of(table: Table) -> list[Part]:
    """Name, column of the x axis and rows of some times, the last one among them."""
    blocks = blocks_of(table["time"])
    count = min(len(blocks), most_profiles)
    some = [blocks[len(blocks) * k // count - 1] for k in range(1, count + 1)]
    return [(f"{table['time'][block.start]:.3g} s", "distance", block) for block in some]


def probe_panels(table: Table, parts: Sequence[Part]) -> list[Panel]:
    """A panel for each quantity, with curves of its components at each of the parts."""
    panels: dict[str, Panel] = {}
    for column in table:
        if column in ("time", "distance", "x", "y", "z"):
            continue
        quantity, component = (column[:-2], column[-1]) if column[-2:] in ("_x", "_y", "_z") else (column, "")
        panel = panels.setdefault(quantity, Panel(quantity.replace("_", " "), unit_of(quantity), []))
        for name, x, rows in parts:
            panel.curves.append((", ".join(filter(None, (component, name))), table[x][rows], table[column][rows]))
    return list(panels.values())


def draw_plane_of(options: Namespace, title: str, probe: Mapping[str, Any], rows: Table) -> None:
    """rows: columns of the table at the last time."""
    speed = np.sqrt(sum(rows[name] ** 2 for name in rows if name.startswith("velocity_")))
    viscosity = np.log10(rows.get("dynamic_viscosity", np.nan))
    known = {"speed": (speed, "speed [m/s]"), "dynamic_viscosity": (viscosity, "log10 of viscosity / Pa s")}
    units = {"pressure": "Pa", "temperature": "K", "shear_rate": "1/s"}
    known |= {name: (rows[name], f"{name.replace('_', ' ')} [{unit}]") for name, unit in units.items() if name in rows}
    if options.field not in known or (options.field == "dynamic_viscosity" and options.field not in rows):
        raise PictureError(f"--field {options.field}: probe '{options.probe}' has not read it")
    values, label = known[options.field]
    values = np.where(np.isfinite(rows["pressure"]), values, np.nan)
    if not np.isfinite(values).any():
        raise PictureError(f"no fluid is in the plane at t = {rows['time'][0]:g} s")
    way = np.column_stack([rows[axis] for axis in "xyz" if axis in rows])
    way = way - np.array(probe["corner"], float)
    across, up = (way @ side / np.linalg.norm(side) for side in (np.array(probe["along"]), np.array(probe["up"])))
    columns = int(np.count_nonzero(np.isclose(up, up[0], rtol=0, atol=1e-9 * np.linalg.norm(probe["up"]))))
    grid = [column.reshape(-1, columns) for column in (across, up, values)]
    least = 0 if options.field in ("speed", "shear_rate") else None
    draw_plane(options.output, title, f"t = {rows['time'][0]:.4g} s", grid, label, least)


def residuals_of(directory: Path) -> list[tuple[str, list[float]]]:
    """Name, text and residuals of each solver that treacle convergence has compared. Raises PictureError."""
    curves: dict[str, tuple[str, list[float]]] = {}
    try:
        with open(directory / "solvers.csv", newline="") as file:
            for row in csv.DictReader(file):
                outcome = "" if row["outcome"] == "converged" else f" ({row['outcome']})"
                count, solve, setup = int(row["iterations"]), float(row["solve_s"]), float(row["setup_s"])
                text = (
                    f"{row['solver']}: {count} iteration{'' if count == 1 else 's'}{outcome}, {1e3 * solve:.3g} ms and "
                    f"{1e3 * setup:.3g} ms of set-up"
                )
                curves[row["solver"]] = (text, [])
        with open(directory / "convergence.csv", newline="") as file:
            for row in csv.DictReader(file):
                curves[row["solver"]][1].append(float(row["relative_residual"]))
    except OSError as error:
        raise PictureError(f"{error.filename}: {error.strerror}") from None
    except (KeyError, TypeError, ValueError) as error:
        raise PictureError(f"{directory}: not the tables of treacle convergence ({error!r})") from None
    if not curves:
        raise PictureError(f"{directory / 'solvers.csv'}: no solver to draw a curve of")
    return list(curves.values())

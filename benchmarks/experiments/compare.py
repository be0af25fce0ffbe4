#!/usr/bin/env python3
"""benchmarks/experiments/compare.py run NAME [--resolution N] [--case CASE] [--program P] [--backend cpu|cuda|auto] [--out DIR]
    [--check TEXT]
benchmarks/experiments/compare.py draw NAME... [--out DIR] [--record FILE] [--images DIR]
benchmarks/experiments/compare.py table [--record FILE]

Compares treacle with laboratory experiments: docs/experiments.md. A folder beside this file has the cases of an experiment, case.toml or
case-CASE.toml; measured.csv, which has in each line a number to compare, the error of the experiment and the largest deviation that is
allowed, all in one unit; and measured curves, curve.csv or curve-CASE.csv. `run` runs the cases into DIR/NAME; `draw` measures all runs
there, draws them beside the measured curve, and puts the numbers into the record; `table` prints the record as Markdown.
`run --set KEY=VALUE` changes a key. `run --check TEXT` ends with exit code 1 if a number whose name contains TEXT, and which is within what
is allowed in the record, no longer is.
Needs Python 3.11, NumPy, and Matplotlib to draw."""

import argparse
import csv
import json
import sys
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from treacle_data import Run, json_text, read_table, run_case
from treacle_figure import figure

here = Path(__file__).resolve().parent
root = here.parents[1]


@dataclass
class Experiment:
    """measure takes a Run and returns the numbers that it has, by their names in measured.csv, and a curve (x, y). settings takes the
    written case and the resolution and returns the overrides that must be computed."""

    title: str
    source: str
    x_label: str
    y_label: str
    measure: Callable
    settings: Callable = lambda case, resolution: []


def rows_of(path):
    """The lines of a CSV file after its comments, as dictionaries."""
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def curve_of(path):
    """The two columns of a curve, or none where there is no such file."""
    return np.array([[float(v) for v in row.values()] for row in rows_of(path)]).T if path.exists() else None


def case_of(run):
    return tomllib.loads((run.path / "case.toml").read_text())


def probe(run, name, column):
    table = read_table(run.path / "probes" / f"{name}.csv")
    return table["time"], table[column]


def spacing(run):
    """Distance of the particles at the start [m]; the case file of a run has its resolution."""
    case = case_of(run)
    return case["spacing"] / case.get("resolution", 1)


def at_rest(t, width):
    """Width of a Bingham fluid at rest, which it approaches like 1/t: L of a fit L - C/t to the second half of the run."""
    late = t > t[-1] / 2
    return np.polyfit(1 / t[late], width[late], 1)[1]


def rim(frame, step):
    """Radius of a round heap: the mean over 24 directions of the farthest particle, and half a spacing."""
    x, y = frame.position[:, 0], frame.position[:, 1]
    sector = ((np.arctan2(y, x) + np.pi) / (2 * np.pi) * 24).astype(int) % 24
    return np.mean([np.hypot(x, y)[sector == k].max() for k in range(24)]) + step / 2


def rims(run):
    """Times and radii of the frames that have fluid all around [mm]."""
    step, found = spacing(run), []
    for frame in run.frames():
        if len(frame.position) > 500:
            found.append((frame.time, 1e3 * rim(frame, step)))
    return np.transpose(found)


def lcpc_box(run):
    """The depth is the mean from 20 to 60 mm from the end wall in the middle half of the channel, without the layer on the walls."""
    t, spread = probe(run, "spread", "height")
    x, y = run.frame().position[:, :2].T
    depth = np.count_nonzero((x > 0.02) & (x < 0.06) & (abs(y) < 0.05)) * spacing(run) ** 3 / (0.04 * 0.1)
    return {"spread [mm]": 1e3 * at_rest(t, spread), "depth at 40 mm [mm]": 1e3 * depth}, (t, 1e3 * spread)


def mini_cone(run):
    t, radius = rims(run)
    return {"radius at rest [mm]": at_rest(t, radius)}, (t, radius)


def abrams_cone(run):
    t, top = probe(run, "top", "height")
    return {"slump [mm]": 300 - 1e3 * top[-1]}, (t, 300 - 1e3 * top)


def ball_on_lattice(case, resolution):
    """Puts the ball on the point of the fluid's lattice that is nearest to it, so that as many particles of fluid are missing as it has,
    and gives it the mass with which its weight in the fluid is that of the true ball: the fluid carries its particles."""
    step = case["spacing"] / resolution
    ball = next(b for b in case["body"] if b["name"] == "sphere")
    density = {m["name"]: m["density"] for m in case["material"]}
    oil = next(b for b in case["body"] if b["name"] == "oil")
    # The lattice of a box begins half a spacing inside its corner, that of a cylinder on its axis, half a spacing from its start.
    first = np.array(oil["min"]) + step / 2 if oil["shape"] == "box" else np.array(oil["start"]) + [0, 0, step / 2]
    center = first + step * np.rint((np.array(ball["center"]) - first) / step)
    k2 = (step * np.arange(-40, 41)) ** 2
    radius = ball["radius"] + 1e-6
    own = (k2[:, None, None] + k2[:, None] + k2 <= radius**2).sum() * step**3
    heavier = density[ball["material"]] - density["oil"]
    distance = " + ".join(f"({axis} - {x:.9g})^2" for axis, x in zip("xyz", center, strict=True))
    return [
        f"body.sphere.center=[{', '.join(f'{x:.9g}' for x in center)}]",
        f"body.oil.where='{distance} > {radius:.9g}^2'",
        f"body.sphere.mass={heavier * 4 / 3 * np.pi * ball['radius'] ** 3 + density['oil'] * own}",
    ]


def settling_sphere(run):
    """The first 0.2 s are left out: the oil is compressed by its own weight then, and takes the sphere along."""
    t, speed = run.rigid_bodies["time"], -1e3 * run.rigid_bodies["sphere_velocity_z"]
    return {"largest speed [mm/s]": speed[t > 0.2].max()}, (t, speed)


def sphere_in_tube(run):
    t, speed = run.rigid_bodies["time"], -run.rigid_bodies["sphere_velocity_z"]
    case = case_of(run)
    ball = next(b for b in case["body"] if b["name"] == "sphere")
    free = 2 / 9 * (7850 - 1000) * 9.81 * ball["radius"] ** 2 / 10
    return {"drag factor": free / speed[t > t[-1] / 2].mean()}, (t, 1e3 * speed)


def xanthan_current(run):
    t, radius = rims(run)
    found = {f"radius at {s} s [mm]": np.interp(s, t, radius) for s in (10, 20, 50, 100) if t[-1] > s - 0.1}
    return found, (t, radius)


def extrudate_swell(run):
    """The swell at the end of the run, from the mean area of the jet three to six radii below the end of the tube."""
    step, found = spacing(run), []
    for frame in run.frames():
        z = frame.position[:, 2]
        if z.min() < -0.024:
            area = np.count_nonzero((z < -0.012) & (z > -0.024)) * step**3 / 0.012
            found.append((frame.time, np.sqrt(area / np.pi) / 0.004))
    t, swell = np.transpose(found)
    return {"swell": swell[-1]}, (t, swell)


def martin_moyce(run):
    width, rate = 0.05715, np.sqrt(9.81 / 0.05715)
    history = run.history
    t, front = history["time"], (history["front_x"] + spacing(run) / 2) / width
    top_t, top = probe(run, "top", "height")
    values = {f"front at T = {s:.2f}": np.interp(s, t * rate * np.sqrt(2), front) for s in (1.19, 1.98, 2.65, 3.33)}
    values |= {f"height at tau = {s:.2f}": np.interp(s, top_t * rate, top / (2 * width)) for s in (0.93, 2.00, 3.06)}
    before = t * rate * np.sqrt(2) < 3.5
    return values, (t[before] * rate * np.sqrt(2), front[before])


def kleefsman(run):
    values = {}
    for name in ("H2", "H4", "P1", "P2"):
        column, scale, unit = ("height", 1e3, "mm") if name[0] == "H" else ("pressure", 1, "Pa")
        t, found = probe(run, name, column)
        for s, label in ((0.5, "0.5 s"), (1.0, "1 s")):
            values[f"{name} at {label} [{unit}]"] = scale * np.nanmean(found[abs(t - s) < 0.0101])
    values["largest P2 [Pa]"] = np.nanmax(found[t < 0.55])
    t, height = probe(run, "H4", "height")
    return values, (t, 1e3 * height)


def spheric_10(run):
    """The largest mean over 5 ms of the pressure on the sensor in the first impact, until 3.2 s."""
    t, force = probe(run, "sensor", "force_x")
    pressure = -force / 0.012
    grid = np.arange(0.0025, t[-1], 5e-4)
    impulse = np.concatenate([[0], np.cumsum(np.diff(t) * pressure[1:])])
    mean = (np.interp(grid + 0.0025, t, impulse) - np.interp(grid - 0.0025, t, impulse)) / 0.005
    return {"first peak [Pa]": mean[grid < 3.2].max()}, (grid, mean)


experiments = {
    "lcpc-box": Experiment("LCPC box", "Roussel 2007", "t [s]", "front [mm]", lcpc_box),
    "mini-cone": Experiment("Mini cone", "Roussel & Coussot 2005", "t [s]", "radius [mm]", mini_cone),
    "abrams-cone": Experiment("Abrams' cone", "Ferraris & de Larrard 1998", "t [s]", "slump [mm]", abrams_cone),
    "settling-sphere": Experiment("Sphere in a box", "ten Cate et al. 2002", "t [s]", "speed [mm/s]", settling_sphere, ball_on_lattice),
    "sphere-in-tube": Experiment("Ball in a tube", "Haberman & Sayre 1958", "t [s]", "speed [mm/s]", sphere_in_tube, ball_on_lattice),
    "xanthan-current": Experiment("Current of xanthan gum", "Sayag & Worster 2013", "t [s]", "radius [mm]", xanthan_current),
    "extrudate-swell": Experiment("Swell of a Newtonian extrudate", "Middleman & Gavis 1961", "t [s]", "jet over tube", extrudate_swell),
    "martin-moyce": Experiment("Dam break of Martin and Moyce", "Martin & Moyce 1952", "T", "front over width", martin_moyce),
    "kleefsman": Experiment("SPHERIC test 2", "Kleefsman et al. 2005", "t [s]", "H4 [mm]", kleefsman),
    "spheric-10": Experiment("SPHERIC test 10", "Botia-Vera et al. 2010", "t [s]", "pressure on the sensor [Pa]", spheric_10),
}


def case_files(name):
    """Label of a case, empty where there is one only, to its file."""
    return {path.stem.removeprefix("case").removeprefix("-"): path for path in sorted((here / name).glob("case*.toml"))}


def whole_case(path):
    """A case file on top of its bases, as far as ball_on_lattice needs it."""
    case = tomllib.loads(path.read_text())
    if "base" not in case:
        return case
    base = whole_case(path.parent / case["base"])
    for kind in ("material", "body"):
        entries = {e["name"]: e for e in base[kind]}
        for entry in case.get(kind, []):
            entries[entry["name"]] = entries.get(entry["name"], {}) | entry
        base[kind] = list(entries.values())
    return base


def lost(options, label, values):
    """The numbers to check that the record has within what is allowed at this resolution and that these values have not."""
    wanted = (options.name, label, float(options.resolution), True)
    met = [e for e in json.loads(options.record.read_text())
           if (e["experiment"], e["case"], e["resolution"], e["met"]) == wanted and options.check in e["quantity"]]
    if not met:
        sys.exit(f"{options.record}: no '{options.check}' of {options.name} {label}, resolution {options.resolution}, is as allowed")
    return [e["quantity"] for e in met if not abs(values.get(e["quantity"], np.nan) - e["measured"]) <= e["asked"]]


def run(options):
    experiment, failed = experiments[options.name], False
    for label, path in case_files(options.name).items():
        if options.case not in (None, label):
            continue
        settings = [f"resolution={options.resolution}", *options.set, *experiment.settings(whole_case(path), float(options.resolution))]
        words = ["--backend", options.backend] + (["--threads", options.threads] if options.threads else [])
        directory = options.out / options.name / f"{path.stem}-r{options.resolution}"
        directory.parent.mkdir(parents=True, exist_ok=True)
        done = run_case(options.program, path, directory, settings, words)
        values = experiment.measure(done)[0]
        print(f"{directory}: {done.seconds:.0f} s", *(f"{key}: {value:.4g}" for key, value in values.items()), sep="\n  ")
        for quantity in lost(options, label, values) if options.check is not None else []:
            failed = True
            print(f"  {quantity} is no longer within what is allowed")
    sys.exit(failed)


def runs_of(options, name):
    """Case, resolution and Run of all finished runs of an experiment, coarse ones first."""
    found = []
    for path in (options.out / name).glob("case*-r*"):
        if (path / "summary.json").exists() and Run(path).summary["status"] == "done":
            stem, _, resolution = path.name.rpartition("-r")
            found.append((stem.removeprefix("case").removeprefix("-"), float(resolution), Run(path)))
    return sorted(found, key=lambda entry: entry[:2])


def draw(options):
    record = json.loads(options.record.read_text()) if options.record.exists() else []
    for name in options.names:
        experiment, measured, runs = experiments[name], rows_of(here / name / "measured.csv"), runs_of(options, name)
        if not runs:
            raise SystemExit(f"no finished run of {name} in {options.out}")
        labels = sorted({label for label, _, _ in runs})
        with figure(options.images / f"experiments-{name}.png", experiment.title, experiment.x_label, experiment.y_label) as axes:
            end = 0.0
            for label, resolution, found in runs:
                values, curve = experiment.measure(found)
                finer = len({r for _, r, _ in runs if r > resolution})
                name_of_run = " ".join([label, f"r{resolution:g}"]).strip()
                axes.plot(*curve, ("-", "--", ":")[min(finer, 2)], color=f"C{labels.index(label)}", linewidth=1.2, label=name_of_run)
                end = max(end, curve[0][-1])
                for row in measured:
                    if row["case"] == label and row["quantity"] in values:
                        entry = entry_of(name, row, resolution, found.summary, values[row["quantity"]])
                        same = ("experiment", "case", "quantity", "resolution")
                        record = [other for other in record if any(other[key] != entry[key] for key in same)] + [entry]
            for label in labels:
                points = curve_of(here / name / (f"curve-{label}.csv" if label else "curve.csv"))
                row = next(row for row in measured if row["case"] == label)
                error = float(row["error"] or 0)
                if points is not None:
                    points = points[:, points[0] < 3 * end]
                    bars = error if row["quantity"].endswith(experiment.y_label[-5:]) else 0
                    axes.errorbar(*points, yerr=bars or None, fmt="k.", markersize=4, linewidth=0.6, label=f"measured {label}".strip())
                elif name != "sphere-in-tube":
                    value, colour = float(row["value"]), f"C{labels.index(label)}"
                    axes.axhline(value, color=colour, linewidth=0.6, label="reference" if label == labels[-1] else None)
                    axes.axhspan(value - error, value + error, color=colour, alpha=0.15)
    order = list(experiments)
    record.sort(key=lambda e: (order.index(e["experiment"]), e["case"], e["resolution"]))
    options.record.parent.mkdir(parents=True, exist_ok=True)
    options.record.write_text(json_text(record))


def entry_of(name, row, resolution, summary, value):
    number = {key: float(row[key]) if row[key] else None for key in ("value", "error", "asked")}
    off = value - number["value"]
    return {"experiment": name, "case": row["case"], "quantity": row["quantity"], "resolution": resolution,
            "commit": summary["commit"], "backend": summary["backend"], "device": summary["device"],
            "particles": summary["fluid_particles"], "steps": summary["steps"], "seconds": round(summary["wall_seconds"], 1),
            "measured": number["value"], "error": number["error"], "asked": number["asked"], "treacle": float(f"{value:.5g}"),
            "deviation": float(f"{off / number['value']:.3g}"), "met": bool(abs(off) <= number["asked"])}


def table(options):
    """One line for each number: the experiment, its error, treacle at each resolution, bold where it misses, and what is asked."""
    lines: dict = {}
    for e in json.loads(options.record.read_text()):
        lines.setdefault((e["experiment"], e["case"], e["quantity"]), []).append(e)
    print("| experiment | source | compared | measured | its error | treacle | allowed |\n|---|---|---|---|---|---|---|")
    for (name, case, quantity), found in lines.items():
        one = found[0]

        def percent(share, sign="+"):
            return f"{100 * share:{sign}.1f} %" if abs(share) < 0.1 else f"{100 * share:{sign}.0f} %"

        cells = [f"r{e['resolution']:g} {e['treacle']:.4g} ({percent(e['deviation'])})" for e in found]
        cells = [cell if e["met"] else f"**{cell}**" for cell, e in zip(cells, found, strict=True)]
        error = percent(one["error"] / one["measured"], "") if one["error"] else "not known"
        print(f"| [{name}{' ' + case if case else ''}](#{name})", experiments[name].source, quantity, f"{one['measured']:g}", error,
              ", ".join(cells), percent(one["asked"] / one["measured"], "") + " |", sep=" | ")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--out", type=Path, default=root / "build" / "experiments")
    common.add_argument("--record", type=Path, default=root / "benchmarks" / "results" / "experiments.json")
    common.add_argument("--images", type=Path, default=root / "docs" / "images")
    one = commands.add_parser("run", parents=[common])
    one.add_argument("name", choices=experiments)
    one.add_argument("--resolution", default="1")
    one.add_argument("--case")
    one.add_argument("--program", default=root / "build" / "release" / "bin" / "treacle")
    one.add_argument("--backend", choices=["auto", "cpu", "cuda"], default="auto")
    one.add_argument("--threads")
    one.add_argument("--set", action="append", default=[])
    one.add_argument("--check")
    one.set_defaults(do=run)
    some = commands.add_parser("draw", parents=[common])
    some.add_argument("names", nargs="+", choices=experiments)
    some.set_defaults(do=draw)
    commands.add_parser("table", parents=[common]).set_defaults(do=table)
    options = parser.parse_args()
    options.do(options)


if __name__ == "__main__":
    main()

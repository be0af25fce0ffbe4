#!/usr/bin/env python3
"""Validation studies of treacle: runs cases with exact or published solutions and measures the errors.

    validate.py --program build/release/bin/treacle couette            # the coarse level, against its bars
    validate.py --program ... --levels 2 couette                       # and the next one, against orders (as ctest does)
    validate.py --program ... --scheme published couette               # by another scheme
    validate.py --program ... --all-levels --record record.json        # every study, every level
    validate.py --report RECORD...                                     # tables and pictures of docs/validation*.md
    validate.py --check RECORD...                                      # whether these pages hold the tables of these

Exit codes: 0 all bars and orders are met, 1 one is not, 2 bad input, 3 a run failed.
"""

import argparse
import importlib
import json
import sys
import tempfile
from pathlib import Path

here = Path(__file__).resolve().parent
sys.path[:0] = [str(here), str(here.parents[1] / "scripts")]

import treacle_data  # noqa: E402
from study import order, scheme_in, small  # noqa: E402

names = sorted(file.stem for file in (here / "studies").glob("*.py") if not file.stem.startswith("_"))


def load(name):
    return importlib.import_module("studies." + name).study


def thinned(curves, most=200):
    """As lists, of at most so many points."""
    result = {}
    for name, (x, y) in curves.items():
        step = max(1, -(-len(x) // most))
        result[name] = [[float(f"{v:.6g}") for v in values[::step]] for values in (x, y)]
    return result


def run_level(study, level, options, directory):
    words = ["--backend", options.backend] + (["--threads", str(options.threads)] if options.threads else [])
    settings = [f"resolution={level.resolution}", *study.settings, *level.settings]
    if options.scheme:
        settings.append(f"method.scheme={options.scheme}")
    overrides = [word for setting in settings for word in ("--set", setting)]
    scheme = scheme_in(treacle_data.call([options.program, "check", study.case_file, *overrides]))
    run = treacle_data.run_case(options.program, study.case_file, directory, settings, words)
    outcome = study.measure(run)
    return {
        "level": level.label,
        "scheme": scheme,
        "size": study.size(level),
        "particles": run.summary["fluid_particles"],
        "steps": run.summary["steps"],
        "iterations": run.summary["iterations"]["mean"],
        "seconds": round(run.seconds, 2),
        "backend": run.summary["backend"],
        "device": run.summary["device"],
        "commit": run.summary["commit"],
        "errors": {name: float(value) for name, value in outcome.errors.items()},
        "values": {name: float(value) for name, value in outcome.values.items()},
        "curves": thinned(outcome.curves),
        "exact": thinned(outcome.exact),
    }


def print_level(study, row, last, number):
    """One block of lines; returns whether all is met that the level of this number is judged by: bars and ranges the first, orders and
    bars the second, nothing the others."""
    print(f"{study.name} {row['level']}: {row['particles']} particles, {row['steps']} steps, "
          f"{row['iterations']:.1f} iterations, {row['seconds']} s ({row['backend']}), scheme {row['scheme']}")
    orders = study.orders_of(row["scheme"]) if number == 1 else {}
    bars = study.bars_of(row["scheme"]) if number == 0 or orders else {}
    ranges = study.ranges_of(row["scheme"]) if number == 0 else {}
    good = ranges is not None
    if not good:
        print(f"  ranges of the scheme {row['scheme']}: the study has none, NOT MET")
        ranges = {}
    missing = sorted(((set(bars) | set(orders)) - set(row["errors"])) | (set(ranges) - set(row["values"])))
    for name in missing:
        print(f"  {name}: not measured, NOT MET")
    good = good and not missing
    for name, error in row["errors"].items():
        text = f"  error {name}: {error:.3e}"
        p = order(last["errors"][name], error, last["size"], row["size"]) if last and study.refined else None
        if p is not None:
            text += f", order {p:.2f}"
        if name in orders:
            met = error < small or (p is not None and p >= orders[name])
            good = good and met
            text += f", at least {orders[name]:g} down to {small:g}: {'met' if met else 'NOT MET'}"
        if name in bars:
            met = error <= bars[name]  # false for what is not a number
            good = good and met
            text += f", bar {bars[name]:g}: {'met' if met else 'NOT MET'}"
        print(text)
    for name, value in row["values"].items():
        text = f"  {name}: {value:.6g}"
        if name in ranges:
            low, high = ranges[name]
            met = low <= value <= high
            good = good and met
            text += f", range {low:g} to {high:g} of {row['scheme']}: {'met' if met else 'NOT MET'}"
        print(text)
    sys.stdout.flush()
    return good


def run_study(study, options, scratch):
    rows: list[dict] = []
    good = True
    for number, level in enumerate(study.levels if options.all_levels else study.levels[: options.levels]):
        row = run_level(study, level, options, scratch / f"{study.name}-{number}")
        good = print_level(study, row, rows[-1] if rows else None, number) and good
        rows.append(row)
    return rows, good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", metavar="STUDY", help="; ".join(names) + "; all without one")
    parser.add_argument("--program", type=lambda p: Path(p).absolute(), help="the command treacle")
    parser.add_argument("--backend", default="auto", choices=["auto", "cpu", "cuda"])
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--scheme", choices=["published", "accurate"], help="of MPH-I, instead of that of the case")
    parser.add_argument("--levels", type=int, default=1, metavar="N", help="how many, from the coarsest on (1)")
    parser.add_argument("--all-levels", action="store_true")
    parser.add_argument("--record", type=Path, help="JSON file that the results of these studies are put into")
    parser.add_argument("--keep", type=Path, help="folder for the run directories, which are deleted otherwise")
    parser.add_argument("--report", type=Path, nargs="+", metavar="RECORD", help="writes tables and pictures from records")
    parser.add_argument("--check", type=Path, nargs="+", metavar="RECORD", help="compares the page's tables with records")
    options = parser.parse_args()
    if unknown := set(options.studies) - set(names):
        parser.error(f"unknown study {', '.join(sorted(unknown))}; expected {', '.join(names)}")
    if files := options.report or options.check:
        import report
        act = report.write if options.report else report.check
        return act([json.loads(file.read_text()) for file in files], [load(name) for name in names])
    if not options.program:
        parser.error("--program is required")

    record = json.loads(options.record.read_text()) if options.record and options.record.exists() else {}
    good = True
    with tempfile.TemporaryDirectory() as scratch:
        for name in options.studies or names:
            rows, met = run_study(load(name), options, options.keep or Path(scratch))
            record[name] = rows
            good = good and met
            if options.record:  # after each, so that a later failure loses nothing
                options.record.write_text(treacle_data.json_text(record))
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except treacle_data.RunFailed as failure:
        print(f"validate: {failure}", file=sys.stderr)
        sys.exit(3)

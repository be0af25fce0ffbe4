#!/usr/bin/env python3
"""Reproduces the tables and figures of [K23] and [O23] with treacle.

    reproduce.py --list
    reproduce.py --program treacle --backend cuda --out DIR --portion 2      # one of the portions of under ten minutes on an H200
    reproduce.py --program treacle --out DIR k23-fig3 o23-fig7               # single items
    reproduce.py --program build/release/bin/treacle --out DIR --quick --all # tries everything with small cases
    reproduce.py --draw DIR                                                  # tables and pictures again from what was measured
    reproduce.py --collect DIR... --record RECORD.json                       # one record of several folders
    reproduce.py --report RECORD.json                                        # docs/reproduction.md

Every item leaves ITEM.csv, ITEM.json and, with matplotlib, ITEM.png in DIR; measurements are kept in DIR/measurements and made
once. Needs Python 3.11 and NumPy. Exit codes: 0 done, 2 bad input, 3 a measurement failed (the others were made), 4 out of time.
"""

import argparse
import json
import math
import sys
import time
from pathlib import Path

here = Path(__file__).resolve().parent
root = here.parents[1]
sys.dont_write_bytecode = True  # nothing is left beside the scripts
sys.path[:0] = [str(here), str(root / "scripts")]

from measure import Laboratory  # noqa: E402
from plan import estimate, in_order, items, needed, portion_of, portions  # noqa: E402
from record import collect, pictures, write_items  # noqa: E402
from report import page  # noqa: E402
from spec import Results  # noqa: E402


def show_list():
    for item in items.values():
        where = sorted({portion_of(spec) for spec in item.needs})
        print(f"{item.name:12} {item.title}  (portion {', '.join(map(str, where))})")
    specs = needed(items)
    for number, title in portions.items():
        mine = [spec for spec in specs if portion_of(spec) == number]
        print(f"portion {number}: {title}; {len(mine)} measurements, about {sum(map(estimate, mine)):.0f} s on an H200")


def measure(options, names):
    """Returns an exit code."""
    largest = dict.fromkeys(("2d", "small", "3d", "isph"), options.largest)
    if options.quick:
        largest = {"2d": 1600, "3d": 1000, "isph": 58621}
    isph_end = 0.02 if options.quick else math.inf
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    laboratory = Laboratory(
        options.program,
        options.backend,
        out,
        (options.runs or out / "runs").resolve(),
        options.cases,
        options.threads,
        largest,
        isph_end,
        options.quick,
    )
    specs = [s for s in needed(names) if options.portion in (None, portion_of(s))]
    specs = [s for s in specs if not laboratory.has(s)]
    specs = in_order(dict.fromkeys(laboratory.states_for(specs) + specs))
    expected = sum(map(estimate, specs))
    print(f"{len(specs)} measurements, about {expected:.0f} s on an H200 with 16 processors", flush=True)
    start, good = time.monotonic(), True
    for number, spec in enumerate(specs):
        left = options.stop_after - (time.monotonic() - start)
        if left < estimate(spec):
            print(f"reproduce: out of time, {len(specs) - number} measurements are left", file=sys.stderr)
            return 4
        good = laboratory.measure(spec) and good
    print(f"measured in {time.monotonic() - start:.0f} s, expected {expected:.0f} s", flush=True)
    return 0 if good else 3


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("items", nargs="*", metavar="ITEM", help="see --list")
    parser.add_argument("--list", action="store_true", help="items and portions")
    parser.add_argument("--program", default="treacle", help="the command treacle")
    parser.add_argument("--backend", default="auto", choices=["auto", "cpu", "cuda"], help="of what the papers ran on a GPU")
    parser.add_argument("--threads", type=int, default=0, help="of runs that do not vary them")
    parser.add_argument("--out", type=Path, metavar="DIR")
    parser.add_argument("--runs", type=Path, metavar="DIR", help="run directories with checkpoints; default: OUT/runs")
    parser.add_argument("--cases", type=Path, default=root / "cases", metavar="DIR")
    parser.add_argument("--portion", type=int, choices=list(portions), help="only what belongs to it")
    parser.add_argument("--all", action="store_true", help="all items")
    parser.add_argument(
        "--largest", type=float, default=math.inf, metavar="N", help="leaves out cases of more fluid particles"
    )
    parser.add_argument("--quick", action="store_true", help="small cases, short times: a trial, and marked as such")
    parser.add_argument("--stop-after", type=float, default=math.inf, metavar="S", help="begins nothing that ends later [s]")
    parser.add_argument("--draw", type=Path, metavar="DIR")
    parser.add_argument("--collect", type=Path, nargs="+", metavar="DIR")
    parser.add_argument("--record", type=Path, metavar="FILE")
    parser.add_argument("--report", type=Path, metavar="RECORD")
    parser.add_argument("--docs", type=Path, default=root / "docs", metavar="DIR", help="where the page goes")
    options = parser.parse_args()
    if unknown := set(options.items) - set(items):
        parser.error(f"unknown item {', '.join(sorted(unknown))}; --list names them")
    if options.collect and not options.record:
        parser.error("--collect needs --record")
    if not (options.list or options.draw or options.collect or options.report):
        if not options.out:
            parser.error("--out is required")
        if not (options.items or options.portion or options.all):
            parser.error("nothing to do: expected items, --portion or --all")
    return options


def main():
    options = arguments()
    if options.list:
        show_list()
    elif options.draw:
        write_items(options.draw, options.items or items)
    elif options.collect:
        collect(options.collect, options.record)
        pictures(options.collect, options.docs)
    elif options.report:
        record = json.loads(options.report.read_text())
        page(record, Results(record["measurements"]), options.docs)
        print(options.docs / "reproduction.md")
    else:
        names = options.items or [
            n for n, item in items.items() if options.all or any(portion_of(s) == options.portion for s in item.needs)
        ]
        code = measure(options, names)
        write_items(options.out, names)
        return code
    return 0


if __name__ == "__main__":
    sys.exit(main())

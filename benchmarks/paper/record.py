"""Writes what items came to, and gathers measurements into one record."""

import csv
import shutil

from draw import draw
from plan import items, portion_of, portions
from report import judged, machines, notes, used
from spec import Results
from treacle_data import json_text


def write_item(item, results, out):
    rows = item.rows(results)
    plot = item.plot(rows, results) if item.plot else None
    if plot and plot.curves:
        draw(item, plot, out / f"{item.name}.png")
    if rows:
        columns = list(dict.fromkeys(name for row in rows for name in row))
        with open(out / f"{item.name}.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    measured = used(item, results)
    told = {
        "item": item.name,
        "title": item.title,
        "claim": item.claim,
        "rows": rows,
        "reading": item.reading(rows, results),
        "notes": notes(item, results),
        "machines": machines(item, results),
        "commits": sorted({m["commit"] for m in measured if "commit" in m}),
        "versions": sorted({m["version"] for m in measured if "version" in m}),
        "seconds": round(sum(m["wall_seconds"] for m in measured), 2),
        "quick": any(m.get("quick") for m in measured),
    }
    (out / f"{item.name}.json").write_text(json_text(told))
    return told


def write_items(folder, names):
    results = Results.load([folder])
    for name in names:
        told = write_item(items[name], results, folder)
        print(f"{name}: {len(told['rows'])} rows, {told['seconds']:.0f} s of measurements")
        for sentence in told["reading"]:
            print(f"  {sentence}")


def collect(folders, record):
    results = Results.load(folders)
    made = {}
    for item in items.values():
        for spec in item.needs:
            if found := results.all.get(spec.key):
                made[spec.key] = (portion_of(spec), found)
    seconds = {k: round(sum(m["wall_seconds"] for p, m in made.values() if p == k), 1) for k in portions}
    every = [m for _, m in made.values()]
    about = {
        "commits": sorted({m["commit"] for m in every if "commit" in m}),
        "versions": sorted({m["version"] for m in every if "version" in m}),
        "devices": sorted({m["device"] for m in every if "device" in m}),
        "portion_seconds": {k: v for k, v in seconds.items() if v},
        "quick": any(m.get("quick") for m in every),
    }
    content = {"about": about, "measurements": results.all, "statements": judged(results)}
    record.write_text(json_text(content))
    print(f"{record}: {len(results.all)} measurements")


def pictures(folders, docs):
    """Those that treacle drew: a record does not hold them."""
    for folder in folders:
        for path in folder.glob("k23-fig12.png"):
            (docs / "images").mkdir(parents=True, exist_ok=True)
            shutil.copy(path, docs / "images" / f"reproduction-{path.name}")

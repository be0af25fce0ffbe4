"""Writes what validate.py measured into docs/validation.md: a table between the marks of each study, and its picture."""

import re
import sys
from pathlib import Path

from study import order
from treacle_figure import figure

root = Path(__file__).resolve().parents[2]
page = root / "docs" / "validation.md"


def number(value):
    return f"{value:.3g}" if abs(value) < 1e4 else f"{value:.0f}"


def table(study, rows):
    """Markdown: a line per level, errors with their observed orders, then measured values."""
    errors, values = list(rows[0]["errors"]), list(rows[0]["values"])
    head = ["level", "particles", "steps", "iterations"]
    for name in errors:
        head += [f"{name} error", "order"]
    lines = ["| " + " | ".join(head + values) + " |", "|" + "---|" * (len(head) + len(values))]
    for k, row in enumerate(rows):
        cells = [row["level"], str(row["particles"]), str(row["steps"]), f"{row['iterations']:.1f}"]
        for name in errors:
            error = row["errors"][name]
            before = rows[k - 1] if k else None
            p = order(before["errors"][name], error, before["size"], row["size"]) if before else None
            cells += [number(error), "" if p is None else f"{p:.2f}"]
        cells += [number(row["values"][name]) for name in values]
        lines.append("| " + " | ".join(cells) + " |")
    # Records from before there was another scheme do not say which they are of.
    scheme = "isph" if study.name.startswith("isph-") else rows[0].get("scheme", "published")
    bars = ", ".join(f"{name} {bar:g}" for name, bar in study.bars_of(scheme).items())
    ranges = "; ".join(f"{name} from {low:g} to {high:g}" for name, (low, high) in (study.ranges_of(scheme) or {}).items())
    limits = f"Bars at the first level: {bars}. Scheme {scheme}" + (f": {ranges}" if ranges else "")
    machines = sorted({row["device"] for row in rows})
    lines += ["", f"{limits}. Run on {', '.join(machines)}; commit {rows[0]['commit']}."]
    return "\n".join(lines)


def draw(study, rows, path):
    """The exact curves, and those of the coarsest, a middle and the finest level."""
    shown = rows if len(rows) <= 3 else [rows[0], rows[len(rows) // 2], rows[-1]]
    with figure(path, study.title, study.x_label, study.y_label) as axes:
        for name, (x, y) in rows[-1]["exact"].items():
            axes.plot(x, y, "k-", linewidth=1, label=name)
        for row, mark in zip(shown, ("o", "s", ".")):
            for k, (name, (x, y)) in enumerate(row["curves"].items()):
                axes.plot(x, y, mark, markersize=3, markerfacecolor="none", color=f"C{k}", alpha=0.8,
                          label=f"{name}, {row['level']}")


def write(record, studies):
    text = page.read_text()
    for study in studies:
        if study.name not in record:
            continue
        rows = record[study.name]
        begin, end = f"<!-- {study.name} -->", f"<!-- end of {study.name} -->"
        if begin not in text or end not in text:
            print(f"report: {page} has no marks {begin} ... {end}", file=sys.stderr)
            return 2
        picture = root / "docs" / "images" / f"validation-{study.name}.png"
        draw(study, rows, picture)
        block = f"{begin}\n{table(study, rows)}\n\n![{study.title}](images/{picture.name})\n{end}"
        text = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: block, text, flags=re.S)
    page.write_text(text)
    return 0

"""Writes what validate.py measured into docs/validation*.md: a table between the marks of each study, all schemes side by side, and its
picture. Needs Matplotlib for the pictures alone."""

import re
import sys
from pathlib import Path

from study import order
from treacle_figure import figure

root = Path(__file__).resolve().parents[2]
pages = sorted((root / "docs").glob("validation*.md"))
schemes = ("accurate", "published", "isph")  # in this order


def page_of(name):
    """The page that has marks for a study, or none."""
    for page in pages:
        if re.search(f"<!-- {name} -->.*<!-- end of {name} -->", page.read_text(), flags=re.S):
            return page
    return None


def named(rows, key):
    return ", ".join(sorted({row[key] for row in rows}))


def number(value, digits=3):
    return f"{value:.{digits}g}" if abs(value) < 1e4 else f"{value:.0f}"


def merged(records):
    """Study to scheme to levels, from several records; the later one wins."""
    result = {}
    for record in records:
        for name, rows in record.items():
            # Records from before there was another scheme do not say which they are of.
            scheme = "isph" if name.startswith("isph-") else rows[0].get("scheme", "published")
            result.setdefault(name, {})[scheme] = rows
    return {name: {s: of[s] for s in schemes if s in of} for name, of in result.items()}


def cells_of(study, rows, kind, name, labels):
    """What a scheme has in the columns of the levels: values, and errors with their observed orders."""
    by_label, cells = {row["level"]: k for k, row in enumerate(rows)}, []
    for label in labels:
        k = by_label.get(label)
        value = None if k is None else rows[k][kind].get(name)
        if value is None:
            cells.append("")
            continue
        cell = number(value, 3 if kind == "errors" else 4)
        if kind == "errors" and study.refined and k > 0:
            p = order(rows[k - 1]["errors"][name], value, rows[k - 1]["size"], rows[k]["size"])
            cell += "" if p is None else f" ({p:.2f})"
        cells.append(cell)
    return cells


def table(study, of):
    """Markdown: columns are levels; a line for each error and each measured value of each scheme. of: scheme to levels."""
    first = next(iter(of.values()))
    labels, schemes_too = [row["level"] for row in max(of.values(), key=len)], len(of) > 1
    lines = []

    def add(name, scheme, cells, bound=""):
        lines.append("| " + " | ".join([name] + [scheme] * schemes_too + cells + [bound]) + " |")

    add("", "scheme", labels, f"bound at {labels[0]}")
    lines.append("|" + "---|" * (2 + schemes_too + len(labels)))
    add("particles", "", [str(row["particles"]) for row in max(of.values(), key=len)])
    for kind in "errors", "values":
        names = dict.fromkeys(name for rows in of.values() for name in rows[0][kind])
        for name in names:
            title = f"error: {name}" if kind == "errors" else name
            for scheme, rows in of.items():
                if name not in rows[0][kind]:
                    continue
                bar, (low, high) = study.bars_of(scheme).get(name), (study.ranges_of(scheme) or {}).get(name, (None, None))
                bound = (f"{bar:g}" if kind == "errors" and bar is not None else
                         f"{low:g} to {high:g}" if kind == "values" and low is not None else "")
                add(title, scheme, cells_of(study, rows, kind, name, labels), bound)
                title = ""
    for scheme, rows in of.items():
        add("" if scheme != next(iter(of)) else "iterations", scheme,
            cells_of(study, [row | {"values": {"iterations": row["iterations"]}} for row in rows], "values", "iterations", labels))
    notes = [f"{scheme}: {named(rows, 'device')}, commit {named(rows, 'commit')}" for scheme, rows in of.items()]
    text = ""
    if "accurate" in of and study.refined and study.orders:
        least = ", ".join(f"{name} {p:g}" for name, p in study.orders.items())
        text = f"Least order from {labels[0]} to {labels[1]}, where it is not 0.9: {least}. "
    return "\n".join(lines + ["", text + "; ".join(notes) + "."])


def draw(study, of, path):
    """The exact curves, those of the coarsest, a middle and the finest level of the first scheme, and the finest of the others."""
    (_, rows), *others = of.items()
    shown = rows if len(rows) <= 3 else [rows[0], rows[len(rows) // 2], rows[-1]]
    with figure(path, study.title, study.x_label, study.y_label) as axes:
        for name, (x, y) in rows[-1]["exact"].items():
            axes.plot(x, y, "k-", linewidth=1, label=name)
        for row, mark in zip(shown, ("o", "s", ".")):
            for k, (name, (x, y)) in enumerate(row["curves"].items()):
                axes.plot(x, y, mark, markersize=3, markerfacecolor="none", color=f"C{k}", alpha=0.8,
                          label=f"{name}, {row['level']}")
        for scheme, found in others:
            for name, (x, y) in found[-1]["curves"].items():
                axes.plot(x, y, "x", markersize=2, color="0.6", zorder=0, label=f"{scheme}: {name}, {found[-1]['level']}")


def blocks(records, studies):
    """Name of a study to what stands between its marks, these included."""
    of = merged(records)
    return {study.name: f"<!-- {study.name} -->\n{table(study, of[study.name])}\n\n"
                        f"![{study.title}](images/validation-{study.name}.png)\n<!-- end of {study.name} -->"
            for study in studies if study.name in of}


def with_blocks(text, found):
    """The text of a page with them; it has marks for each."""
    for name, block in found.items():
        text = re.sub(f"<!-- {name} -->.*?<!-- end of {name} -->", lambda _: block, text, flags=re.S)
    return text


def write(records, studies):
    found, of = blocks(records, studies), merged(records)
    page = {name: page_of(name) for name in found}
    if missing := [name for name in found if not page[name]]:
        print(f"report: no page has marks <!-- NAME --> ... <!-- end of NAME --> for {', '.join(missing)}", file=sys.stderr)
        return 2
    for study in (study for study in studies if study.name in found):
        draw(study, of[study.name], root / "docs" / "images" / f"validation-{study.name}.png")
    for each in pages:
        each.write_text(with_blocks(each.read_text(), {name: block for name, block in found.items() if page[name] == each}))
    return 0


def check(records, studies):
    """Whether the pages hold the tables of the records."""
    texts = [page.read_text() for page in pages]
    stale = [name for name, block in blocks(records, studies).items() if not any(block in text for text in texts)]
    for name in stale:
        print(f"report: no page has the table of {name} as it is in the records (validate.py --report)", file=sys.stderr)
    return 1 if stale else 0

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
groups = {  # studies that share a table: its mark, and what their lines are called
    "couette-pressure": {"couette-pressure": "100 Pa", "couette-pressure-high": "1000 Pa"},
    "taylor-green": {"taylor-green": "0.01 m/s", "taylor-green-strained": "0.1 m/s"},
    "taylor-couette": {"taylor-couette": "λ = 1000 μ", "taylor-couette-soft": "λ = 100 μ"},
    "rotation": {"rotating-drop": "disc", "rotating-drop-3d": "ball"},
    "trouton": {"trouton-planar": "sheet", "trouton-3d": "bar"},
    "power-laws": {"power-law-slit": "n = 0.5", "power-law-slit-thickening": "n = 1.5"},
    "shear-rates": {"couette-carreau-yasuda": "Carreau-Yasuda", "couette-cross": "Cross"},
    "heaps": {"bingham-heap": "plane", "bingham-heap-3d": "round"},
    "conduction": {"heated-slab": "slab", "heated-layers": "two layers",
                   "cooled-slab": "cooled, Bi = 1", "cooled-slab-fast": "cooled, Bi = 10"},
    "freezing": {"stefan-freezing": "warm liquid", "stefan-one-phase": "at its melting point"},
    "heated-cavities": {"heated-cavity-1e3": "Ra = 10³", "heated-cavity-1e4": "Ra = 10⁴", "heated-cavity-1e5": "Ra = 10⁵"},
    "heated-floors": {"heated-floor": "Ra = 2500", "heated-floor-resting": "Ra = 1366"},
    "cure": {"cure-isothermal": "at 360 K", "cure-adiabatic": "by its own heat"},
    "thixotropy": {"thixotropic-steps": "steps", "thixotropic-loop": "loop"},
    "elastic-filaments": {"elastic-sheet": "sheet", "elastic-filament": "bar"},
    "two-layers": {"two-layer-couette": "10,000 to 1", "two-layer-couette-1000": "1,000 to 1"},
    "static-drops": {"static-drop": "drop", "static-drop-3d": "ball"},
    "relaxing-drops": {"relaxing-drop": "drop", "relaxing-drop-3d": "ball"},
    "films": {"levelling-film": "1.96", "levelling-film-1": "1", "levelling-film-05": "0.5"},
    "wetting-drops": {"wetting-drop-45": "2D, 45°", "wetting-drop-90": "2D, 90°", "wetting-drop-135": "2D, 135°",
                      "wetting-drop-3d-45": "3D, 45°", "wetting-drop-3d-90": "3D, 90°", "wetting-drop-3d-135": "3D, 135°"},
    "isph-drops": {"isph-drop": "axis", "isph-drop-diagonal": "diagonal"},
}


def page_of(name):
    """The page that has marks for a table, or none."""
    for page in pages:
        if re.search(f"<!-- {name} -->.*<!-- end of {name} -->", page.read_text(), flags=re.S):
            return page
    return None


def number(value):
    return f"{value:.2g}" if abs(value) < 1e3 else f"{value:.0f}"


def headings(labels):
    """What the columns of levels are called: r4 is resolution 4; the resolution is left out where all levels have the same one."""
    parts = [label.removeprefix("x").partition(" ") for label in labels]
    same = len({resolution for resolution, _, _ in parts}) == 1 and len(parts) > 1
    return [name if same else f"r{resolution} {name}".rstrip() for resolution, _, name in parts]


def resolution(label):
    """A level as pictures name it: r4 is resolution 4."""
    return "r" + label.removeprefix("x")


def merged(records):
    """Study to scheme to levels, from several records; the later one wins."""
    result: dict[str, dict[str, list]] = {}
    for record in records:
        for name, rows in record.items():
            # Records from before there was another scheme do not say which they are of.
            scheme = "isph" if name.startswith("isph-") else rows[0].get("scheme", "published")
            result.setdefault(name, {})[scheme] = rows
    return {name: {s: of[s] for s in schemes if s in of} for name, of in result.items()}


def error_cells(study, rows, name):
    """The errors of all levels of a scheme, with their observed orders."""
    cells = []
    for k, row in enumerate(rows):
        value = row["errors"].get(name)
        cell = "" if value is None else number(value)
        if value is not None and study.refined and k > 0:
            p = order(rows[k - 1]["errors"][name], value, rows[k - 1]["size"], row["size"])
            cell += "" if p is None else f" ({round(p, 1) + 0.0:g})"
        cells.append(cell)
    return cells


def table(parts):
    """Markdown: a line for each error; a column for each level of the first scheme, and one for the finest level of each other one.
    parts: what the lines of a study are called, the study, and scheme to levels. Measured values, numbers of particles and iterations,
    devices and commits are in the records, bounds in the studies."""
    _, _, of = max(parts, key=lambda part: len(next(iter(part[2].values()))))
    first, *others = of
    names = headings([row["level"] for row in of[first]])
    lines = [["error", *names, *(f"{scheme}, {headings([row['level'] for row in of[scheme]])[-1]}" for scheme in others)]]
    for label, study, of in parts:
        for name in of[first][0]["errors"]:
            title = ": ".join(part for part in (label, name if not label or len(of[first][0]["errors"]) > 1 else "") if part)
            cells = error_cells(study, of[first], name)
            cells += [""] * (len(names) - len(cells))
            lines.append([title, *cells, *(number(of[scheme][-1]["errors"][name]) for scheme in others)])
    head, *body = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([head, "|" + "---|" * (1 + len(names) + len(others)), *body])


def draw(study, of, path):
    """The exact curves, those of the coarsest, a middle and the finest level of the first scheme, and the finest of the others."""
    (_, rows), *others = of.items()
    shown = rows if len(rows) <= 3 else [rows[0], rows[len(rows) // 2], rows[-1]]
    with figure(path, study.title, study.x_label, study.y_label) as axes:
        for name, (x, y) in rows[-1]["exact"].items():
            axes.plot(x, y, "k-", linewidth=1, label=name)
        for row, mark in zip(shown, ("o", "s", "."), strict=False):
            for k, (name, (x, y)) in enumerate(row["curves"].items()):
                axes.plot(x, y, mark, markersize=3, markerfacecolor="none", color=f"C{k}", alpha=0.8,
                          label=f"{name}, {resolution(row['level'])}")
        for scheme, found in others:
            for name, (x, y) in found[-1]["curves"].items():
                axes.plot(x, y, "x", markersize=2, color="0.6", zorder=0, label=f"{scheme}: {name}, {resolution(found[-1]['level'])}")


def blocks(records, studies):
    """Name of a table to what stands between its marks, these included. A group without all of its studies has none."""
    of, by_name, found = merged(records), {study.name: study for study in studies}, {}
    grouped = {name for group in groups.values() for name in group}
    for mark, group in (groups | {name: {name: ""} for name in by_name if name not in grouped}).items():
        if not all(name in of and name in by_name for name in group):
            continue
        pictures = [f"![{by_name[name].title}](images/validation-{name}.png)" for name in group]
        parts = [(label, by_name[name], of[name]) for name, label in group.items()]
        found[mark] = "\n".join([f"<!-- {mark} -->", table(parts), "", *pictures, f"<!-- end of {mark} -->"])
    return found


def with_block(text, name, block):
    """The text of a page with a block between its marks."""
    return re.sub(f"<!-- {name} -->.*?<!-- end of {name} -->", lambda _: block, text, flags=re.S)


def with_blocks(text, found):
    """The text of a page with them; it has marks for each."""
    for name, block in found.items():
        text = with_block(text, name, block)
    return text


def write(records, studies):
    found, of = blocks(records, studies), merged(records)
    page = {name: page_of(name) for name in found}
    if missing := [name for name in found if not page[name]]:
        print(f"report: no page has marks <!-- NAME --> ... <!-- end of NAME --> for {', '.join(missing)}", file=sys.stderr)
        return 2
    for study in (study for study in studies if study.name in of):
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

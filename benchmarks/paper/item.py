"""What a reproduced table or figure is."""

import math
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Plot:
    """curves: name to (x, y); what is None there is left out."""

    curves: dict
    x_label: str
    y_label: str
    log_x: bool = True
    log_y: bool = True


@dataclass(frozen=True)
class Item:
    """claim: what the paper says there. needs: measurements. rows: Results to a list of dictionaries, the table. reading: rows
    and Results to sentences; must bear missing numbers. plot: rows and Results to a Plot."""

    name: str
    title: str
    claim: str
    needs: tuple
    rows: Callable
    reading: Callable
    plot: Callable | None = None


def number(value):
    """As in a table."""
    if value is None:
        return ""
    if isinstance(value, (str, bool)):
        return str(value)
    if isinstance(value, int) or (abs(value) >= 100 and abs(value) < 1e5):
        return f"{value:.0f}" if abs(value) < 1e6 else f"{value:.3g}"
    return f"{value:.3g}"


def whole(values):
    """Those that are there."""
    return [v for v in values if v is not None]


def pairs(rows, x, y):
    """Points of a curve, without what is missing."""
    found = [(row[x], row[y]) for row in rows if row.get(x) is not None and row.get(y) is not None]
    return [f[0] for f in found], [f[1] for f in found]


def curves(rows, x, names):
    return {name: pairs(rows, x, name) for name in names if len(pairs(rows, x, name)[0]) > 0}


def growth(rows, name, x="particles"):
    """The exponent p of name ~ x^p between the first and the last row that have it, with the two values: (p, first, last,
    first row, last row). Derived times that came out negative are left out; None with fewer than two."""
    found = [row for row in rows if row.get(name) is not None and row[name] > 0]
    if len(found) < 2 or found[0][x] == found[-1][x]:
        return None
    first, last = found[0], found[-1]
    return math.log(last[name] / first[name]) / math.log(last[x] / first[x]), first[name], last[name], first, last


def told_growth(rows, names):
    """A sentence on how the columns grow over the sizes of the rows."""
    told: dict[str, list[str]] = {}
    for name in names:
        if found := growth(rows, name):
            p, _, _, a, b = found
            told.setdefault(f"{a['case']} to {b['case']}", []).append(f"{name} {p:.2f}")
    return " ".join(f"Growth from {ends} as N^p, p: {', '.join(parts)}." for ends, parts in told.items())

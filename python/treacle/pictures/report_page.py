"""One page from parts: no network, all that it needs is in it."""

import html
import json
from collections.abc import Iterable, Mapping, Sequence
from importlib import resources
from pathlib import Path

import plotly


def text(value: object) -> str:
    return html.escape(str(value))


def json_text(value: object) -> str:
    """JSON that may stand in a script element."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def library() -> str:
    """plotly.js, MIT License, as the package plotly ships it."""
    return (Path(plotly.__file__).parent / "package_data" / "plotly.min.js").read_text(encoding="utf-8")


def part(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def table(rows: Iterable[tuple[str, str]]) -> str:
    return "".join(f"<tr><th>{text(name)}</th><td>{text(value)}</td></tr>" for name, value in rows)


def warnings(lines: Sequence[str], most: int = 40) -> str:
    """A list of the first ones, and how many more there are; nothing without any."""
    if not lines:
        return '<p class="quiet">None.</p>'
    items = "".join(f"<li>{text(line)}</li>" for line in lines[:most])
    more = f'<p class="quiet">and {len(lines) - most:,} more in run.log</p>' if len(lines) > most else ""
    return f"<ul>{items}</ul>{more}"


def page(
    title: str,
    subtitle: str,
    status: str,
    message: str,
    rows: Iterable[tuple[str, str]],
    lines: Sequence[str],
    remark: str,
    case: str,
    data: Mapping[str, object],
) -> str:
    """The whole page. status: done, failed or not ended; rows: names and values; lines: warnings; case: its text; data:
    for the scripts."""
    words = {
        "title": text(title),
        "subtitle": text(subtitle),
        "status": text(status),
        "kind": {"done": "good", "failed": "bad"}.get(status, "open"),
        "message": f'<p class="message">{text(message)}</p>' if message else "",
        "summary": table(rows),
        "warnings": warnings(lines),
        "remark": text(remark),
        "case": text(case),
        "data": json_text(data),
        "style": part("page.css"),
        "view": part("frame_view.js"),
        "charts": part("charts.js"),
        "library": library(),
    }
    pieces = part("page.html").split("@@")  # text and names of words by turns
    return "".join(words[piece] if k % 2 else piece for k, piece in enumerate(pieces))

"""A case as the text of a case file, with no keys but those that are given."""

from __future__ import annotations

import dataclasses
from typing import Any

from .._toml import quoted
from ..cases import Case
from .lines import number_text

_last = ("velocity", "rotation", "speed")  # after the other keys of their table


def case_file_text(case: Case, origin: str) -> str:
    """origin: a line about where the case comes from."""
    text = f"# {origin}. SI units.\n"
    for key, value in _entries(case):
        tables = value if isinstance(value, list) and dataclasses.is_dataclass(value[0]) else [value]
        for table in tables:
            if dataclasses.is_dataclass(table):
                text += f"\n{f'[[{key}]]' if table is not value else f'[{key}]'}\n"
                text += "".join(f"{name} = {_text(entry)}\n" for name, entry in _entries(table))
            else:
                text += f"{key} = {_text(table)}\n"
    return text


def _entries(table: Any) -> list[tuple[str, Any]]:
    """The keys that are given, with their values."""
    names = sorted((field.name for field in dataclasses.fields(table)), key=lambda name: name in _last)
    return [(name, getattr(table, name)) for name in names if getattr(table, name) is not None]


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, (int, float)):
        return number_text(value)
    if dataclasses.is_dataclass(value):
        return f"{{ {', '.join(f'{name} = {_text(entry)}' for name, entry in _entries(value))} }}"
    return f"[{', '.join(map(_text, value))}]"

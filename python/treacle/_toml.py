"""Cases of Python as the text that the reader of case files takes."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

from .errors import InputError


def case_text(case: Any) -> str:
    """The case, a mapping or a dataclass of treacle.cases, as TOML. Errors: InputError for values TOML has not."""
    table = _plain(case, "case")
    if not isinstance(table, dict):
        raise InputError(f"case: expected a dict or treacle.Case, found {type(case).__name__}")
    return "".join(f"{quoted(key)} = {_text(value)}\n" for key, value in table.items())


def override_texts(overrides: Mapping[str, Any] | Iterable[str] | None) -> list[str]:
    """What the command line takes after --set: "key=value" each."""
    if overrides is None:
        return []
    if isinstance(overrides, Mapping):
        return [f"{key}={_text(_plain(value, key))}" for key, value in overrides.items()]
    if isinstance(overrides, str) or not isinstance(overrides, Iterable):
        raise InputError(f'overrides: expected a dict or a list of "key=value", found {type(overrides).__name__}')
    return [str(text) for text in overrides]


def _plain(value: Any, way: str) -> Any:
    """With dicts, lists, texts and numbers of Python alone. What is None is left out."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        # A key that is a word of Python, `from`, has an underscore behind it.
        value = {field.name.rstrip("_"): getattr(value, field.name) for field in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        plain = {}
        for key, entry in value.items():
            if not isinstance(key, str):
                raise InputError(f"{way}: expected keys that are strings, found {key!r}")
            if entry is not None:
                plain[key] = _plain(entry, key if way == "case" else f"{way}.{key}")
        return plain
    if hasattr(value, "tolist"):  # of NumPy and the like
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(entry, way) for entry in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, int) and not isinstance(value, bool) and not -(2**63) <= value < 2**63:
        raise InputError(f"{way}: expected a whole number of at most 64 bits, found {value}", key=way.split(".")[-1])
    if isinstance(value, (bool, int, float, str)):
        return value
    raise InputError(
        f"{way}: expected a number, string, bool, list or dict, found {type(value).__name__}", key=way.split(".")[-1]
    )


def quoted(text: str) -> str:
    """A string or key of TOML."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    return f"{{{', '.join(f'{quoted(key)} = {_text(entry)}' for key, entry in value.items())}}}"

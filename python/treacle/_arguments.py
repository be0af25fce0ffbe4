"""Arguments, and attributes that are misspelt."""

from __future__ import annotations

import difflib
import operator
import reprlib
from collections.abc import Callable
from typing import Any, TypeVar

from .errors import InputError

T = TypeVar("T", str, int, float)


def _string(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _number(value: Any) -> float:
    if isinstance(value, str):
        raise TypeError
    return float(value)


_KINDS: dict[type, tuple[Callable[[Any], Any], str]] = {
    str: (_string, "a string"),
    int: (operator.index, "a whole number"),
    float: (_number, "a number"),
}


def argument(name: str, value: Any, kind: type[T]) -> T:
    """The value as that kind. Errors: InputError where it is of another one."""
    convert, expected = _KINDS[kind]
    try:
        converted: T = convert(value)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected {expected}, found {reprlib.repr(value)}") from None
    return converted


class KnownNames:
    """Objects whose attributes are those that their class names; classes that others derive may have more.

    Errors of assignment: AttributeError, which names the attribute that is probably meant.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        kind = type(self)
        if not hasattr(kind, name) and not name.startswith("_") and kind.__module__.startswith("treacle."):
            near = difflib.get_close_matches(name, [known for known in dir(kind) if not known.startswith("_")], 1, 0.75)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise AttributeError(f"{kind.__name__} has no attribute '{name}'{hint}")
        super().__setattr__(name, value)

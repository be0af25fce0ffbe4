"""Attributes that are misspelt."""

from __future__ import annotations

import difflib
from typing import Any


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

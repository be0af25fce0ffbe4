"""Mistakes that a user can mend, and packages that may be missing."""

import importlib

from ..errors import InputError


class PictureError(InputError):
    """What was asked for cannot be drawn; the message says why, and what was expected."""


def require(*modules: str) -> None:
    """Imports modules by name. Raises PictureError with the way to install the first one that is missing."""
    for name in modules:
        try:
            importlib.import_module(name)
        except ImportError as error:
            raise PictureError(
                f"{error}; films, reports and curves need more packages: in treacle's sources, scripts/pictures or pip "
                "install '.[pictures]'"
            ) from None

"""Mistakes that a user can mend, and packages that may be missing."""

import importlib
import sys


class PictureError(Exception):
    """What was asked for cannot be drawn; the message says why, and what was expected."""


def require(*modules):
    """Imports modules by name. Raises PictureError with the way to install the first one that is missing."""
    for name in modules:
        try:
            importlib.import_module(name)
        except ImportError as error:
            raise PictureError(
                f"{error}; films and reports need more packages: in treacle's sources, scripts/pictures or pip install "
                "'.[pictures]'"
            ) from None


def command(arguments_of, make, argv):
    """Exit code of make(arguments_of(argv)), as that of the program: 2 where a PictureError says what is wrong, 3 where
    files cannot be read or written or Ctrl-C ends the work. argv is None: the words of the command line."""
    try:
        make(arguments_of(sys.argv[1:] if argv is None else argv))
    except SystemExit as stop:  # help, or a word that is no option
        return stop.code or 0
    except PictureError as error:
        print(f"treacle: error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"treacle: error: {error}", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        print("treacle: error: stopped", file=sys.stderr)
        return 3
    return 0

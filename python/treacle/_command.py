"""What the commands that are written in Python have in common: exit codes, messages and the program beside them."""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from .errors import InputError, RunError


def command(
    arguments_of: Callable[[Sequence[str]], argparse.Namespace],
    make: Callable[[argparse.Namespace], None],
    argv: Sequence[str] | None,
) -> int:
    """Exit code of make(arguments_of(argv)), as that of the program: 2 where an InputError says what is wrong, 3
    where something else fails, files cannot be read or written, or Ctrl-C ends the work. argv is None: the words of the
    command line."""
    try:
        make(arguments_of(sys.argv[1:] if argv is None else argv))
    except SystemExit as stop:  # help, or a word that is no option
        return int(stop.code or 0)
    except InputError as error:
        print(f"treacle: error: {error}", file=sys.stderr)
        return 2
    except (RunError, OSError) as error:
        print(f"treacle: error: {error}", file=sys.stderr)
        return 3
    except MemoryError:
        print("treacle: error: memory exhausted", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        print("treacle: error: stopped", file=sys.stderr)
        return 3
    return 0


def say(text: str) -> None:
    """Prints lines at once. A reader that is gone is no error. Raises RunError where they cannot be written."""
    try:
        print(text, flush=True)
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Python writes what is left as it ends
        if not isinstance(error, BrokenPipeError):
            raise RunError(f"cannot write to stdout: {error.strerror}") from None


def write_files(contents: Mapping[str, bytes]) -> None:
    """Writes files by their paths, all completely before the first one appears under its name. Raises RunError."""
    staged: list[tuple[str, str]] = []
    path = ""
    try:
        for path, content in contents.items():
            target = os.path.realpath(path)
            if is_file := not os.path.exists(path) or os.path.isfile(path) or os.path.isdir(path):
                staged.append((f"{target}.tmp", target))
            with open(f"{target}.tmp" if is_file else path, "wb") as file:
                file.write(content)
                file.flush()
                if is_file:
                    os.fsync(file.fileno())
        while staged:
            os.replace(*staged[0])
            staged.pop(0)
    except OSError as error:
        raise RunError(f"cannot write {path}: {error.strerror}") from None
    finally:
        for temporary, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(temporary)


def program() -> str | None:
    """The program treacle: what TREACLE_PROGRAM names, that of the package, or what the shell finds."""
    packaged = Path(__file__).parent / "bin" / "treacle"
    return os.environ.get("TREACLE_PROGRAM") or (str(packaged) if packaged.exists() else shutil.which("treacle"))

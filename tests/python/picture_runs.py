"""Runs that films and reports are made of in tests, by the built program, and what the tests look at."""

import contextlib
import importlib
import importlib.util
import io
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

repository = Path(__file__).resolve().parents[2]

if not importlib.util.find_spec("treacle"):  # neither installed nor in PYTHONPATH: films need nothing that is compiled
    sys.path.insert(0, str(repository / "python"))
    os.environ["PYTHONPATH"] = str(repository / "python")


def program():
    """The built program: TREACLE_PROGRAM, else that of a build directory, which the modules then take, too."""
    named = os.environ.get("TREACLE_PROGRAM")
    built = sorted(repository.glob("build/*/bin/treacle"), key=lambda path: -path.stat().st_mtime)
    if not named and not built:
        pytest.skip("no program treacle: neither TREACLE_PROGRAM nor build/*/bin/treacle")
    return os.environ.setdefault("TREACLE_PROGRAM", named or str(built[0]))


def run(case, directory, *options):
    """Runs a case of the repository into a directory."""
    command = [
        program(),
        "run",
        str(repository / "cases" / case),
        "-o",
        str(directory),
        "--quiet",
        "--threads",
        "1",
        "--backend",
        "cpu",
        *options,
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return directory


def flat_run(directory):
    """Four frames of a two-dimensional dam break, with balance and two probes."""
    return run("dam-break-2d.toml", directory, "--set", "time.end=0.03", "--set", "output.balance=true")


def solid_run(directory):
    """Three frames of a three-dimensional dam break."""
    return run(
        "dam-break-3d.toml",
        directory,
        "--set",
        "resolution=0.5",
        "--set",
        "time.end=0.004",
        "--set",
        "output.interval=0.002",
    )


def continued_runs(directory, case):
    """A run whole, to 0.04 s, and one in two parts, of which the first went on for 5 ms after the state that the second one
    begins with, at 0.02 s: their directories."""
    file = directory / "case.toml"
    file.write_text(case)
    whole, first, kept, second = (directory / name for name in ("whole", "first", "kept", "second"))
    for place, end in (whole, "0.04"), (first, "0.025"), (kept, "0.02"):
        run(file, place, "--end-time", end)
    run(file, second, "--end-time", "0.04", "--resume", str(kept / "checkpoint.h5"))
    return SimpleNamespace(whole=whole, first=first, second=second)


def started(module, *arguments):
    """python -m treacle.MODULE ARGUMENTS: what it left."""
    return subprocess.run(
        [sys.executable, "-m", f"treacle.{module}", *map(str, arguments)], capture_output=True, text=True
    )


def called(module, *arguments):
    """The same in this process, which has the packages already."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = importlib.import_module(f"treacle.{module}").main([str(word) for word in arguments])
    return SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=err.getvalue())


def copied(directory, place):
    """A copy of a run that a test may change."""
    return Path(shutil.copytree(directory, place))

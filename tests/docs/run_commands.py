"""Runs the commands of a page, in order, or those within the sentences of all pages, in a copy of the repository.

usage: run_commands.py TREACLE SOURCE PAGE      PAGE: docs/tutorial.md
       run_commands.py TREACLE SOURCE --inline

Environment: TREACLE_MPI, TREACLE_OPENVDB: set where the program was built with them; TREACLE_PYTHON: a Python with what
films and reports need.

Before a block of a page may stand a comment,
  <!-- file: NAME -->                the block, of whatever language, becomes this file
  <!-- first steps only: REASON -->  of `treacle run` in it only the first steps are made (firstSteps in stage/all.sh)
  <!-- synopsis: COMMAND -->         complete.py compares it with the help of the program
What is not run stands in not_run.toml, with the reason. Before the commands of docs/NAME.md, stage/NAME.sh makes what
they take. A script ends at the first command that fails.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib

import pages

here = pathlib.Path(__file__).resolve().parent
not_copied = ("build*", ".git", ".gpu", "images", "src", "include", "kernels", "unit", "twin", "*-run", "__pycache__")


def stage(name):
    """What stands before commands, in the language of the shell."""
    path = here / "stage" / f"{name}.sh"
    return path.read_text() if path.is_file() else ""


def reasons():
    """Of the commands that are not run here."""
    variables = {"films": "TREACLE_PYTHON", "MPI": "TREACLE_MPI", "OpenVDB": "TREACLE_OPENVDB"}
    entries = tomllib.loads((here / "not_run.toml").read_text())["not_run"]
    kept = [e for e in entries if not e.get("needs") or any(variables[need] not in os.environ for need in e["needs"])]
    return {command: entry["reason"] for entry in kept for command in entry["commands"]}


def commands_of_page(page, left_out):
    """The script of a page, and how many commands are in it."""
    parts, count = [stage(pathlib.Path(page.name).stem)], 0
    for block in page.blocks:
        if block.kind == "file":
            quoted = shlex.quote(block.text.rstrip("\n"))
            parts.append(f"mkdir -p $(dirname {block.mark}); printf '%s\\n' {quoted} > {block.mark}")
        for line, command in block.commands if block.language == "sh" else ():
            if command in left_out:
                print(f"{page.name}:{line}: not run: {command}\n  {left_out[command]}")
                continue
            if block.kind == "first steps only":
                command = re.sub("^treacle run", "firstSteps", command)
            parts.append(f"echo 'run_commands: {page.name}:{line}' >&2\n{command}")
            count += 1
    return parts, count


def inline_commands(source, left_out):
    """Each distinct command within sentences, in a folder of its own; and how many there are."""
    found = {command: f"{page.name}:{line}" for page in pages.all_of(source) for line, command in page.inline}
    found = {command: place for command, place in found.items() if command not in left_out}
    parts = [f"echo 'run_commands: {place}' >&2\napart {shlex.quote(command)}" for command, place in found.items()]
    return [stage("inline"), *parts], len(found)


def surroundings(program, source, folder):
    """A copy of the repository, without what is compiled, that has been built by every preset; and the environment."""
    shutil.copytree(source, folder, ignore=shutil.ignore_patterns(*not_copied))
    python, films = folder / "build/python/python3", folder / "build/pictures/bin/python3"
    for path, interpreter in (python, sys.executable), (films, os.environ.get("TREACLE_PYTHON", "/bin/false")):
        path.parent.mkdir(parents=True)  # a link to that of a virtual environment would not find its packages
        path.write_text(f'#!/bin/sh\nexec "{interpreter}" "$@"\n')
        path.chmod(0o755)
    for preset in ("release", "cpu-only"):
        (folder / "build" / preset).symlink_to(program.parent.parent)
    mpi = {
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
    }
    path = f"{python.parent}:{program.parent}:{os.environ['PATH']}"
    return os.environ | mpi | {"PATH": path, "HOME": str(folder)}


def run(program, source, parts):
    """Whether all commands ended well; says which one did not."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary, "treacle")
        environment = surroundings(program, source, folder)
        script = "\n".join(["set -euo pipefail", f"source={shlex.quote(str(source))}", stage("all"), *parts, ""])
        done = subprocess.run(["bash", "-c", script], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout[-2000:], done.stderr[-4000:], f"a command failed ({done.returncode})", sep="\n")
    return done.returncode == 0


def main(program, source, what):
    program, source = pathlib.Path(program).resolve(), pathlib.Path(source).resolve()
    left_out = reasons()
    if what == "--inline":
        parts, count = inline_commands(source, left_out)
    else:
        parts, count = commands_of_page(pages.read(source / what, what), left_out)
    good = run(program, source, parts)
    print(f"{what}: {count} commands")
    return good and count > 0


if __name__ == "__main__":
    sys.exit(not main(*sys.argv[1:]))

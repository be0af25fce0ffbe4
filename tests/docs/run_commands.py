"""Runs the commands of pages: each block of `sh`, in order, in a folder of its own with the cases of the repository.

usage: run_commands.py TREACLE SOURCE PAGE...

Before a block may stand a comment,
  <!-- not run: REASON -->          the block is left out, and listed
  <!-- checked, not run: REASON -->  of it only `treacle run` is looked at: the case is checked
  <!-- file: NAME -->               the block, of whatever language, becomes this file
Every page is one script, which ends at the first command that fails.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

block = re.compile(r"(?:^<!-- (.+?) -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
of_check = {"--set"}  # what `treacle check` takes of the options of `treacle run`


def checks(commands):
    """`treacle check` in place of each `treacle run`."""
    lines = []
    for line in commands.splitlines():
        words = shlex.split(line, comments=True)
        if words[:2] != ["treacle", "run"]:
            continue
        kept = [words[2]]
        for option, value in zip(words[3:], words[4:]):
            if option in of_check:
                kept += [option, value]
        lines.append("treacle check " + shlex.join(kept) + " >/dev/null")
    return "\n".join(lines) + "\n"


def script(page):
    """What is run of a page, and what is not."""
    text = page.read_text()
    parts, left_out, count = [], [], 0
    for found in block.finditer(text):
        comment, language, content = found.groups()
        line = text.count("\n", 0, found.start(3)) + 1
        kind, _, what = (comment or "").partition(": ")
        if kind == "file":
            quoted = shlex.quote(content.rstrip("\n"))
            parts.append(f"mkdir -p $(dirname {what}); printf '%s\\n' {quoted} > {what}")
        elif language == "sh" and kind == "not run":
            left_out.append(f"{page.name}:{line}: not run: {what}")
        elif language == "sh":
            count += 1
            where = f"echo 'run_commands: {page.name}:{line}' >&2"
            parts.append(f"{where}\n{checks(content) if kind == 'checked, not run' else content}")
            if kind:
                left_out.append(f"{page.name}:{line}: {kind}: {what}")
    return "set -euo pipefail\n" + "\n".join(parts), left_out, count


def run(program, source, page):
    commands, left_out, count = script(page)
    print(*left_out, sep="\n", end="\n" if left_out else "")
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(source / "cases", pathlib.Path(folder, "cases"))
        environment = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-c", commands], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout[-2000:], done.stderr[-4000:], f"{page}: a command failed ({done.returncode})", sep="\n")
    elif count == 0:
        print(f"{page}: no commands found")
    else:
        print(f"{page.name}: {count} blocks")
    return done.returncode == 0 and count > 0


program, source, *pages = sys.argv[1:]
results = [run(pathlib.Path(program).resolve(), pathlib.Path(source).resolve(), pathlib.Path(page)) for page in pages]
sys.exit(not all(results))

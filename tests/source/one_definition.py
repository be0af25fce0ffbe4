"""Finds types that two files of a tree define under one name in one named namespace, which C++ forbids.

Usage: one_definition.py DIRECTORY...

Reads structs, classes, unions and enumerations at namespace scope. Types in an unnamed namespace belong to their file
alone and do not count. Exit code 1 and one line for each name with several definitions.
"""

import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

_NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
_TOKEN = re.compile(
    r"\bnamespace\s*(?P<namespace>[\w:]*)\s*\{"
    r"|\b(?:struct|class|union|enum\s+class|enum)\s+(?:alignas\([^)]*\)\s*)?(?P<type>\w+)(?:\s+final)?"
    r"(?P<arguments>\s*<)?(?:\s*:\s[^;{]*)?\s*\{"
    r"|(?P<open>\{)|(?P<close>\})"
)


def definitions(text: str) -> Iterator[str]:
    """Names of the types that a file defines at the scope of a named namespace, with that namespace."""
    # None: a scope that is no namespace; "": an unnamed one.
    scopes: list[str | None] = []
    for token in _TOKEN.finditer(_NOT_CODE.sub(" ", text)):
        if token["close"]:
            if scopes:
                scopes.pop()
        elif token["namespace"] is not None:
            scopes.append(token["namespace"])
        else:
            named = bool(scopes) and all(scopes)
            if token["type"] and not token["arguments"] and named:
                yield "::".join([*filter(None, scopes), token["type"]])
            scopes.append(None)


def main(directories: list[str]) -> int:
    places: defaultdict[str, set[Path]] = defaultdict(set)
    for directory in directories:
        for path in sorted(Path(directory).rglob("*")):
            if path.suffix in {".hpp", ".cpp", ".cu", ".cuh"}:
                for name in definitions(path.read_text()):
                    places[name].add(path)
    several = {name: paths for name, paths in places.items() if len(paths) > 1}
    for name, paths in sorted(several.items()):
        print(f"{name} is defined in {', '.join(map(str, sorted(paths)))}")
    if not places:
        print("no definition found: are these the directories of the sources?")
    return 1 if several or not places else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Whether pages may trust the records in benchmarks/results: each was made at a commit, without uncommitted changes, and
no later commit touched what it measures (benchmarks/results/measures.toml), or the page says so.

usage: records.py SOURCE    exit code 77: not everything can be looked up, because the history is not there
"""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

results = "benchmarks/results"
skipped = 77
phrases = {"stale": "earlier state of the program", "dirty": "uncommitted changes"}


class NoHistory(Exception):
    """The commits that a record is compared with are not there."""


@dataclass
class History:
    """The commits of a repository."""

    source: Path
    shallow: bool = False

    def __post_init__(self) -> None:
        said = self.git("rev-parse", "--is-shallow-repository", "--show-toplevel")
        shallow, _, top = said.stdout.strip().partition("\n")
        if said.returncode != 0 or Path(top).resolve() != self.source.resolve():
            reason = said.stderr.strip().splitlines() or [f"{self.source} is no git repository"]
            raise NoHistory(f"no git history: {reason[0]}")
        self.shallow = shallow == "true"

    def git(self, *words: str) -> subprocess.CompletedProcess[str]:
        try:
            return subprocess.run(["git", "-C", str(self.source), *words], capture_output=True, text=True)
        except FileNotFoundError:
            raise NoHistory("no git history: no program git") from None

    def before(self, first: str, second: str) -> bool:
        """Whether a commit is an ancestor of another, or the same."""
        return self.git("merge-base", "--is-ancestor", first, second).returncode == 0

    def missing(self, commit: str) -> str:
        """What is wrong with a commit that should be in the history; raises NoHistory if a clone may just lack it."""
        if self.before(commit, "HEAD"):
            return ""
        if self.shallow:
            raise NoHistory(f"a shallow clone without commit {commit}: git fetch --unshallow")
        return f"commit {commit} is not in the history (was it rebased?)"

    def changes(self, since: str, paths: list[str]) -> list[str]:
        """Commits after one that touch the paths, the newest first."""
        return self.git("log", "--format=%h %as %s", f"{since}..HEAD", "--", *paths).stdout.splitlines()


@dataclass
class Record:
    """A record and what measures.toml says of it."""

    name: str
    commits: set[str]
    dirty: bool
    paths: list[str]
    again: str
    check: dict[str, str] = field(default_factory=dict)
    stale: str = ""
    pages: list[str] = field(default_factory=list)


def stamps(record: Any) -> Iterator[tuple[str, bool]]:
    """(commit, whether the tree had changes) of all parts of a record."""
    if isinstance(record, dict):
        commit = record.get("commit")
        if isinstance(commit, str):
            yield commit.removesuffix("-dirty"), commit.endswith("-dirty") or record.get("clean") is False
    for part in record.values() if isinstance(record, dict) else record if isinstance(record, list) else ():
        yield from stamps(part)


def read(source: Path) -> tuple[list[Record], list[str]]:
    """The records, and what is wrong with their list."""
    folder, found, wrong = source / results, [], []
    listed = tomllib.loads((folder / "measures.toml").read_text())
    files = {path.name for path in folder.glob("*.json")}
    seen: set[str] = set()
    for entry in listed["measured"]:
        paths = [path for name in entry.get("of", []) for path in listed["paths"][name]] + entry.get("and", [])
        check = listed["check"][entry["check"]] if "check" in entry else {}
        wrong += [f"{path}: no such file or folder" for path in paths if not (source / path).exists()]
        wrong += [f"{name}: listed twice" for name in entry["records"] if name in seen]
        wrong += [f"{name}: no such record" for name in set(entry["records"]) - files]
        if check and not (check.get("holds_at") and check.get("why", "").strip()):
            wrong.append(f"[check.{entry['check']}]: expected holds_at and why")
        seen |= set(entry["records"])
        for name in sorted(files.intersection(entry["records"])):
            marks = list(stamps(json.loads((folder / name).read_text())))
            found.append(
                Record(
                    name,
                    {commit for commit, _ in marks},
                    any(dirty for _, dirty in marks),
                    paths,
                    entry["again"],
                    check,
                    entry.get("stale", ""),
                    entry.get("pages", []),
                )
            )
            if not marks:
                wrong.append(f"{name}: says no commit")
    wrong += [f"{name}: not in measures.toml" for name in sorted(files - seen)]
    return found, sorted(set(wrong))


def mentions(source: Path, record: Record) -> Iterator[tuple[str, str]]:
    """(page, text) of each paragraph that names a record, and of whole pages that have its numbers."""
    for path in sorted([*source.glob("*.md"), *source.glob("docs/**/*.md")]):
        page, text = path.relative_to(source).as_posix(), path.read_text()
        for paragraph in re.split(r"\n\s*\n|\n(?=[-*|] )", text):
            if re.search(rf"(?<![\w-]){re.escape(record.name)}", paragraph):
                yield page, paragraph
        if page in record.pages:
            yield page, text


def since(history: History, record: Record) -> tuple[set[str], list[str]]:
    """The commits that the program is compared with, and what is wrong with those of the record."""
    bases, wrong, held = set(), [], record.check.get("holds_at", "")
    if held and (missing := history.missing(held)):
        return set(), [f"holds_at: {missing}; check again and name a commit of the history"]
    for commit in record.commits:
        if held and not history.before(held, commit):
            bases.add(held)
        elif missing := history.missing(commit):
            wrong.append(f"{missing}; measure again, by: {record.again}")
        else:
            bases.add(commit)
    return bases, wrong


def outdated(history: History, record: Record) -> list[str]:
    """What is wrong with a record that should describe the present program."""
    if record.dirty:
        return [f"made from a tree with uncommitted changes; measure again, by: {record.again}"]
    bases, wrong = since(history, record)
    for base in sorted(bases):
        if changes := history.changes(base, record.paths):
            more = [f"... and {len(changes) - 5} more"] if len(changes) > 5 else []
            wrong.append(
                "\n    ".join(
                    [
                        f"{len(changes)} commits after {base} touch what it measures:",
                        *changes[:5],
                        *more,
                        f"Measure again, by: {record.again}",
                        "or compare the results, and set holds_at and why in measures.toml,",
                        "or say why the record is stale there, and on the page.",
                    ]
                )
            )
    return wrong


def unsaid(mentioned: list[tuple[str, str]], record: Record) -> list[str]:
    """Pages that do not say what is wrong with a record that is known to be stale."""
    needed = [phrases["stale"]] + ([phrases["dirty"]] if record.dirty else [])
    return [
        f"{page} must say '{phrase}' beside it: {' '.join(record.stale.split())}"
        for page, text in mentioned
        for phrase in needed
        if phrase not in " ".join(text.split())
    ]


def main(source: Path) -> int:
    if not (source / results).is_dir():
        print(f"skipped: no {results}, as in a source archive")
        return skipped
    records, failures = read(source)
    absent: list[str] = []
    try:
        history: History | None = History(source)
    except NoHistory as reason:
        history, absent = None, [str(reason)]
    for record in records:
        mentioned = list(mentions(source, record))
        wrong: list[str] = []
        if record.stale:
            wrong = unsaid(mentioned, record)
        elif mentioned and history:
            try:
                wrong = outdated(history, record)
            except NoHistory as reason:
                absent.append(str(reason))
        failures += [f"{record.name}: {what}" for what in wrong]
    print(*failures, sep="\n", end="\n" if failures else "")
    print(*(f"skipped: {reason}" for reason in dict.fromkeys(absent)), sep="\n", end="\n" if absent else "")
    print(f"{len(records)} records, {sum(bool(record.stale) for record in records)} of them stale")
    return 1 if failures else skipped if absent else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))

"""Tests records.py with small repositories. Usage: python3 records_test.py"""

import contextlib
import io
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import records

listing = """
[paths]
code = ["src"]
[[measured]]
records = ["steps.json"]
of = ["code"]
again = "benchmarks/steps.py"
"""


class Repository:
    """A repository with a record of one page."""

    def __init__(self, folder: str) -> None:
        self.root = Path(folder)
        self.git("init", "--quiet")
        self.write("src/flow.cpp", "1")
        self.made = self.commit("Flow")
        self.write("docs/page.md", "Steps are fast.\n\nAll of them ([record](../benchmarks/results/steps.json)).\n")
        self.record()
        self.list()

    def git(self, *words: str) -> str:
        name = ["-c", "user.name=A", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        command = ["git", "-C", str(self.root), *name, *words]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()

    def write(self, name: str, text: str) -> None:
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def commit(self, subject: str) -> str:
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", subject)
        return self.git("rev-parse", "--short=12", "HEAD")

    def record(self, mark: str = "", name: str = "steps.json") -> None:
        self.write(f"benchmarks/results/{name}", json.dumps({"runs": [{"commit": self.made + mark, "ms": 1}]}))

    def list(self, more: str = "", before: str = "") -> None:
        self.write("benchmarks/results/measures.toml", before + listing + more)

    def result(self) -> tuple[int, str]:
        with contextlib.redirect_stdout(io.StringIO()) as output:
            return records.main(self.root), output.getvalue()


class Records(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.there = Repository(folder.name)

    def expect(self, code: int, *texts: str) -> None:
        found, output = self.there.result()
        self.assertEqual(found, code, output)
        for text in texts:
            self.assertIn(text, output)

    def change(self) -> str:
        self.there.write("src/flow.cpp", "2")
        return self.there.commit("Faster flow")

    def hold(self, commit: str, why: str = "same bits") -> None:
        self.there.list('check = "same"', f'[check.same]\nholds_at = "{commit}"\nwhy = "{why}"\n')

    def test_fresh(self) -> None:
        self.there.commit("Record")
        self.expect(0, "1 records, 0 of them stale")

    def test_older_than_a_change(self) -> None:
        self.change()
        self.expect(1, "steps.json", "Faster flow", "benchmarks/steps.py", "holds_at")

    def test_change_elsewhere(self) -> None:
        self.there.write("src2/other.cpp", "2")
        self.there.commit("Other")
        self.expect(0)

    def test_held(self) -> None:
        self.hold(self.change())
        self.expect(0)

    def test_held_before_the_last_change(self) -> None:
        self.hold(self.change())
        self.there.write("src/flow.cpp", "3")
        self.there.commit("Another flow")
        code, output = self.there.result()
        self.assertEqual(code, 1)
        self.assertIn("Another flow", output)
        self.assertNotIn("Faster flow", output)

    def test_measured_after_it_was_held(self) -> None:
        self.hold(self.there.made)
        self.there.made = self.change()
        self.there.record()
        self.expect(0)

    def test_held_for_no_reason(self) -> None:
        self.hold(self.there.made, " ")
        self.expect(1, "expected holds_at and why")

    def test_held_at_an_unknown_commit(self) -> None:
        self.hold("123456789abc")
        self.expect(1, "holds_at: commit 123456789abc is not in the history")

    def test_unknown_commit(self) -> None:
        self.there.made = "123456789abc"
        self.there.record()
        self.expect(1, "commit 123456789abc is not in the history", "benchmarks/steps.py")

    def test_dirty(self) -> None:
        self.there.record("-dirty")
        self.expect(1, "uncommitted changes")

    def test_dirty_but_of_no_page(self) -> None:
        self.there.record("-dirty")
        self.there.write("docs/page.md", "Steps are fast.\n")
        self.expect(0)

    def test_stale(self) -> None:
        self.change()
        self.there.list('stale = "another flow"')
        self.expect(1, "docs/page.md must say 'earlier state of the program' beside it: another flow")
        self.there.write("docs/page.md", "An earlier state of the program.\n\n[r](../benchmarks/results/steps.json).\n")
        self.expect(1)
        self.there.write("docs/page.md", "[r](../benchmarks/results/steps.json): an earlier state\nof the program.\n")
        self.expect(0, "1 of them stale")

    def test_stale_and_dirty(self) -> None:
        self.there.record("-dirty")
        self.there.list('stale = "another flow"')
        self.there.write("docs/page.md", "`steps.json`, an earlier state of the program.\n")
        self.expect(1, "must say 'uncommitted changes'")

    def test_numbers_of_a_record_that_is_not_named(self) -> None:
        self.there.write("docs/page.md", "Steps are fast.\n")
        self.there.list('stale = "another flow"\npages = ["docs/page.md"]')
        self.expect(1, "docs/page.md must say")

    def test_name_within_a_name(self) -> None:
        self.there.record("-dirty")
        self.there.record(name="gpu-steps.json")
        self.there.write("docs/page.md", "`gpu-steps.json`\n")
        self.there.list('\n[[measured]]\nrecords = ["gpu-steps.json"]\nof = ["code"]\nagain = "again"')
        self.there.commit("Record")
        self.expect(0, "2 records")

    def test_list(self) -> None:
        self.there.record(name="other.json")
        self.there.list('and = ["kernels"]')
        self.expect(1, "other.json: not in measures.toml", "kernels: no such file or folder")

    def test_no_records(self) -> None:
        (self.there.root / "benchmarks").rename(self.there.root / "was")
        self.expect(77, "skipped: no benchmarks/results")

    def test_no_repository(self) -> None:
        (self.there.root / ".git").rename(self.there.root / "was.git")
        self.expect(77, "skipped: no git history")

    def test_archive_within_another_repository(self) -> None:
        self.there.git("init", "--quiet", str(self.there.root / "outer"))
        inner = self.there.root / "outer" / "treacle"
        inner.mkdir()
        for name in ("benchmarks", "docs", "src"):
            (self.there.root / name).rename(inner / name)
        self.there.root = inner
        self.expect(77, "skipped: no git history")

    def test_shallow_clone(self) -> None:
        self.there.commit("Record")
        with tempfile.TemporaryDirectory() as folder:
            source = f"file://{self.there.root}"
            subprocess.run(["git", "clone", "--quiet", "--depth=1", source, folder], check=True, capture_output=True)
            self.there.root = Path(folder)
            self.expect(77, "skipped: a shallow clone without commit")


if __name__ == "__main__":
    os.environ.update(GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_SYSTEM=os.devnull)
    unittest.main()

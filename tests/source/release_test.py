"""Tests scripts/release in a repository with the files that name the version. Usage: python3 release_test.py"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

source = Path(__file__).resolve().parents[2]


class Release(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        said = subprocess.run([sys.executable, source / "scripts/release", "--check"], capture_output=True, text=True)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.files = [line.partition(":")[0] for line in said.stdout.splitlines()]
        for name in [*self.files, "scripts/release"]:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source / name, self.root / name)
        self.write(
            "CHANGELOG.md",
            "# Changes\n\n## Unreleased\n\n- Jets [fold](docs/a.md).\n\n## 0.0.1, 2020-01-01\n\n- All.\n",
        )
        self.write(".gitignore", "/dist/\n__pycache__/\n")
        self.git("init", "--quiet", "--initial-branch=main")
        self.commit()

    def write(self, name: str, text: str) -> None:
        (self.root / name).write_text(text)

    def git(self, *words: str) -> str:
        command = ["git", "-C", str(self.root), *words]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()

    def commit(self) -> None:
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "Sources")

    def release(self, *words: str, code: int = 0) -> str:
        done = subprocess.run(
            [sys.executable, "scripts/release", *words], cwd=self.root, capture_output=True, text=True
        )
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def refused(self, *words: str) -> str:
        before = self.git("rev-parse", "HEAD"), self.git("status", "--porcelain")
        said = self.release(*words, "--no-build", code=1)
        self.assertEqual(before, (self.git("rev-parse", "HEAD"), self.git("status", "--porcelain")))
        self.assertEqual(self.git("tag"), "")
        return said

    def test_release(self) -> None:
        said = self.release("7.8.9", "--no-build")
        self.assertIn("git push origin main v7.8.9", said)
        self.assertEqual(self.git("status", "--porcelain"), "")
        self.assertEqual(self.git("log", "-1", "--format=%s"), "Version 7.8.9")
        self.assertEqual(self.git("rev-parse", "v7.8.9^{commit}"), self.git("rev-parse", "HEAD"))
        self.assertEqual(self.git("show", "--name-only", "--format=").split(), sorted([*self.files, "CHANGELOG.md"]))
        for line in self.release("--check").splitlines():
            self.assertRegex(line, r": 7\.8(\.9)?$")
        log = (self.root / "CHANGELOG.md").read_text()
        self.assertRegex(
            log, r"\n## Unreleased\n\n## 7\.8\.9, \d{4}-\d\d-\d\d\n\n- Jets \[fold\]\(docs/a\.md\)\.\n\n## 0\.0\.1"
        )
        self.assertEqual((self.root / "dist/release-notes-7.8.9.md").read_text(), "# treacle 7.8.9\n\n- Jets fold.\n")
        citation = (self.root / "CITATION.cff").read_text()
        self.assertRegex(citation, r"\nversion: 7\.8\.9\ndate-released: \d{4}-\d\d-\d\d\nlicense")
        self.assertIn("cff-version: 1.2.0\n", citation)

    def test_dry_run(self) -> None:
        head = self.git("rev-parse", "HEAD")
        said = self.release("7.8.9", "--dry-run")
        for name in [*self.files, "CHANGELOG.md"]:
            self.assertIn(f"+++ b/{name}\n", said)
        self.assertIn("commit, tag, wheels, source archive, notes", said)
        self.assertEqual(
            (self.git("status", "--porcelain"), self.git("rev-parse", "HEAD"), self.git("tag")), ("", head, "")
        )
        self.assertFalse((self.root / "dist").exists())

    def test_goes_on(self) -> None:
        self.release("7.8.9", "--no-build", "--no-tag")
        head = self.git("rev-parse", "HEAD")
        self.assertEqual(self.git("tag"), "")
        for _ in range(2):
            self.release("7.8.9", "--no-build")
            self.assertEqual((self.git("rev-parse", "HEAD"), self.git("tag")), (head, "v7.8.9"))

    def test_next_one(self) -> None:
        self.release("7.8.9", "--no-build")
        self.assertIn("is empty", self.release("7.9.0", "--no-build", code=1))
        log = self.root / "CHANGELOG.md"
        self.write("CHANGELOG.md", log.read_text().replace("## Unreleased\n", "## Unreleased\n\n- Ropes coil.\n"))
        self.commit()
        self.release("7.9.0", "--no-build")
        self.assertEqual((self.root / "CITATION.cff").read_text().count("date-released"), 1)
        self.assertEqual((self.root / "dist/release-notes-7.9.0.md").read_text(), "# treacle 7.9.0\n\n- Ropes coil.\n")

    def test_refusals(self) -> None:
        self.assertIn("expected three numbers", self.refused("7.8"))
        self.assertIn("is older than", self.refused("0.0.2"))
        self.write("new.txt", "")
        self.assertIn("not clean", self.refused("7.8.9"))
        (self.root / "new.txt").unlink()
        self.git("checkout", "--quiet", "-b", "trial")
        self.assertIn("on branch 'trial'; expected main", self.refused("7.8.9"))
        self.write("CITATION.cff", (self.root / "CITATION.cff").read_text().replace("\nversion: ", "\nversion: 9"))
        self.assertIn("CITATION.cff: version 9", self.release("--check", code=1))


if __name__ == "__main__":
    identity = {f"GIT_{who}_{what}": "a@b" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    os.environ.update(identity, GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_SYSTEM=os.devnull)
    unittest.main()

"""The snippets of docs/python.md, in their order and in one folder, with the case of the README."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def fenced(page, language):
    """(line, text) of each block."""
    text = (ROOT / page).read_text()
    return [
        (text.count("\n", 0, found.start(1)), found.group(1))
        for found in re.finditer(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    ]


def test_snippets_run(tmp_path, monkeypatch):
    (tmp_path / "drop.toml").write_text(fenced("README.md", "toml")[0][1])
    monkeypatch.chdir(tmp_path)
    page = ROOT / "docs/python.md"
    snippets = fenced("docs/python.md", "python")
    assert len(snippets) >= 9
    names = {}
    for line, text in snippets:
        exec(compile("\n" * line + text, page, "exec"), names)
        if "until_it_touches" in text:
            assert names["sim"].time == pytest.approx(0.012)
    assert names["resumed"].at_end
    assert len(names["height"]) == 1 + len(names["force"]) > 10  # one before the first step, which has no load
    assert names["frame"].time == 0.01

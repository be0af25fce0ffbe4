"""The examples as scripts and as notebooks, with twice the spacing, and the figures that they print.

What they need is in examples/requirements.txt; where something of it is missing tests are skipped and say so."""

import importlib.util
import os
import re
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")
EXAMPLES = Path(__file__).parents[2] / "examples"
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py"))
COARSE = {"RESOLUTION": "0.5", "OMP_NUM_THREADS": "1", "MPLBACKEND": "agg", "PYTHONDONTWRITEBYTECODE": "1"}


def run_script(name, folder):
    """What an example prints as a script, which has made its picture in that folder."""
    ran = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py"],
        cwd=folder,
        env=os.environ | COARSE,
        capture_output=True,
        text=True,
        timeout=240,
    )
    assert ran.returncode == 0, ran.stderr
    assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    return ran.stdout


@pytest.fixture(scope="module")
def notebooks():
    """The script that makes notebooks, as a module."""
    for package in ("jupytext", "nbclient", "ipykernel", "ipywidgets", "scipy"):
        pytest.importorskip(package)
    loader = SourceFileLoader("make_notebooks", str(EXAMPLES / "make-notebooks"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_notebooks", loader))
    loader.exec_module(module)
    return module


@pytest.fixture
def printed(notebooks, tmp_path, monkeypatch):
    """printed(name): what an example prints as a notebook, which draws a picture."""

    def run(name):
        for variable, value in COARSE.items():
            if variable != "MPLBACKEND":  # a notebook has its own
                monkeypatch.setenv(variable, value)
        notebook = notebooks.notebook_of(EXAMPLES / f"{name}.py")
        notebooks.execute(notebook, tmp_path)
        outputs = [o for c in notebook.cells if c.cell_type == "code" for o in c.outputs]
        assert any("image/png" in o.get("data", {}) for o in outputs)
        assert not [o for o in outputs if o.get("name") == "stderr"]
        return "".join(o["text"] for o in outputs if o.get("name") == "stdout")

    return run


def number(pattern, text):
    """The number that stands where the pattern has its group."""
    found = re.search(pattern, text)
    assert found, f"{pattern} not in {text}"
    return float(found.group(1))


def test_dam_break_of_two_backends_is_one(tmp_path):
    text = run_script("dam_break", tmp_path)
    apart = number(r"differ by up to (\S+) m at 0.01 s", text)
    assert 0 < apart < 1e-9  # 2.4e-14: the runs are two, and alike
    assert number(r", (\S+) m at 0.2 s", text) < 2e-5  # 2.1e-10, spacing 2e-3
    assert number(r"energies differ by (\S+)", text) < 1e-6  # 4.7e-10


def test_fit_finds_the_rheology(printed):
    text = printed("fit_rheology")
    assert abs(number(r"yield_stress: .* error (\S+) %", text)) < 2  # 0.6
    assert abs(number(r"plastic_viscosity: .* error (\S+) %", text)) < 3  # -1.3
    assert 0.8 < number(r"what remains is (\S+) times", text) < 1.3


def test_study_finds_the_law(printed, tmp_path):
    text = printed("parameter_study")
    assert abs(number(r"gravity\)\^(\S+);", text) - 1) < 0.01  # 0.996
    assert number(r"differ by up to (\S+) %", text) < 9  # 7.2
    rows = (tmp_path / "parameter_study.csv").read_text().splitlines()
    assert len(rows) == 9 and rows[0].startswith("viscosity_pa_s,gravity_m_s2,arrival_s")


def test_torque_goes_with_viscosity_and_speed(printed):
    text = printed("stirred_tank")
    assert abs(number(r"formula .* error (\S+) %", text)) < 9  # 6.0
    assert abs(number(r"speed\)\^(\S+);", text) - 1) < 0.02  # 1.003
    assert number(r"over both it differs by up to (\S+) %", text) < 5  # 2.7


def test_controller_keeps_the_bead_even(printed):
    text = printed("controller")
    assert number(r"controller: .* nozzle (\S+) m from", text) < 1e-9  # the program follows
    assert number(r"particles are (\S+) m apart", text) < 1e-5  # 7e-7: its case is what was done
    assert number(r"the error (\S+) times smaller", text) > 1.7  # 2.6


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_are_those_of_the_scripts(notebooks, name):
    import nbformat

    kept = nbformat.read(EXAMPLES / "notebooks" / f"{name}.ipynb", as_version=4)
    made = notebooks.notebook_of(EXAMPLES / f"{name}.py")
    assert [(c.cell_type, c.source) for c in kept.cells] == [(c.cell_type, c.source) for c in made.cells], (
        "out of date: run examples/make-notebooks"
    )
    pictures = [o for c in kept.cells if c.cell_type == "code" for o in c.outputs if "image/png" in o.get("data", {})]
    assert len(pictures) == 1

"""Cases that several tests share: a few hundred particles each."""

import copy
import os
import sys
from pathlib import Path

import pytest

os.environ.setdefault("OMP_NUM_THREADS", "1")  # ctest runs tests side by side
os.environ["TREACLE_PYTHON"] = sys.executable  # for commands of the program that are Python

DROP_TOML = """title = "A drop"
dimensions = 2
spacing = 1e-3
domain = {min = [-0.03, -0.005], max = [0.03, 0.03]}
gravity = {acceleration = [0, -9.81]}
time = {step = 1e-3, end = 0.02}
output = {interval = 0.01, balance = true}
material = [
  {name = "honey", density = 1400, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6},
]
body = [
  {name = "drop", type = "fluid", material = "honey", shape = "sphere", center = [0, 0.01], radius = 0.008},
  {name = "floor", type = "wall", material = "honey", shape = "box", min = [-0.03, -0.005], max = [0.03, 0]},
]
probe = [
  {name = "all", type = "region"},
  {name = "load", type = "load", body = "floor"},
  {name = "way-up", type = "line", from = [0, 0], to = [0, 0.02], count = 3, interval = 0.01},
]
"""

DROP = {
    "title": "A drop",
    "dimensions": 2,
    "spacing": 1e-3,
    "domain": {"min": [-0.03, -0.005], "max": [0.03, 0.03]},
    "gravity": {"acceleration": [0, -9.81]},
    "time": {"step": 1e-3, "end": 0.02},
    "output": {"interval": 0.01, "balance": True},
    "material": [
        {"name": "honey", "density": 1400, "dynamic_viscosity": 10, "bulk_viscosity": 1e4, "bulk_modulus": 1e6}
    ],
    "body": [
        {
            "name": "drop",
            "type": "fluid",
            "material": "honey",
            "shape": "sphere",
            "center": [0, 0.01],
            "radius": 0.008,
        },
        {
            "name": "floor",
            "type": "wall",
            "material": "honey",
            "shape": "box",
            "min": [-0.03, -0.005],
            "max": [0.03, 0],
        },
    ],
    "probe": [
        {"name": "all", "type": "region"},
        {"name": "load", "type": "load", "body": "floor"},
        {"name": "way-up", "type": "line", "from": [0, 0], "to": [0, 0.02], "count": 3, "interval": 0.01},
    ],
}


@pytest.fixture
def drop_file(tmp_path: Path) -> Path:
    path = tmp_path / "drop.toml"
    path.write_text(DROP_TOML)
    return path


@pytest.fixture
def drop() -> dict:
    """The same case."""
    return copy.deepcopy(DROP)


@pytest.fixture
def warm_drop(drop: dict) -> dict:
    """With temperatures, which the viscosity follows."""
    drop["heat"] = {"ambient_temperature": 293}
    drop["material"][0] |= {
        "specific_heat": 2000,
        "conductivity": 0.5,
        "viscosity_shift": {"model": "arrhenius", "reference_temperature": 300, "activation_energy": 5e4},
    }
    drop["body"][0]["temperature"] = 300
    drop["body"][1]["temperature"] = 350
    return drop


@pytest.fixture(scope="module")
def flat(tmp_path_factory):
    """Directory of a run in two dimensions that films and reports are made of."""
    from picture_runs import flat_run

    return flat_run(tmp_path_factory.mktemp("flat") / "run")


@pytest.fixture(scope="module")
def solid(tmp_path_factory):
    """The same in three dimensions."""
    from picture_runs import solid_run

    return solid_run(tmp_path_factory.mktemp("solid") / "run")


@pytest.fixture(scope="module")
def continued(tmp_path_factory):
    """Directories of a run and of one that has the same states in two parts."""
    from picture_runs import continued_runs

    return continued_runs(tmp_path_factory.mktemp("continued"), DROP_TOML)

"""Cases as files, dicts and dataclasses: the same cases, the same checks, the same messages."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import treacle
from treacle import cases

ROOT = Path(__file__).parents[2]


def test_file_dict_and_dataclass_are_the_same_case(drop_file, drop):
    material, probes = drop["material"][0], drop["probe"]
    case = treacle.Case(
        title="A drop",
        dimensions=2,
        spacing=1e-3,
        domain=cases.Domain(min=[-0.03, -0.005], max=[0.03, 0.03]),
        gravity=cases.Gravity(acceleration=(0, -9.81)),
        time=cases.Time(step=1e-3, end=0.02),
        output=cases.Output(interval=0.01, balance=True),
        material=[cases.Material(**material)],
        body=[cases.Body(**body) for body in drop["body"]],
        probe=[
            cases.Probe(**{"from_" if key == "from" else key: value for key, value in probe.items()})
            for probe in probes
        ],
    )
    texts = [treacle.Simulation(one, backend="cpu").case_text for one in (drop_file, str(drop_file), drop, case)]
    assert len(set(texts)) == 1


def test_numbers_of_numpy_and_paths_are_taken(drop):
    drop["spacing"] = np.float64(1e-3)
    drop["dimensions"] = np.int64(2)
    drop["domain"]["min"] = np.array([-0.03, -0.005])
    drop["title"] = Path("a drop")
    assert 'title = "a drop"' in treacle.Simulation(drop, backend="cpu").case_text


def test_strange_names_survive(drop):
    drop["title"] = 'a "drop" \\ of\nhöney \x01 \x7f 🍯'
    drop["material"][0]["name"] = drop["body"][0]["material"] = drop["body"][1]["material"] = 'honey "dark", no. 1'
    sim = treacle.Simulation(drop, backend="cpu")
    assert sim.title == drop["title"]
    assert sim.materials == ['honey "dark", no. 1']


def test_resolution_and_overrides(drop_file):
    sim = treacle.Simulation.from_file(drop_file, backend="cpu", resolution=2)
    assert sim.spacing == 0.5e-3
    for overrides in ({"time.end": 1, "honey.dynamic_viscosity": 5.0}, ["time.end=1", "honey.dynamic_viscosity=5"]):
        sim = treacle.Simulation.from_file(drop_file, backend="cpu", overrides=overrides)
        assert sim.end == 1
        assert set(sim.fluid.viscosities) == {5.0}


def test_error_in_a_file_has_file_line_column_and_key(drop_file):
    drop_file.write_text(drop_file.read_text().replace("spacing = 1e-3", "spacing = -1e-3"))
    with pytest.raises(treacle.InputError, match="expected a positive number") as error:
        treacle.Simulation.from_file(drop_file)
    e = error.value
    assert (e.file, e.line, e.column, e.key) == (str(drop_file), 3, 11, "spacing")
    assert str(e).startswith(f"{drop_file}:3:11: spacing")
    assert isinstance(e, ValueError)


def test_errors_of_files(drop_file, tmp_path):
    with pytest.raises(treacle.InputError, match="no such case file") as error:
        treacle.Simulation.from_file(tmp_path / "none.toml")
    assert (error.value.file, error.value.line) == (str(tmp_path / "none.toml"), None)
    drop_file.write_text("dimensions = = 2")
    with pytest.raises(treacle.InputError, match="not valid TOML") as error:
        treacle.Simulation.from_file(drop_file)
    assert error.value.line == 1
    drop_file.write_text("dimension = 2")
    with pytest.raises(treacle.InputError, match="did you mean 'dimensions'") as error:
        treacle.Simulation.from_file(drop_file)
    assert (error.value.line, error.value.key) == (1, "dimension")


def test_errors_in_a_dict_are_those_of_a_file_without_the_place(drop_file, drop):
    for key, value, toml in (("radius", -1, "-1"), ("radius", "wide", '"wide"'), ("shape", "blob", '"blob"')):
        changed = drop_file.with_name("changed.toml")
        was = "0.008" if key == "radius" else '"sphere"'
        changed.write_text(drop_file.read_text().replace(f"{key} = {was}", f"{key} = {toml}"))
        with pytest.raises(treacle.InputError) as of_file:
            treacle.Simulation(changed)
        wrong = {**drop, "body": [{**drop["body"][0], key: value}, drop["body"][1]]}
        with pytest.raises(treacle.InputError) as of_dict:
            treacle.Simulation(wrong)
        assert str(of_file.value).endswith(f": {of_dict.value}")
        assert of_dict.value.key == key
        assert of_dict.value.file is None
        assert "[[body]] 'drop'" in str(of_dict.value)


def test_errors_of_overrides_and_arguments(drop):
    for arguments, message in (
        ({"overrides": {"honey.densty": 1}}, "overrides honey.densty=1: unknown key 'densty'"),
        ({"overrides": ["nonsense"]}, "expected key=value"),
        ({"overrides": "time.end=1"}, "expected a dict or a list"),
        ({"backend": "gpu"}, "backend: expected 'auto', 'cpu' or 'cuda', found 'gpu'"),
        ({"precision": "half"}, "precision: expected 'mixed' or 'double', found 'half'"),
        ({"overrides": 3}, "expected a dict or a list"),
        ({"backend": None}, "backend: expected a string, found None"),
        ({"precision": 64}, "precision: expected a string, found 64"),
        ({"resolution": 0}, "expected a positive number"),
    ):
        with pytest.raises(treacle.InputError) as error:
            treacle.Simulation(drop, **arguments)
        assert message in str(error.value)


def test_misspelt_attributes_are_refused():
    body = cases.Body(name="drop")
    with pytest.raises(AttributeError, match="Body has no attribute 'rotaton'; did you mean 'rotation'"):
        body.rotaton = cases.Rotation(speed=1)
    body.rotation = cases.Rotation(speed=1)
    assert body == cases.Body(name="drop", rotation=cases.Rotation(speed=1))


def test_values_that_toml_does_not_have(drop):
    drop["domain"]["min"] = [object(), 0]
    with pytest.raises(treacle.InputError, match=r"domain.min: expected a number.*found object"):
        treacle.Simulation(drop)
    with pytest.raises(treacle.InputError, match="expected a whole number of at most 64 bits"):
        treacle.Simulation({"dimensions": 2**80})
    with pytest.raises(treacle.InputError, match="expected keys that are strings"):
        treacle.Simulation({2: 3})


@pytest.mark.parametrize("script", ["python-cases", "python-types"])
def test_files_that_scripts_write_are_up_to_date(script):
    """A key that is new in the program, or a new function of the module, is missing until the script has been run."""
    checked = subprocess.run(
        [sys.executable, ROOT / "scripts" / script, "--check"], capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stderr


def test_tables_name_the_keys_of_every_case_of_the_repository():
    """The dataclasses take every case there is: no key of theirs is missing."""
    import tomllib

    fields = {
        name: {f.rstrip("_") for f in cls.__dataclass_fields__}
        for name, cls in vars(cases).items()
        if hasattr(cls, "__dataclass_fields__")
    }
    of = {"material": "Material", "body": "Body", "outflow": "Outflow", "opening": "Opening", "probe": "Probe"}
    seen = 0
    for path in sorted((ROOT / "cases").glob("**/*.toml")):
        case = tomllib.loads(path.read_text())
        assert set(case) <= fields["Case"], path
        for table, name in of.items():
            for entry in case.get(table, []):
                assert set(entry) <= fields[name], path
                seen += 1
    assert seen > 50

"""Pictures of curves: histories, probes and compared solvers."""

import math
import os
import subprocess

import pytest

pytest.importorskip("numpy")
pytest.importorskip("matplotlib", reason="curves need pip install '.[pictures]'")

import numpy as np
from matplotlib import image
from picture_runs import called, copied, program, run
from treacle.pictures import curve_maker, panels
from treacle.pictures.errors import PictureError

BLUE, ORANGE, PURPLE = (0x21, 0x5C, 0x99), (0xD9, 0x6B, 0x14), (0x6B, 0x33, 0x85)

PROBES = """probe = [
  {name = "corner", type = "point", point = [1e-3, 1e-3]},
  {name = "profile", type = "line", from = [0, 2e-3], to = [8e-3, 2e-3], interval = 1e-2},
  {name = "cut", type = "plane", corner = [0, 0], along = [6e-3, 0], up = [0, 6e-3], columns = 4, interval = 2e-2},
  {name = "one-row", type = "plane", corner = [0, 1e-3], along = [6e-3, 0], up = [0, 6e-3], rows = 1, interval = 2e-2},
  {name = "dry", type = "plane", corner = [11e-3, 8e-3], along = [1e-3, 0], up = [0, 1e-3], interval = 2e-2},
  {name = "level", type = "height", from = [1e-3, 0], to = [1e-3, 10e-3]},
  {name = "through", type = "flow", point = [5e-3, 0], normal = [3, 0]},
  {name = "all", type = "region"},
  {name = "floor-load", type = "load", body = "floor", interval = 1e-2},
]
"""

CASE = """title = "Small"
dimensions = 2
spacing = 1e-3
domain = {min = [-4e-3, -4e-3], max = [12e-3, 16e-3]}
gravity = {acceleration = [0, -10]}
time = {step = 1e-3, end = 0.04}
output = {interval = 0.02}
material = [{name = "syrup", density = 1000, dynamic_viscosity = 10, bulk_viscosity = 1e4, bulk_modulus = 1e6}]
body = [
  {name = "column", type = "fluid", material = "syrup", shape = "box", min = [0, 0], max = [6e-3, 6e-3]},
  {name = "floor", type = "wall", material = "syrup", shape = "box", min = [-4e-3, -4e-3], max = [12e-3, 0]},
]
"""


@pytest.fixture(scope="module")
def probed(tmp_path_factory):
    """A run with probes of every type."""
    folder = tmp_path_factory.mktemp("probed")
    (folder / "case.toml").write_text(CASE + PROBES)
    return run(folder / "case.toml", folder / "run")


def treacle(*words, **more):
    """The program, as users call it. more: of its environment."""
    return subprocess.run([program(), *map(str, words)], capture_output=True, text=True, env=os.environ | more)


def pixels(path):
    """Rows, columns, colours from 0 to 255."""
    return (image.imread(path)[..., :3] * 255).round().astype(int)


def places(picture, color):
    """Rows and columns that are near a colour."""
    return np.nonzero(np.abs(picture - color).max(axis=2) <= 5)


def test_history(flat):
    done = treacle("plot", flat, "--history")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{flat}/history.png\n", "")
    picture = pixels(flat / "history.png")
    assert picture.shape[1] == 1200
    # The curves of five panels run from the left to the right.
    rows, columns = places(picture, BLUE)
    for panel in range(5):
        top, bottom = (len(picture) * k // 5 for k in (panel, panel + 1))
        assert np.ptp(columns[(rows >= top) & (rows < bottom)]) > 900
    assert len(places(picture, ORANGE)[0]) > 900  # the top of the fluid
    assert not list(flat.glob("*.tmp"))


def test_history_panels(flat):
    table = curve_maker.read_numbers(flat / "history.csv", "step")
    found = {panel.label: panel for panel in curve_maker.history_panels(table)}
    assert list(found) == ["iterations", "kinetic energy", "potential energy", "extent", "largest speed"]
    assert found["kinetic energy"].unit == "J"
    ((_, time, energy),) = found["kinetic energy"].curves
    assert list(time) == list(table["time"]) and list(energy) == list(table["kinetic_energy"])
    assert [(name, list(y)) for name, _, y in found["extent"].curves] == [
        ("front x", list(table["front_x"])),
        ("top", list(table["top"])),
    ]


def test_history_of_an_inflow_has_both_masses(tmp_path):
    inflow = (
        '  {name = "tap", type = "inflow", material = "syrup", speed = 0.1, '
        'nozzle = {shape = "rectangle", center = [3e-3, 8e-3], direction = [0, -1], width = 2e-3}},\n]\n'
    )
    (tmp_path / "case.toml").write_text(CASE[: CASE.rindex("]")] + inflow)
    directory = run(tmp_path / "case.toml", tmp_path / "run")
    table = curve_maker.read_numbers(directory / "history.csv", "step")
    panel = curve_maker.history_panels(table)[-1]
    assert (panel.label, panel.unit) == ("mass in and out", "kg")
    assert [name for name, _, _ in panel.curves] == ["in", "out"] and panel.curves[0][2][-1] > 0
    assert treacle("plot", directory, "--history", "-o", tmp_path / "a.png").returncode == 0


def test_every_probe_is_drawn(probed):
    for name in ("corner", "profile", "cut", "one-row", "level", "through", "all", "floor-load"):
        file = probed / "probes" / f"{name}.png"
        if name == "corner":
            done = treacle("plot", probed, "--probe", name)
        else:
            done = called("plot", probed, "--probe", name, "-o", file)
        assert (done.returncode, done.stdout, done.stderr) == (0, f"{file}\n", "")
        picture = pixels(file)
        assert picture.shape[1] == 1200 and len(np.unique(picture.reshape(-1, 3), axis=0)) > 20
    assert "found 'levle'" in treacle("plot", probed, "--probe", "levle").stderr
    done = treacle("plot", probed, "--probe", "dry")
    assert done.returncode == 2 and done.stderr == "treacle: error: no fluid is in the plane at t = 0.04 s\n"
    assert not (probed / "probes" / "dry.png").exists()


def test_probe_panels(probed):
    table = curve_maker.read_numbers(probed / "probes" / "corner.csv", "time")
    velocity, pressure = curve_maker.probe_panels(table, [("", "time", slice(None))])
    assert (velocity.label, velocity.unit, pressure.label, pressure.unit) == ("velocity", "m/s", "pressure", "Pa")
    assert [name for name, _, _ in velocity.curves] == ["x", "y"] and len(pressure.curves[0][2]) == 41
    table = curve_maker.read_numbers(probed / "probes" / "profile.csv", "time")
    velocity, pressure = curve_maker.probe_panels(table, curve_maker.profiles_of(table))
    assert [name for name, _, _ in pressure.curves] == ["0 s", "0.01 s", "0.02 s", "0.04 s"]
    assert velocity.curves[-1][0] == "y, 0.04 s"
    _, distance, last = pressure.curves[-1]
    assert len(distance) == 9 and list(last[:3]) == list(table["pressure"][-9:-6])


def test_plane_has_the_colours_of_its_field(probed, monkeypatch, tmp_path):
    drawn = []
    monkeypatch.setattr(curve_maker, "draw_plane", lambda *words: drawn.append(words))
    table = curve_maker.read_numbers(probed / "probes" / "cut.csv", "time")
    for field in "speed", "pressure":
        done = called("plot", probed, "--probe", "cut", "--field", field, "-o", tmp_path / "a.png")
        assert done.returncode == 0, done.stderr
    (_, title, remark, (across, up, speed), label, least), (*_, (_, _, pressure), _, _) = drawn
    assert (title, remark, label, least) == ("Small: cut", "t = 0.04 s", "speed [m/s]", 0)
    assert speed.shape == (7, 4)
    assert across[0] == pytest.approx([0, 2e-3, 4e-3, 6e-3]) and up[:, 1] == pytest.approx(np.arange(7) * 1e-3)
    last = {name: values[-28:].reshape(7, 4) for name, values in table.items()}
    expected = np.hypot(last["velocity_x"], last["velocity_y"])
    there = np.isfinite(last["pressure"])
    assert there.any() and np.allclose(speed[there], expected[there], rtol=1e-14) and np.isnan(speed[~there]).all()
    assert np.array_equal(pressure[there], last["pressure"][there])
    done = called("plot", probed, "--probe", "cut", "--field", "temperature", "-o", tmp_path / "a.png")
    assert done.returncode == 2 and "--field temperature: probe 'cut' has not read it" in done.stderr


def test_convergence(tmp_path):
    (tmp_path / "small.toml").write_text(CASE)
    solver = "preconditioner=none precision=double"
    words = ["convergence", tmp_path / "small.toml", "-o", tmp_path / "here", "--solver", "", "--solver", solver]
    done = treacle(*words, "--backend", "cpu", "--threads", "1")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith(f"\npicture: {tmp_path}/here/convergence.png\n")
    picture = pixels(tmp_path / "here" / "convergence.png")
    assert picture.shape[1] == 1200
    for color in BLUE, ORANGE:
        assert len(places(picture, color)[0]) > 500
    curves = curve_maker.residuals_of(tmp_path / "here")
    assert len(curves) == 2 and all(residuals[-1] <= 1e-6 for _, residuals in curves)
    assert curves[1][0].startswith("cr, none, double: ") and f"{len(curves[1][1]) - 1} iterations, " in curves[1][0]


def test_residuals_are_on_a_logarithmic_axis(tmp_path):
    panels.draw_residuals(tmp_path / "a.png", [("a", [1, 0.1, 1e-7]), ("b", [1e-3, 1e-4, 1e-4])], "Test", "step 1")
    picture = pixels(tmp_path / "a.png")[:500]
    (blue, _), (orange, _) = places(picture, BLUE), places(picture, ORANGE)
    seven = np.ptp(blue)  # decades
    assert seven > 300
    assert (orange.min() - blue.min()) / seven == pytest.approx(3 / 7, abs=0.03)
    assert np.ptp(orange) / seven == pytest.approx(1 / 7, abs=0.04)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "residuals", [[], [math.nan], [0], [1], [1, math.nan], [1, 0], [math.inf, 1e-300], [3, 3], [0.5] * 20000]
)
def test_residuals_that_a_logarithm_cannot_show(tmp_path, residuals):
    panels.draw_residuals(tmp_path / "a.png", [("none", residuals)], "", "")
    assert pixels(tmp_path / "a.png").shape[1] == 1200


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("a", [1.7e308, -1.7e308, 1e150, 5e-324, 1e-310, 1e16, math.inf, math.nan, 0.0])
def test_curves_of_all_numbers(tmp_path, a):
    others = [-1.7e308, 1e150, 3e-320, 1e16 + 4, -math.inf, math.nan, 0.0]
    shown = [panels.Panel("a", "m", [("", [0, 1, 2], [a, b, a])]) for b in others]
    panels.draw_panels(tmp_path / "a.png", "", "time [s]", shown)
    panels.draw_panels(tmp_path / "a.png", "", "time [s]", [panels.Panel("t", "", [("", [0, a], [1, 2])])])
    assert pixels(tmp_path / "a.png").shape[1] == 1200


def test_long_histories_are_drawn_from_end_to_end(tmp_path):
    for count in (1, 2, 200, 100000):
        x = np.arange(1, count + 1) / count
        panels.draw_panels(
            tmp_path / "a.png", "$Test$ % _", "time [s]", [panels.Panel("a", "", [("", x, np.sin(8 * x))])]
        )
        columns = np.unique(places(pixels(tmp_path / "a.png"), BLUE)[1])
        assert len(columns) > (1000 if count > 1 else 3)


@pytest.mark.parametrize(
    "text, message",
    [
        ("", ":1: expected a header, time,…, found ''"),
        ("step,time\n", ":1: expected a header, time,…, found 'step,time'"),
        ("time,a\n1,2\n1\n", ":3: expected 2 numbers, found '1'"),
        ("time,a\n1,x\n", ":2: expected 2 numbers, found '1,x'"),
        ("time,a\n1,2,3\n", ":2: expected 2 numbers, found '1,2,3'"),
    ],
)
def test_tables_that_are_refused(tmp_path, text, message):
    path = tmp_path / "probe.csv"
    path.write_text(text)
    with pytest.raises(PictureError) as error:
        curve_maker.read_numbers(path, "time")
    assert str(error.value) == f"{path}{message}"


def test_a_last_line_that_is_not_whole_is_left_out(tmp_path):
    (tmp_path / "probe.csv").write_text("time,a\n1,nan\n2,3\n4")
    table = curve_maker.read_numbers(tmp_path / "probe.csv", "time")
    assert list(table["time"]) == [1, 2] and math.isnan(table["a"][0])


def test_what_cannot_be_drawn(flat, tmp_path):
    copy = copied(flat, tmp_path / "run")
    history = (copy / "history.csv").read_text()
    (copy / "history.csv").write_text(history[: history.index("\n") + 1])
    done = called("plot", copy, "--history", "-o", tmp_path / "a.png")
    assert done.returncode == 2 and "history.csv: the history holds no steps" in done.stderr
    (copy / "history.csv").unlink()
    done = called("plot", copy, "--history", "-o", tmp_path / "a.png")
    assert done.returncode == 2 and done.stderr.endswith("history.csv: No such file or directory\n")
    done = called("plot", flat, "--history", "-o", tmp_path / "none" / "a.png")
    assert done.returncode == 3 and "none/a.png: No such file or directory" in done.stderr
    done = called("plot", tmp_path, "--convergence", "-o", tmp_path / "a.png")
    assert done.returncode == 2 and done.stderr.endswith("solvers.csv: No such file or directory\n")
    assert not (tmp_path / "a.png").exists()


def test_says_what_to_install(flat, tmp_path):
    """Without Matplotlib curves are refused; solvers are compared nevertheless."""
    (tmp_path / "matplotlib.py").write_text("raise ImportError(\"No module named 'matplotlib'\")\n")
    (tmp_path / "small.toml").write_text(CASE)
    path = f"{tmp_path}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
    done = treacle("plot", flat, "--history", PYTHONPATH=path)
    assert done.returncode == 2
    assert done.stderr.startswith("treacle: error: No module named 'matplotlib'; ")
    assert "pip install '.[pictures]'" in done.stderr
    done = treacle("convergence", tmp_path / "small.toml", "-o", tmp_path / "here", "--solver", "", PYTHONPATH=path)
    assert done.returncode == 0 and "convergence.png is not drawn: No module named 'matplotlib'; " in done.stderr
    assert (tmp_path / "here" / "solvers.csv").is_file() and not (tmp_path / "here" / "convergence.png").exists()

"""Reports of runs: one page that needs nothing else, and what is on it."""

import base64
import json
import re
import shutil
import subprocess
import zlib

import pytest

for package in ("numpy", "vtk", "plotly", "tqdm"):
    pytest.importorskip(package, reason="reports need pip install '.[pictures]'")

import numpy as np
from picture_runs import called, copied, run
from treacle.pictures import particles, report_curves, report_frames


def reported(directory, *options, before=()):
    """The page of a run without the library, and its data. before: directories of what it continued."""
    done = called("report", *before, directory, *options)
    assert done.returncode == 0, done.stderr
    page = (directory / "report.html").read_text()
    before, after = re.split(r"<script>/\*\*\n\* plotly\.js.*?</script>", page, flags=re.S)
    data = re.search(r'<script type="application/json" id="data">(.*?)</script>', after, re.S)[1]
    return before + after, json.loads(data)


def positions(view, frame, dimensions):
    """Of a frame as the page unpacks them."""
    values = zlib.decompress(base64.b64decode(frame["data"]))
    levels = np.frombuffer(values, "<u2", dimensions * frame["count"]).reshape(dimensions, -1).T
    low, high = np.array(view["low"])[:dimensions], np.array(view["high"])[:dimensions]
    return low + (high - low) * levels / 65535


def test_one_file_with_all_parts(flat):
    page, data = reported(flat)
    assert "http" not in page and "<link" not in page and " src=" not in page and "@import" not in page
    for words in (
        "High-viscosity dam break, 2D",
        ">done<",
        "<th>Fluid particles</th><td>400</td>",
        "MPH-I, accurate scheme, 2D",
        "treacle 0.2.0",
        "bulk_modulus = 1000000",
    ):
        assert words in page
    titles = [chart["title"] for chart in data["charts"]]
    assert titles[:4] == ["Energy", "Front and top", "Largest speed", "Iterations per step"]
    assert {"Where the energy went", "Power", "Force on walls"} <= set(titles)
    assert len(data["view"]["frames"]) == 4 and [field["name"] for field in data["view"]["fields"]][:2] == [
        "speed [m/s]",
        "pressure [Pa]",
    ]
    assert dict(data["phases"]).keys() <= {"search", "lists", "coefficients", "coarse", "solve", "update", "output"}
    assert not list(flat.glob(".report*"))


def test_positions_are_those_of_the_frames(flat):
    _, data = reported(flat)
    view = data["view"]
    frame = particles.read_particles(flat / "frames" / "fluid_000003.vtp")
    assert view["unit"] == "mm" and view["frames"][3]["time"] == 0.03
    np.testing.assert_allclose(positions(view, view["frames"][3], 2), 1e3 * frame.positions[:, :2], atol=60 / 65535)


def test_energy_is_accounted_for(flat):
    _, data = reported(flat)
    curves = {
        curve["name"]: curve["y"]
        for chart in data["charts"]
        if chart["title"] == "Where the energy went"
        for curve in chart["curves"]
    }
    moved = max(abs(value) for value in curves["potential energy"])
    assert max(abs(value) for value in curves["not accounted for"]) < 1e-4 * moved
    assert curves["shear dissipation"][-1] > 0.1 * moved


def test_thinned_frames_keep_their_particles(solid):
    page, data = reported(solid, "--max-points", "200", "--frames", "2")
    view = data["view"]
    count = len(particles.read_particles(solid / "frames" / "fluid_000000.vtp"))
    assert "2 of 3 frames; of 1,000 fluid particles 20 % are shown" in page and count == 1000
    assert [frame["time"] for frame in view["frames"]] == [0, 0.004]
    assert 140 < view["frames"][0]["count"] == view["frames"][1]["count"] < 260
    a, b = (positions(view, frame, 3) for frame in view["frames"])
    assert 0 < np.abs(a - b).max() < 2  # the same particles, which have hardly moved [mm]
    assert report_frames.kept(np.arange(100000), 0.3).mean() == pytest.approx(0.3, abs=0.01)


def test_probes_inflow_and_log(tmp_path):
    directory = run("bottle.toml", tmp_path / "run", "--end-time", "0.03", "--set", "resolution=0.5")
    page, data = reported(directory)
    assert "<th>Fluid particles at the end</th>" in page
    titles = [chart["title"] for chart in data["charts"]]
    assert "Fluid particles" in titles and any(title.startswith("Probe ") for title in titles)
    assert "Where the energy went" not in titles  # no balance


def rows(page):
    """The table of a page without what depends on the machine, or is of files."""
    found = dict(re.findall(r"<tr><th>(.*?)</th><td>(.*?)</td>", page))
    return {name: value for name, value in found.items() if name not in ("Wall-clock time", "Memory", "Frames")}


def test_two_parts_of_a_run_are_one(continued, tmp_path):
    page, data = reported(continued.second, before=[continued.first])
    whole_page, whole = reported(continued.whole)
    assert [frame["time"] for frame in data["view"]["frames"]] == [0, 0.01, 0.02, 0.03, 0.04]
    assert data["view"] == whole["view"]
    titles = [chart["title"] for chart in whole["charts"]]
    assert {"Energy", "Where the energy went", "Probe load: force", "Probe way-up: speed"} <= set(titles)
    assert [chart["title"] for chart in data["charts"]] == titles
    for part, chart in zip(data["charts"], whole["charts"], strict=True):
        if chart["title"] != "Computing time per step":
            assert part == chart, chart["title"]  # to the bit, since the states are
    energy = data["charts"][0]["curves"][0]["x"]
    np.testing.assert_allclose(energy, np.arange(1, 41) * 1e-3, rtol=1e-12)  # each step once
    assert rows(page) == rows(whole_page) and rows(page)["Steps"] == "40"
    assert f"{continued.first} → {continued.second}" in page
    seconds = [
        json.loads((part / "summary.json").read_text())["wall_seconds"] for part in (continued.first, continued.second)
    ]
    assert f"<th>Wall-clock time</th><td>{sum(seconds):.3g} s" in page

    killed = copied(continued.first, tmp_path / "killed")
    (killed / "summary.json").unlink()
    page, data = reported(continued.second, before=[killed])
    assert rows(page) == rows(whole_page) and "<th>Wall-clock time</th>" not in page and data["phases"] == []


@pytest.mark.parametrize(
    "order, said",
    [
        (["second", "first"], "begins at 0 s, not after"),
        (["first", "first"], "begins at 0 s, not after"),
        (["flat", "second"], "has other dimensions or another spacing"),
        (["gap", "second"], "begins at 0.02 s, "),
    ],
)
def test_runs_that_do_not_continue_each_other(continued, flat, tmp_path, order, said):
    gap = copied(continued.first, tmp_path / "gap")
    for name, lines in (("fluid.pvd", 5), ("history.csv", 11)):  # to 0.01 s
        kept = (gap / name).read_text().splitlines()[:lines]
        (gap / name).write_text("\n".join(kept + ["</Collection></VTKFile>"] * (name == "fluid.pvd")) + "\n")
    places = {"first": continued.first, "second": continued.second, "flat": copied(flat, tmp_path / "flat"), "gap": gap}
    case = places["flat"] / "case.toml"
    case.write_text(re.sub(r"(?m)^spacing = .*", "spacing = 2e-3", case.read_text()))
    done = called("report", *[places[name] for name in order])
    assert done.returncode == 2 and said in done.stderr and "by --resume" in done.stderr


def test_run_that_goes_on(flat, tmp_path):
    directory = copied(flat, tmp_path / "run")
    (directory / "summary.json").unlink()
    with open(directory / "history.csv", "a") as file:
        file.write("31,0.031,0.0")  # half a row
    (directory / "run.log").open("a").write("2026-01-01 00:00:00.000 warning: <b>hot</b> & sticky\n")
    page, data = reported(directory)
    assert ">not ended<" in page and "<th>Steps up to now</th><td>30</td>" in page
    assert "warning: &lt;b&gt;hot&lt;/b&gt; &amp; sticky" in page
    assert data["phases"] == []


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["nowhere"], "nowhere: no such directory"),
        (["RUN", "--frames", "0"], "--frames: expected a whole number from 1 to 1000, found 0"),
        (["RUN", "--max-points", "0"], "--max-points: expected a whole number from 1"),
        (["RUN", "-o", "/no/such/page.html"], "/no/such/page.html: no such directory"),
    ],
)
def test_mistakes(flat, arguments, said):
    done = called("report", *[flat if word == "RUN" else word for word in arguments])
    assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr


def test_thin_curves_keep_their_peaks():
    x = np.arange(100000.0)
    y = np.sin(x / 5000)
    y[31234] = 7
    y[500] = np.nan
    thin_x, thin_y = report_curves.thin(x, y)
    assert len(thin_x) <= report_curves.most_points + 2 and np.all(np.diff(thin_x) > 0)
    assert thin_y.max() == 7 and thin_x[-1] == x[-1]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_page_in_a_browser(dimensions, flat, solid, tmp_path):
    """Without network, a screenshot of it shows the fluid in the colours of its speed."""
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not browser:
        pytest.skip("no Chromium: scripts/setup --pictures installs it")
    image = pytest.importorskip("PIL.Image")
    directory = flat if dimensions == 2 else solid
    reported(directory)
    shot = tmp_path / "page.png"
    command = [browser, "--headless=new", "--no-sandbox", f"--user-data-dir={tmp_path / 'browser'}"]
    command += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # draws without a GPU
    command += ["--proxy-server=127.0.0.1:9", "--host-resolver-rules=MAP * ~NOTFOUND"]  # no network
    command += ["--virtual-time-budget=10000", "--window-size=1000,1900", "--hide-scrollbars"]
    command += [f"--screenshot={shot}", f"file://{directory / 'report.html'}"]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    pixels = np.asarray(image.open(shot).convert("RGB")).astype(int)
    view = pixels[200:640, 40:860]  # without the bar of the colours
    colourful = np.ptp(view, axis=2) > 60
    assert colourful.sum() > 3000
    assert len(np.unique(view[colourful] // 16, axis=0)) > 8
    below = pixels[760:]
    for colour in ([0x25, 0x63, 0xA8], [0xD1, 0x49, 0x5B]):  # bars of the phases, curves of the history
        assert (np.abs(below - colour).max(axis=2) < 12).sum() > 150

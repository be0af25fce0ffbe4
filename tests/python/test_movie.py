"""Films of runs: what is in the pictures, and what is said where there can be none."""

import os
import stat
import subprocess
import sys

import pytest

for package in ("numpy", "vtk", "pyvista", "tqdm", "imageio_ffmpeg"):
    pytest.importorskip(package, reason="films need pip install '.[pictures]'")

import imageio_ffmpeg
import numpy as np
from picture_runs import called, copied, repository, started
from treacle.pictures import camera, fields, hiding, marks, particles
from treacle.pictures.continued_run import run_of
from treacle.pictures.run_files import RunFiles


def pictures(path):
    """Pixels of a film: an array of pictures, rows, columns and colours; and what ffmpeg says of it."""
    film = imageio_ffmpeg.read_frames(str(path))
    about = next(film)
    width, height = about["size"]
    return np.array([np.frombuffer(picture, np.uint8).reshape(height, width, 3) for picture in film]).astype(int), about


def difference(a, b):
    """Mean over all pixels."""
    return np.abs(a - b).mean()


def test_film_of_two_dimensions(flat, tmp_path):
    done = started("movie", flat, "-o", tmp_path / "film.mp4", "--size", "480x270", "--fps", "10")
    assert done.returncode == 0, done.stderr
    assert "4 pictures of 480x270" in done.stdout and "drawing" in done.stderr
    seen, about = pictures(tmp_path / "film.mp4")
    assert about["codec"] == "h264" and "yuv420p" in about["pix_fmt"] and about["fps"] == 10
    assert seen.shape == (4, 270, 480, 3)
    stamp, bar = seen[:, :25, :110], seen[:, 100:210, 412:430]
    for k in range(3):
        assert difference(seen[k], seen[k + 1]) > 0.1
        assert difference(stamp[k], stamp[k + 1]) > 0.3  # another time
        assert difference(bar[k], bar[k + 1]) < 0.3  # the same colours
    assert list(tmp_path.iterdir()) == [tmp_path / "film.mp4"]


@pytest.mark.parametrize("bounds, colour", [("-2e9,-1e9", [253, 231, 37]), ("1e9,2e9", [68, 1, 84])])
def test_range_and_field_say_the_colours(flat, tmp_path, bounds, colour):
    options = ["-q", "-o", tmp_path / "film.mp4", "--field", "pressure", f"--range={bounds}", "--every", "3"]
    done = called("movie", flat, *options)
    assert done.returncode == 0 and done.stdout == done.stderr == ""
    seen, _ = pictures(tmp_path / "film.mp4")
    assert len(seen) == 2
    inside = seen[:, :, 160:1060]  # without the bar of the colours
    coloured = np.ptp(inside, axis=3) > 60
    assert coloured.sum() > 40000
    assert (np.abs(inside[coloured] - colour).max(axis=1) < 12).mean() > 0.5  # but for the edges of the discs


def test_film_of_three_dimensions_and_its_cameras(solid, tmp_path):
    views = []
    for view in ("corner", "front", "20,60,2"):
        done = called(
            "movie",
            solid,
            "-q",
            "-o",
            tmp_path / "film.webm",
            "--size",
            "320x240",
            "--camera",
            view,
            "--from",
            "0.002",
            "--walls",
            "hide",
        )
        assert done.returncode == 0, done.stderr
        seen, about = pictures(tmp_path / "film.webm")
        assert about["codec"] == "vp9" and seen.shape == (2, 240, 320, 3)
        views.append(seen[-1])
    assert difference(views[0], views[1]) > 3 and difference(views[0], views[2]) > 3


def test_walls(solid, tmp_path):
    grey = {}
    for walls in ("show", "hide", "faint"):
        called(
            "movie",
            solid,
            "-q",
            "-o",
            tmp_path / "film.mp4",
            "--size",
            "320x240",
            "--walls",
            walls,
            "--field",
            "none",
            "--to",
            "0",
        )
        picture = pictures(tmp_path / "film.mp4")[0][0]
        coloured = np.ptp(picture, axis=2) > 30
        grey[walls] = (~coloured & (picture.mean(axis=2) < 245)).sum()
        assert coloured.sum() > 1500, walls  # the fluid is never hidden
    assert grey["show"] > 5 * grey["hide"] and grey["faint"] > 5 * grey["hide"]


def test_surface_is_made_where_there_is_none(solid, tmp_path):
    run = copied(solid, tmp_path / "run")
    done = called("movie", run, "-o", tmp_path / "film.mp4", "--size", "320x240", "--surface", "--walls", "hide")
    if "OpenVDB" in done.stderr:
        pytest.skip("the program was built without OpenVDB")
    assert done.returncode == 0, done.stderr
    assert "making surfaces" in done.stderr and (run / "frames" / "surface_000002.vtp").is_file()
    smooth = pictures(tmp_path / "film.mp4")[0]
    assert len(smooth) == 3
    done = called("movie", run, "-o", tmp_path / "again.mp4", "--size", "320x240", "--surface", "--walls", "hide")
    assert "making surfaces" not in done.stderr
    called("movie", run, "-q", "-o", tmp_path / "balls.mp4", "--size", "320x240", "--walls", "hide")
    assert 0.3 < difference(smooth, pictures(tmp_path / "balls.mp4")[0]) < 20  # the same shape, drawn in another way


def test_turntable(solid, tmp_path):
    done = called(
        "movie",
        solid,
        "-q",
        "-o",
        tmp_path / "turn.mp4",
        "--size",
        "320x240",
        "--turntable",
        "last",
        "--walls",
        "hide",
        "--seconds",
        "0.4",
        "--fps",
        "10",
    )
    assert done.returncode == 0, done.stderr
    seen, _ = pictures(tmp_path / "turn.mp4")
    assert len(seen) == 4
    for k in range(4):
        assert difference(seen[k], seen[k - 1]) > 1
        assert difference(seen[k, :22, :80], seen[k - 1, :22, :80]) < 0.5  # the same time


def test_run_that_goes_on(flat, tmp_path):
    run = copied(flat, tmp_path / "run")
    (run / "summary.json").unlink()
    index = (run / "walls.pvd").read_text().splitlines()
    (run / "walls.pvd").write_text("\n".join(index[:5] + index[-2:]))  # that of the walls is written after the fluid's
    (run / "frames" / "fluid_000004.vtp.tmp").write_bytes(b"<VTKFile")
    done = called("movie", run, "--size", "320x240")
    assert done.returncode == 0, done.stderr
    assert len(pictures(run / "movie.mp4")[0]) == 4


def test_nothing_compiled_is_needed():
    """The sources as they are make films; whoever wants more is told how it comes."""
    code = "import treacle.movie, treacle.report\ntry:\n  from treacle import Simulation\nexcept ImportError as error:\n  print(error)"
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONPATH": str(repository / "python")},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "treacle.Simulation needs the compiled part of the package" in done.stdout


def test_film_of_two_parts_of_a_run(continued, tmp_path):
    films = []
    for directories in ([continued.whole], [continued.first, continued.second]):
        done = called("movie", *directories, "-q", "-o", tmp_path / "film.mp4", "--size", "320x240")
        assert done.returncode == 0, done.stderr
        films.append(pictures(tmp_path / "film.mp4")[0])
    assert films[0].shape == films[1].shape == (5, 240, 320, 3)
    assert difference(*films) < 0.01  # 0: the states are the same to the bit
    assert min(difference(films[1][k], films[1][k + 1]) for k in range(4)) > 0.05

    run = run_of([continued.first, continued.second])
    assert [frame.time for frame in run.fluid] == [frame.time for frame in run.walls] == [0, 0.01, 0.02, 0.03, 0.04]
    assert [run.origin(k) for k in range(5)] == [(continued.first, 0), (continued.first, 1)] + [
        (continued.second, k) for k in range(3)
    ]
    assert run.surface_file(3) == continued.second / "frames" / "surface_000001.vtp"
    assert called("movie", *[continued.first, continued.second], "-q", "--size", "320x240").returncode == 0
    assert (continued.second / "movie.mp4").is_file() and not (continued.first / "movie.mp4").exists()


def test_frames_in_pieces(flat, tmp_path):
    run = copied(flat, tmp_path / "run")
    whole = particles.read_particles(run / "frames" / "fluid_000003.vtp")
    arrays = "".join(f'<PDataArray type="{kind}" Name="{name}" NumberOfComponents="{count}"/>' for name, kind, count in
                     (("velocity", "Float32", 3), ("pressure", "Float32", 1), ("id", "UInt32", 1)))  # fmt: skip
    pieces = run / "frames" / "fluid_000003.pvtp"
    pieces.write_text(
        '<?xml version="1.0"?>'
        '<VTKFile type="PPolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        '<PPolyData GhostLevel="0">'
        f"<PPointData>{arrays}</PPointData>"
        '<PPoints><PDataArray type="Float32" Name="position" NumberOfComponents="3"/></PPoints>'
        '<Piece Source="fluid_000003.vtp"/><Piece Source="fluid_000002.vtp"/></PPolyData></VTKFile>'
    )
    both = particles.read_particles(pieces)
    assert len(both) == 2 * len(whole)
    np.testing.assert_array_equal(both.positions[: len(whole)], whole.positions)
    assert RunFiles(run).surface_file(3).name == "surface_000003.vtp"
    index = run / "fluid.pvd"
    index.write_text(index.read_text().replace("fluid_000003.vtp", "fluid_000003.pvtp"))
    assert called("movie", run, "-q", "--size", "320x240", "--from", "0.03").returncode == 0


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["nowhere"], "nowhere: no such directory; expected that of a run"),
        (
            ["RUN", "--field", "colour"],
            "field 'colour': the frames hold speed, pressure, number_density, nearest_distance, material, body, none",
        ),
        (["RUN", "--surface"], "a case of two dimensions, which is seen from the front; expected three for --surface"),
        (["RUN", "--turntable", "0"], "expected three for --turntable"),
        (["RUN", "--camera", "top"], "expected three for --camera"),
        (["RUN", "--size", "321x240"], "--size: expected even numbers, which films need, found '321x240'"),
        (["RUN", "--size", "large"], "--size: expected WIDTHxHEIGHT, found 'large'"),
        (["RUN", "--range", "2,1"], "--range: expected A,B with A less than B, found '2,1'"),
        (["RUN", "--from", "7"], "--from, --to: no frame between them; the run has 4, from 0 to 0.03 s"),
        (["RUN", "--every", "0"], "--every: expected a whole number from 1, found 0"),
        (["RUN", "--fps", "0"], "--fps: expected a number from 0.1 to 240, found 0"),
        (["RUN", "--colormap", "mud"], "--colormap: 'mud' is none of Matplotlib's"),
        (["RUN", "-o", "film.avi"], "film.avi: expected a name that ends in .mp4, .webm, .webp"),
        (["RUN", "-o", "/no/such/film.mp4"], "/no/such/film.mp4: no such directory: /no/such"),
        (["RUN", "--walls", "glass"], "invalid choice: 'glass'"),
    ],
)
def test_mistakes(flat, arguments, said):
    done = called("movie", *[flat if word == "RUN" else word for word in arguments])
    assert done.returncode == 2
    assert said in done.stderr and "Traceback" not in done.stderr
    assert not (flat / "movie.mp4").exists()


@pytest.mark.parametrize(
    "view, said",
    [
        ("behind", "--camera: expected corner|front|"),
        ("0,91", "--camera: expected an elevation from -90 to 90"),
        ("0,0,0", "--camera: expected a zoom"),
    ],
)
def test_cameras_that_are_none(solid, view, said):
    done = called("movie", solid, "--camera", view)
    assert done.returncode == 2 and said in done.stderr


def test_damaged_frames_and_runs_without(flat, tmp_path):
    run = copied(flat, tmp_path / "run")
    frame = run / "frames" / "fluid_000002.vtp"
    frame.write_bytes(frame.read_bytes()[:4000])
    done = called("movie", run, "--size", "320x240")
    assert done.returncode == 2 and "fluid_000002.vtp: cannot be read" in done.stderr
    frame.unlink()
    assert "fluid_000002.vtp: no such file" in called("movie", run).stderr
    (run / "fluid.pvd").unlink()
    assert "the run has no frame" in called("movie", run).stderr
    assert not list(run.glob("*mp4*"))


def test_ffmpeg_that_fails(flat, tmp_path, monkeypatch):
    broken = tmp_path / "bin" / "ffmpeg"
    broken.parent.mkdir()
    broken.write_text("#!/bin/sh\necho 'no such encoder' >&2\nexit 7\n")
    broken.chmod(broken.stat().st_mode | stat.S_IEXEC)
    monkeypatch.setenv("PATH", f"{broken.parent}:{os.environ['PATH']}")
    done = called("movie", flat, "-o", tmp_path / "film.mp4", "--size", "1280x720")
    assert done.returncode == 2 and "film.mp4: ffmpeg ended with code 7: no such encoder" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bin"]


def test_gravity_points_down_from_everywhere():
    for gravity in ([0, 0, -9.81], [0, -10, 0], [9.81, 0.1, 0], [0, 0, 0]):
        for azimuth in (0, 34, 120, 250):
            view = camera.View.of(camera.Direction(azimuth, 26), np.array(gravity, float))
            np.testing.assert_allclose(view.axes @ view.axes.T, np.eye(3), atol=1e-12)
            assert np.linalg.det(view.axes) == pytest.approx(1)
            right, up, _ = view.axes @ gravity
            assert np.any(gravity) == (up < -1) and abs(right) <= 0.1
    front = camera.View.of(camera.Direction(0, 0), np.array([0, 0, -9.81])).axes
    np.testing.assert_allclose(front, [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-12)


def test_what_can_be_seen():
    column = np.array([[0.5, 0.5, z] for z in range(20)] + [[1.5, 0.5, -3.0]], float)
    assert sorted(hiding.seen(column, 1.0)) == [*range(12, 21)]
    behind = hiding.FluidBehind(1.0)
    behind.add(np.array([[0.5, 0.5, 0.0]]))
    walls = np.array([[0.6, 0.4, 5.0], [0.6, 0.4, -5.0], [7.0, 7.0, 5.0], [1.5, -0.5, 5.0]])
    assert behind.hidden_by(walls).tolist() == [True, False, False, True]
    assert not hiding.FluidBehind(1.0).hidden_by(walls).any()


def test_ranges_and_ticks():
    found = fields.Range("pressure")
    found.add(np.append(np.linspace(-1, 1, 999), 1e9))  # one particle of a splash
    assert found.bounds()[1] < 1.1 and found.bounds()[0] < -0.9
    constant = fields.Range("temperature")
    constant.add(np.full(5, 300.0))
    assert constant.bounds()[0] == 300 < constant.bounds()[1]
    assert fields.Range("speed").bounds() == (0.0, 1.0)
    assert fields.logarithmic("dynamic_viscosity", (1.0, 1e4)) and not fields.logarithmic("speed", (1.0, 1e4))
    assert marks.ticks(-0.011, 0.041, 6) == pytest.approx([-0.01, 0, 0.01, 0.02, 0.03, 0.04])
    assert marks.round_length(0.037) == pytest.approx(0.02) and marks.round_length(5) == 5

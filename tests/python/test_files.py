"""Frames, checkpoints and run directories."""

import csv
import json
import os
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import treacle

PROGRAM = Path(treacle.__file__).parent / "bin/treacle"


@pytest.fixture
def sim(drop):
    sim = treacle.Simulation(drop, backend="cpu")
    sim.run(until=5e-3, progress=False)
    return sim


def test_frames_read_back(sim, tmp_path):
    sim.write_frame(tmp_path / "fluid.vtp")
    sim.write_frame(tmp_path / "walls.vtp", walls=True)
    frame = treacle.read_frame(tmp_path / "fluid.vtp")
    order = np.argsort(sim.fluid.ids)
    assert (frame.time, frame.dimensions, len(frame)) == (sim.time, 2, len(sim.fluid))
    np.testing.assert_array_equal(frame.ids, sim.fluid.ids[order])
    for name in ("positions", "velocities", "pressures", "number_densities"):  # files are in single precision
        np.testing.assert_allclose(getattr(frame, name), getattr(sim.fluid, name)[order], rtol=1e-6, atol=1e-30)
    assert 0.5 < frame.nearest_distances.min() < frame.nearest_distances.max() < 1.3
    assert frame.temperatures is None
    np.testing.assert_allclose(treacle.read_frame(tmp_path / "walls.vtp").positions, sim.walls.positions, rtol=1e-6)


def test_errors_of_files(sim, tmp_path):
    (tmp_path / "bad.vtp").write_text("no frame")
    for path in ("bad.vtp", "none.vtp"):
        with pytest.raises(treacle.InputError, match=path):
            treacle.read_frame(tmp_path / path)
    with pytest.raises(treacle.RunError, match="cannot write"):
        sim.write_frame(tmp_path / "none" / "fluid.vtp")
    with pytest.raises(treacle.RunError, match="cannot write"):
        sim.write_checkpoint(tmp_path / "none" / "state.h5")
    with pytest.raises(treacle.InputError, match=r"none\.h5: no such file"):
        treacle.Simulation.from_checkpoint(tmp_path / "none.h5")
    with pytest.raises(treacle.InputError, match=r"bad\.vtp: expected case\.toml beside it"):
        treacle.Simulation.from_checkpoint(tmp_path / "bad.vtp")
    (tmp_path / "case.toml").write_text(sim.case_text)
    with pytest.raises(treacle.InputError, match=r"bad\.vtp: not a treacle checkpoint"):
        treacle.Simulation.from_checkpoint(tmp_path / "bad.vtp")


def test_checkpoint_goes_on_with_the_same_bits(sim, drop, tmp_path):
    sim.write_checkpoint(tmp_path / "state.h5")
    resumed = treacle.Simulation.from_checkpoint(tmp_path / "state.h5", drop, backend="cpu")
    assert (resumed.step_count, resumed.time) == (sim.step_count, sim.time)
    for one in (sim, resumed):
        one.run(until=1e-2, progress=False)
    np.testing.assert_array_equal(resumed.fluid.positions, sim.fluid.positions)
    np.testing.assert_array_equal(resumed.fluid.velocities, sim.fluid.velocities)
    drop["body"][0]["radius"] = 0.004
    with pytest.raises(treacle.InputError, match=r"checkpoint .*particles, but the case has"):
        treacle.Simulation.from_checkpoint(tmp_path / "state.h5", drop, backend="cpu")


def test_run_directory_is_that_of_the_program(drop_file, tmp_path):
    subprocess.run([PROGRAM, "run", drop_file, "-o", tmp_path / "a", "--quiet", "--backend", "cpu"], check=True)
    sim = treacle.Simulation.from_file(drop_file, backend="cpu")
    sim.run(output=tmp_path / "b", progress=False)

    def names(folder):
        return {str(path.relative_to(folder)) for path in folder.glob("**/*")}

    assert names(tmp_path / "b") == names(tmp_path / "a")
    for name in ("frames/fluid_000001.vtp", "balance.csv", "probes/all.csv", "case.toml", "fluid.pvd"):
        assert (tmp_path / "b" / name).read_bytes() == (tmp_path / "a" / name).read_bytes(), name
    compared = subprocess.run([PROGRAM, "compare", tmp_path / "a", tmp_path / "b", "--quiet"], check=False)
    assert compared.returncode == 0
    summaries = [json.loads((tmp_path / run / "summary.json").read_text()) for run in "ab"]
    assert summaries[0].keys() == summaries[1].keys()
    assert summaries[1]["status"] == "done"
    curves = [["plot", tmp_path / "b", "--history"]] if find_spec("matplotlib") else []
    for command in (["plot", tmp_path / "b"], *curves):
        subprocess.run([PROGRAM, *command], check=True, capture_output=True)
    assert treacle.Simulation.from_checkpoint(tmp_path / "b/checkpoint.h5", backend="cpu").at_end


def test_directory_is_replaced_with_force_alone(drop, tmp_path):
    drop["time"]["end"] = 2e-3
    (tmp_path / "mine.txt").write_text("not a run")
    with pytest.raises(treacle.InputError, match="not empty"):
        treacle.Simulation(drop, backend="cpu").run(output=tmp_path, progress=False)
    for force in (False, True):
        treacle.Simulation(drop, backend="cpu").run(output=tmp_path / "run", force=force, progress=False)
    with pytest.raises(treacle.InputError, match=r"holds a run already.*replace the run with force=True"):
        treacle.Simulation(drop, backend="cpu").run(output=tmp_path / "run", progress=False)


def test_case_cannot_change_while_it_is_recorded(sim, tmp_path):
    """case.toml would not be what was run."""
    with pytest.raises(treacle.InputError, match="a run directory is being written"):
        sim.run(output=tmp_path / "a", callback=lambda s: s.change({"honey.density": 1000}), progress=False)
    with pytest.raises(treacle.InputError, match="another run directory is being written"):
        sim.run(output=tmp_path / "b", callback=lambda s: s.run(output=tmp_path / "c"), progress=False)
    sim.change({"honey.density": 1000})
    sim.run(output=tmp_path / "d", progress=False)
    assert sim.at_end


@pytest.mark.filterwarnings("ignore::treacle.SimulationWarning")
@pytest.mark.parametrize("how", ["interrupt", "callback", "failure"])
def test_run_that_is_stopped_leaves_a_whole_directory(drop, tmp_path, how):
    if how == "failure":
        drop["body"][0]["velocity"] = [0, 4]
        drop["watch"] = {"courant": 0, "energy": 0}
    sim = treacle.Simulation(drop, backend="cpu")

    def callback(s):
        if s.step_count < 3 or how == "failure":
            return
        if how == "callback":
            raise ZeroDivisionError
        os.kill(os.getpid(), signal.SIGINT)

    expected = {"interrupt": KeyboardInterrupt, "callback": ZeroDivisionError, "failure": treacle.RunError}[how]
    with pytest.raises(expected):
        sim.run(output=tmp_path / "run", callback=callback, progress=False)
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert summary["status"] == "failed"
    rows = list(csv.reader((tmp_path / "run/history.csv").open()))
    assert len(rows) == 1 + sim.step_count
    resumed = treacle.Simulation.from_checkpoint(tmp_path / "run/checkpoint.h5", backend="cpu")
    assert resumed.step_count == sim.step_count


@pytest.mark.filterwarnings("ignore::treacle.SimulationWarning")
def test_file_that_cannot_be_written_ends_the_run(sim, tmp_path):
    history = tmp_path / "run/history.csv"
    with pytest.raises(treacle.RunError, match=r"history\.csv: it was removed while the run went on"):
        sim.run(output=tmp_path / "run", callback=lambda s: history.unlink(), progress=False)
    summary = json.loads((tmp_path / "run/summary.json").read_text())
    assert (summary["status"], "history.csv" in summary["message"]) == ("failed", True)
    steps = sim.step_count
    sim.run(until=sim.time + 1e-3, progress=False)
    assert sim.step_count == steps + 1


def test_command_of_the_package_is_the_program(tmp_path):
    told = [
        subprocess.run([*command, "--version"], capture_output=True, text=True, check=True).stdout
        for command in ([PROGRAM], [sys.executable, "-m", "treacle"])
    ]
    assert told[0] == told[1]
    assert treacle.__version__ in told[0]
    bad = subprocess.run(
        [sys.executable, "-m", "treacle", "run", tmp_path / "none.toml"], capture_output=True, check=False
    )
    assert bad.returncode == 2


def test_progress_bar_is_for_terminals(drop, tmp_path):
    """A file or a pipe gets none."""
    program = tmp_path / "run.py"
    program.write_text(f"import treacle; treacle.Simulation({drop!r}, backend='cpu').run(until=2e-3)")
    quiet = subprocess.run([sys.executable, program], capture_output=True, text=True, check=True)
    assert (quiet.stdout, quiet.stderr) == ("", "")
    terminal = ["script", "-qec", f"stty rows 24 cols 80; {sys.executable} {program}", "/dev/null"]
    shown = subprocess.run(terminal, capture_output=True, text=True, check=True)
    assert "A drop: 100%" in shown.stdout

"""Steps, runs, and what is told of them."""

import contextlib
import ctypes
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest
import treacle


@pytest.fixture
def sim(drop):
    return treacle.Simulation(drop, backend="cpu")


def test_steps_are_told(sim):
    assert (sim.step_count, sim.time, sim.backend, sim.dimensions) == (0, 0.0, "cpu", 2)
    report = sim.step()
    assert (report.step, report.time, report.time_step) == (1, 1e-3, 1e-3)
    assert report.iterations > 0
    assert report.residual < 1e-11
    assert report.max_speed == pytest.approx(9.81e-3, rel=0.05)
    assert (sim.step_count, sim.time) == (1, 1e-3)


def test_free_fall(drop):
    """Before it touches anything a drop falls as a stone does: an implicit step adds g dt to every velocity."""
    drop["body"][0]["center"] = [0, 0.02]
    sim = treacle.Simulation(drop, backend="cpu", precision="double")
    before = dict(zip(sim.fluid.ids, sim.fluid.positions, strict=True))
    for _ in range(5):
        sim.step()
    np.testing.assert_allclose(sim.fluid.velocities, np.tile([0, -9.81 * 5e-3], (len(sim.fluid), 1)), atol=1e-8)
    fallen = sim.fluid.positions - np.array([before[i] for i in sim.fluid.ids])
    np.testing.assert_allclose(fallen, np.tile([0, -9.81 * 1e-6 * 15], (len(sim.fluid), 1)), atol=1e-10)


def test_run_to_a_time_and_to_the_end(sim):
    times = []
    sim.run(until=5.4e-3, callback=lambda s: times.append(s.time), progress=False)
    assert np.allclose(times, np.arange(1, 6) * 1e-3)
    sim.run(progress=False)
    assert sim.at_end
    assert sim.step_count == 20
    sim.run(progress=False)
    assert sim.step_count == 20


def test_run_refuses_a_time_that_never_comes(sim):
    with pytest.raises(treacle.InputError, match="until: expected a time"):
        sim.run(until=float("nan"))
    with pytest.raises(treacle.InputError, match="until: expected a number, found 'end'"):
        sim.run(until="end")
    assert sim.step_count == 0


def test_threads_are_those_of_the_simulation(drop):
    """Whichever thread of Python makes the steps: OpenMP keeps the number by thread. The process keeps its own."""
    openmp = ctypes.CDLL("libgomp.so.1")
    own = openmp.omp_get_max_threads()
    sim = treacle.Simulation(drop, backend="cpu", threads=3)
    found = []

    def step():
        before = len(os.listdir("/proc/self/task"))
        sim.step()
        found.append(len(os.listdir("/proc/self/task")) - before)
        found.append(openmp.omp_get_max_threads())

    thread = threading.Thread(target=step)
    thread.start()
    thread.join()
    assert found == [2, own]
    assert openmp.omp_get_max_threads() == own


@pytest.mark.parametrize("threads", [0, -1, 9999, "2", 1.0])
def test_number_of_threads_that_is_refused_changes_nothing(drop, threads):
    openmp = ctypes.CDLL("libgomp.so.1")
    own = openmp.omp_get_max_threads()
    with pytest.raises(treacle.InputError, match=f"threads: expected .* found '?{threads}"):
        treacle.Simulation(drop, backend="cpu", threads=threads)
    assert openmp.omp_get_max_threads() == own


def test_automatic_steps_meet_the_end(drop):
    drop["time"] = {"step": "auto", "end": 0.005}
    sim = treacle.Simulation(drop, backend="cpu")
    sim.run(progress=False)
    assert sim.time == pytest.approx(0.005, rel=1e-9)


def test_callback_ends_the_run(sim):
    sim.run(callback=lambda s: s.step_count < 3, progress=False)
    assert sim.step_count == 3
    sim.run(callback=lambda s: np.int64(s.step_count) < 5, progress=False)
    assert sim.step_count == 5
    sim.run(callback=lambda s: np.array(s.step_count < 7), progress=False)
    assert sim.step_count == 7
    sim.run(callback=lambda s: 0, progress=False)
    assert sim.at_end


def test_same_bits_as_the_program(drop_file, tmp_path):
    """The program's own run of the case, number by number."""
    import csv
    import subprocess
    from pathlib import Path

    program = Path(treacle.__file__).parent / "bin/treacle"
    subprocess.run([program, "run", drop_file, "-o", tmp_path / "run", "--quiet", "--backend", "cpu"], check=True)
    sim = treacle.Simulation.from_file(drop_file, backend="cpu")
    sim.run(progress=False)

    def columns(path):
        rows = list(csv.reader(path.open()))
        return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}

    for path, table in (
        ("history.csv", sim.history),
        ("balance.csv", sim.balance),
        ("probes/all.csv", sim.probe("all")),
        ("probes/load.csv", sim.probe("load")),
        ("probes/way-up.csv", sim.probe("way-up")),
    ):
        expected = columns(tmp_path / "run" / path)
        assert len(expected) > 3
        for name, values in expected.items():
            if name != "seconds":
                np.testing.assert_array_equal(table[name], values, err_msg=f"{path} {name}")


def test_tables_grow_with_the_steps(sim):
    assert len(sim.history["time"]) == 0
    assert len(sim.probe("all")["time"]) == 1  # the state at the start
    sim.step(), sim.step()
    history = sim.history
    assert history["step"].tolist() == [1, 2]
    assert history["step"].dtype == history["iterations"].dtype == np.int64
    assert history["kinetic_energy"].dtype == np.float64
    assert len(sim.balance["shear_dissipation"]) == 2
    assert sim.probes == ["all", "load", "way-up"]
    assert sim.probe("all")["mass"][-1] == pytest.approx(1400 * np.pi * 0.008**2, rel=0.03)
    assert sim.rigid_bodies == {}
    with pytest.raises(treacle.InputError, match="expected 'all', 'load' or 'way-up', found 'lod'"):
        sim.probe("lod")
    with pytest.raises(treacle.InputError, match="name: expected a string, found 3"):
        sim.probe(3)


@pytest.mark.filterwarnings("ignore::treacle.SimulationWarning")
def test_failed_step_keeps_the_state(drop):
    drop["body"][0]["velocity"] = [0, 4]
    drop["watch"] = {"courant": 0, "energy": 0}
    sim = treacle.Simulation(drop, backend="cpu")
    with pytest.raises(treacle.RunError) as error:
        sim.run(progress=False)
    assert "domain" in error.value.diagnosis
    assert isinstance(error.value, RuntimeError)
    steps = sim.step_count
    assert 0 < steps < 20
    assert sim.fluid.positions[:, 1].max() <= 0.03
    assert len(sim.history["step"]) == steps


def test_warnings_are_those_of_python(drop):
    drop["solver"] = {"neighbours": "ranges", "preconditioner": "block-jacobi"}
    with pytest.warns(treacle.SimulationWarning, match="ranges"):
        treacle.Simulation(drop, backend="cpu")


def test_interrupt_ends_the_run_between_steps(sim):
    def interrupt(s):
        if s.step_count == 3:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        sim.run(callback=interrupt, progress=False)
    assert sim.step_count == 3
    sim.run(until=5e-3, progress=False)
    assert sim.step_count == 5


def test_other_threads_go_on_during_steps(sim):
    """Python does not change threads by itself here: the other one has its turns while a step leaves them to it."""
    turns, done = 0, threading.Event()

    def work():
        nonlocal turns
        while not done.wait(1e-4):
            turns += 1

    thread, interval = threading.Thread(target=work), sys.getswitchinterval()
    sys.setswitchinterval(60)
    try:
        thread.start()
        end = time.monotonic() + 20  # a machine that is busy may take a while to begin with it
        while turns == 0 and time.monotonic() < end:
            sim._session.advance()
    finally:
        sys.setswitchinterval(interval)
        done.set()
        thread.join()
    assert turns > 0


def test_one_thread_at_a_time(sim):
    """A second one is refused while a step is made."""
    done = threading.Event()

    def make_steps():
        while not done.is_set():
            with contextlib.suppress(treacle.RunError):
                sim.step()

    thread = threading.Thread(target=make_steps)
    thread.start()
    try:
        for use in (sim.step, lambda: sim.fluid.positions, lambda: sim.history, lambda: sim.time):
            with pytest.raises(treacle.RunError, match="another thread uses the simulation"):
                end = time.monotonic() + 20
                while time.monotonic() < end:
                    use()
    finally:
        done.set()
        thread.join()
    assert sim.step().step == len(sim.history["step"])


def test_misspelt_attributes_are_refused(sim):
    with pytest.raises(AttributeError, match=r"Simulation has no attribute 'tolerance'$"):
        sim.tolerance = 3
    with pytest.raises(AttributeError, match="Fluid has no attribute 'velocity'; did you mean 'velocities'"):
        sim.fluid.velocity = 0

    class Derived(treacle.Simulation):
        pass

    Derived.__new__(Derived).tolerance = 3


def test_simulations_live_side_by_side(drop):
    one, two = (treacle.Simulation(drop, backend="cpu") for _ in range(2))
    for _ in range(3):
        one.step(), two.step()
    np.testing.assert_array_equal(one.fluid.positions, two.fluid.positions)


def test_change_of_constants(sim):
    for _ in range(8):
        sim.step()
    before = sim.fluid.positions, sim.fluid.ids
    sim.change({"honey.dynamic_viscosity": 100, "gravity.acceleration": [0, -1.6]})
    assert sim.step_count == 8
    assert set(sim.fluid.viscosities) == {100.0}
    assert "-1.6" in sim.case_text
    order = np.argsort(sim.fluid.ids)
    np.testing.assert_array_equal(sim.fluid.positions[order], before[0][np.argsort(before[1])])
    sim.step()
    assert sim.history["step"].tolist() == list(range(1, 10))
    for overrides in ({"spacing": 2e-3}, {"drop.radius": 0.005}, {"time.step": 5e-4}):
        with pytest.raises(treacle.InputError, match="between steps only"):
            sim.change(overrides)
    with pytest.raises(treacle.InputError, match="expected a positive number"):
        sim.change({"honey.density": 0})
    assert sim.step_count == 9

"""Walls and nozzles that are steered while a simulation runs."""

import numpy as np
import pytest
import treacle


@pytest.fixture
def bead(drop):
    """A nozzle above the floor, in place of the drop."""
    del drop["body"][0], drop["probe"]
    drop["body"].insert(
        0,
        {
            "name": "nozzle",
            "type": "inflow",
            "material": "honey",
            "flow_rate": 4e-4,
            "nozzle": {"shape": "rectangle", "center": [-0.01, 7e-3], "direction": [0, -1], "width": 4e-3},
        },
    )
    drop["time"]["end"] = 0.06
    drop["output"] = {"interval": 0.02, "checkpoint_interval": 0.02}
    return drop


def by_id(sim):
    return sim.fluid.positions[np.argsort(sim.fluid.ids)]


def nozzle_place(sim):
    above = sim.walls.positions[sim.walls.positions[:, 1] > 5e-3]
    return above[:, 0].mean()


def follow_a_plan(sim):
    if sim.step_count == 10:
        sim.steer("nozzle", velocity=[0.3, 0])
    if sim.step_count == 25:
        sim.steer("nozzle", velocity=[0.1, 0], flow_rate=8e-4)
    if sim.step_count == 40:
        sim.steer("nozzle", velocity=(-0.2, 0.01))


def test_nozzle_goes_where_it_is_sent(bead):
    sim = treacle.Simulation(bead, backend="cpu")
    start = nozzle_place(sim)
    sim.run(callback=follow_a_plan, progress=False)
    assert nozzle_place(sim) - start == pytest.approx(0.015 * 0.3 + 0.015 * 0.1 - 0.02 * 0.2, abs=1e-12)
    mass = 1400 * (0.025 * 4e-4 + 0.035 * 8e-4)
    assert sim.history["inflow_mass"][-1] == pytest.approx(mass, abs=2 * 4 * 1400e-6)


def test_its_case_goes_the_same_way(bead):
    """From the start, and on from any checkpoint."""
    sim = treacle.Simulation(bead, backend="cpu")
    sim.run(callback=follow_a_plan, progress=False)
    again = treacle.Simulation(bead_of(sim), backend="cpu")
    again.run(progress=False)
    assert len(again.fluid) == len(sim.fluid)
    np.testing.assert_allclose(by_id(again), by_id(sim), atol=1e-8)


def bead_of(sim):
    import tomllib

    return tomllib.loads(sim.case_text)


def test_goes_on_from_a_checkpoint(bead, tmp_path):
    sim = treacle.Simulation(bead, backend="cpu")
    sim.run(callback=follow_a_plan, until=0.03, progress=False)
    sim.write_checkpoint(tmp_path / "middle.h5")
    sim.run(callback=follow_a_plan, progress=False)
    rest = treacle.Simulation.from_checkpoint(tmp_path / "middle.h5", bead_of(sim), backend="cpu")
    rest.run(progress=False)
    np.testing.assert_allclose(by_id(rest), by_id(sim), atol=1e-8)


def test_run_directories_have_the_way(bead, tmp_path):
    """The case beside a checkpoint is one that it goes on with."""
    seen = []

    def plan(sim):
        follow_a_plan(sim)
        if sim.step_count == 42:
            seen.extend(by_id(sim))
            return False

    sim = treacle.Simulation(bead, backend="cpu")
    sim.run(callback=plan, output=tmp_path / "run", progress=False)
    resumed = treacle.Simulation.from_checkpoint(tmp_path / "run/checkpoint.h5", backend="cpu")
    np.testing.assert_array_equal(by_id(resumed), seen)
    again = treacle.Simulation.from_file(tmp_path / "run/case.toml", backend="cpu")
    again.run(until=sim.time, progress=False)
    np.testing.assert_allclose(by_id(again), seen, atol=1e-8)
    sim.run(progress=False)
    resumed.run(progress=False)
    np.testing.assert_allclose(by_id(resumed), by_id(sim), atol=1e-12)


def test_wall_at_rest_begins_to_turn_and_stops(drop):
    drop["body"][1] |= {"rotation": {"center": [0, -2e-3], "speed": 0}}
    sim = treacle.Simulation(drop, backend="cpu", overrides={"gravity.acceleration": [0, 0]})
    floor = sim.walls.positions
    sim.step()
    sim.steer("floor", angular_velocity=2.0)
    sim.run(until=0.006, progress=False)
    sim.steer("floor", angular_velocity=0.0)
    sim.run(until=0.010, progress=False)
    turn, arm = 0.01, floor - [0, -2e-3]
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    np.testing.assert_allclose(sim.walls.positions, arm @ rotation.T + [0, -2e-3], atol=1e-12)
    assert np.abs(sim.walls.velocities).max() < 1e-9


def test_nozzle_turns_and_pours_to_the_side(bead):
    """Fluid leaves with the velocity of where it leaves, in the direction that the nozzle has by then."""
    pivot = np.array([-0.01, 7e-3])
    bead["body"][0] |= {"rotation": {"center": pivot.tolist(), "speed": 0}}
    sim = treacle.Simulation(bead, backend="cpu", overrides={"gravity.acceleration": [0, 0]})
    sim.run(until=0.01, progress=False)
    sim.steer("nozzle", angular_velocity=20.0)
    known = sim.fluid.ids
    while len(sim.fluid) == len(known):
        sim.step()
    turn, new = 20 * (sim.time - 0.01), ~np.isin(sim.fluid.ids, known)
    arm = sim.fluid.positions[new] - pivot
    expected = 0.1 * np.array([np.sin(turn), -np.cos(turn)]) + 20 * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    assert new.sum() == 4
    np.testing.assert_allclose(sim.fluid.velocities[new], expected, atol=1e-9)


def test_what_cannot_be_steered_changes_nothing(bead):
    sim = treacle.Simulation(bead, backend="cpu")
    text = sim.case_text
    for arguments, message in (
        ({"body": "nozle", "velocity": [1, 0]}, "expected 'nozzle' or 'floor', found 'nozle'"),
        ({"body": "nozzle", "velocity": [1, 0, 0]}, "velocity: expected 2 numbers, found 3"),
        ({"body": "nozzle", "speed": 1}, "the case gives its flow_rate"),
        ({"body": "floor", "angular_velocity": 1}, "it has no rotation"),
        ({"body": "nozzle", "angular_velocity": 1}, "it has no rotation"),
        ({"body": 1, "velocity": [1, 0]}, "body: expected a string, found 1"),
        ({"body": "nozzle", "velocity": "fast"}, "velocity: expected a number, found 'fast'"),
        ({"body": "nozzle", "flow_rate": "much"}, "flow_rate: expected a number, found 'much'"),
        ({"body": "nozzle", "velocity": [float("nan"), 0]}, "expected finite numbers"),
    ):
        with pytest.raises(treacle.InputError, match=message):
            sim.steer(**arguments)
    assert sim.case_text == text

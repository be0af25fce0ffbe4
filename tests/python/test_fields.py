"""Fields of the fluid: what is read of them, and what comes of giving them."""

import numpy as np
import pytest
import treacle


@pytest.fixture
def sim(drop):
    sim = treacle.Simulation(drop, backend="cpu")
    sim.step()
    return sim


def test_shapes_and_types(sim):
    n = len(sim.fluid)
    assert n == pytest.approx(np.pi * 64, rel=0.05)
    for name, shape, kind in (
        ("positions", (n, 2), np.float64),
        ("velocities", (n, 2), np.float64),
        ("pressures", (n,), np.float64),
        ("number_densities", (n,), np.float64),
        ("viscosities", (n,), np.float64),
        ("materials", (n,), np.uint8),
        ("bodies", (n,), np.uint8),
        ("ids", (n,), np.uint32),
    ):
        values = getattr(sim.fluid, name)
        assert isinstance(values, np.ndarray)
        assert (values.shape, values.dtype) == (shape, kind), name
    assert sim.fluid.temperatures is None
    assert sim.fluid.shear_rates is None
    assert sorted(sim.fluid.ids) == list(range(n))
    assert sim.materials == ["honey"]
    assert sim.bodies == ["drop", "floor"]


def test_three_dimensions(drop):
    for table in (drop["domain"], *drop["body"]):
        for key in ("min", "max", "center"):
            if key in table:
                table[key] = [*table[key], {"min": -0.016, "max": 0.016, "center": 0}[key]]
    drop["dimensions"] = 3
    drop["spacing"] = 2e-3
    drop["gravity"]["acceleration"] = [0, -9.81, 0]
    drop["domain"]["periodic"] = [False, False, True]
    drop["body"][0]["radius"] = 0.006
    del drop["probe"], drop["output"]
    drop["body"][1]["min"][1] = drop["domain"]["min"][1] = -0.01
    sim = treacle.Simulation(drop, backend="cpu")
    sim.step()
    n = len(sim.fluid)
    assert sim.fluid.positions.shape == (n, 3)
    assert sim.walls.positions.shape[1] == 3
    x = sim.fluid.positions
    x[:, 2] += 0.0325  # once around the domain and a little more
    sim.fluid.positions = x
    assert np.abs(sim.fluid.positions[:, 2]).max() <= 0.016
    sim.step()


def test_copies_outlive_steps_and_simulations(sim):
    x = sim.fluid.positions
    kept = x.copy()
    sim.step()
    del sim
    np.testing.assert_array_equal(x, kept)
    x[:] = 0  # nobody else's


def test_walls_are_those_of_the_case(sim):
    walls = sim.walls
    assert len(walls) == 60 * 5
    assert walls.positions[:, 1].max() < 0
    assert walls.temperatures is None


def test_velocities_are_taken(sim):
    sim.fluid.velocities = np.tile([0.1, 0.0], (len(sim.fluid), 1))
    np.testing.assert_array_equal(sim.fluid.velocities[7], [0.1, 0.0])
    sim.step()
    assert sim.fluid.velocities[:, 0].mean() == pytest.approx(0.1, rel=0.2)
    sim.fluid.velocities = [0, 0.5]
    np.testing.assert_array_equal(sim.fluid.velocities[-1], [0, 0.5])


def test_given_state_is_computed_as_a_start_is(drop):
    """A drop that is given velocities before the first step does what one that starts with them does."""
    drop["body"][0]["center"] = [0, 0.015]
    given = treacle.Simulation(drop, backend="cpu")
    given.fluid.velocities = [0.2, -0.1]
    drop["body"][0]["velocity"] = [0.2, -0.1]
    started = treacle.Simulation(drop, backend="cpu")
    for _ in range(12):
        assert given.step().iterations == started.step().iterations
    np.testing.assert_array_equal(given.fluid.positions, started.fluid.positions)
    np.testing.assert_array_equal(given.fluid.velocities, started.fluid.velocities)


def test_positions_are_taken(drop):
    """A drop that is put somewhere else falls there, and meets the floor there."""
    drop["domain"]["max"][1] = drop["body"][0]["center"][1] = 0.2
    drop["domain"]["max"][1] = 0.25
    sim = treacle.Simulation(drop, backend="cpu")
    sim.step()
    lifted = sim.fluid.positions
    sim.fluid.positions = lifted - [0, 0.191]
    assert sim.fluid.positions[:, 1].min() > 0
    sim.fluid.velocities = 0
    for _ in range(20):
        sim.step()
    assert 0 < sim.fluid.positions[:, 1].min() < 2e-3  # far from where walls were near at the start
    assert sim.history["front_x"][-1] < 0.012


def test_bad_values_change_nothing(sim):
    n = len(sim.fluid)
    x, u = sim.fluid.positions, sim.fluid.velocities
    far, none = x.copy(), x.copy()
    far[3, 0], none[5, 1] = 7, np.nan
    for values, message in (
        ({"positions": far}, r"positions: expected places in the domain \[m\], found \(7, .*\) for particle 3"),
        ({"positions": none}, "for particle 5"),
        ({"positions": x[:-1]}, rf"positions: expected an array of shape \({n}, 2\), found \({n - 1}, 2\)"),
        ({"velocities": u.T}, "velocities: expected an array of shape"),
        ({"velocities": u * np.inf}, "velocities: expected finite numbers"),
        ({"velocities": "fast"}, "velocities: expected an array of numbers"),
        ({"temperatures": 300}, "temperatures: the case has no heat"),
        ({"velocities": u + 1, "positions": far}, "positions"),
    ):
        with np.errstate(invalid="ignore"), pytest.raises(treacle.InputError, match=message):
            sim.fluid.set(**values)
    for name in ("positions", "velocities", "temperatures", "viscosity_factors"):
        with pytest.raises(treacle.InputError, match=f"{name}: expected an array of numbers, found None"):
            setattr(sim.fluid, name, None)
    np.testing.assert_array_equal(sim.fluid.positions, x)
    np.testing.assert_array_equal(sim.fluid.velocities, u)
    sim.step()


def test_temperatures_are_taken(warm_drop):
    sim = treacle.Simulation(warm_drop, backend="cpu")
    sim.step()
    cold = sim.fluid.viscosities.mean()
    assert set(np.round(sim.fluid.temperatures)) == {300.0}
    sim.fluid.temperatures = np.full(len(sim.fluid), 320.0)
    # Arrhenius: exp(E / R (1/T - 1/T_0))
    factor = np.exp(5e4 / 8.314462618 * (1 / 320 - 1 / 300))
    np.testing.assert_allclose(sim.fluid.viscosities, 10 * factor, rtol=1e-9)
    assert sim.fluid.viscosities.mean() < 0.4 * cold
    sim.step()
    assert sim.fluid.temperatures.mean() == pytest.approx(320, abs=1)
    for bad in (0, -3, np.nan):
        with pytest.raises(treacle.InputError, match=r"temperatures: expected positive numbers \[K\]"):
            sim.fluid.temperatures = bad


def test_one_viscosity_makes_another_material(sim):
    n = len(sim.fluid)
    sim.fluid.viscosities = np.full(n, 20.0)
    assert set(sim.fluid.viscosities) == {20.0}
    sim.fluid.viscosities = 30
    assert "dynamic_viscosity = 30" in sim.case_text
    assert sim.fluid.viscosity_factors is None
    sim.step()


def test_viscosities_of_particles_stay_with_them(sim, tmp_path):
    sim.step()
    wanted = {i: 5.0 + i for i in sim.fluid.ids}
    sim.fluid.viscosities = [wanted[i] for i in sim.fluid.ids]
    assert "viscosity_factor = 1" in sim.case_text
    for _ in range(5):
        sim.step()
    np.testing.assert_allclose(sim.fluid.viscosities, [wanted[i] for i in sim.fluid.ids], rtol=1e-14)
    sim.fluid.viscosity_factors *= 2
    sim.write_checkpoint(tmp_path / "state.h5")
    sim.write_frame(tmp_path / "fluid.vtp")
    import tomllib

    again = treacle.Simulation.from_checkpoint(tmp_path / "state.h5", tomllib.loads(sim.case_text), backend="cpu")
    viscosities = [dict(zip(one.fluid.ids, one.fluid.viscosities, strict=True)) for one in (again, sim)]
    assert viscosities[0] == viscosities[1]
    frame = treacle.read_frame(tmp_path / "fluid.vtp")
    np.testing.assert_allclose(frame.viscosities, [2 * wanted[i] for i in frame.ids], rtol=1e-6)


def test_states_can_be_read_and_set(drop, tmp_path):
    drop["material"][0] |= {
        "state": [{"name": "age", "law": "expression", "rate": "1", "start": 2}],
        "viscosity_factor": "1 + age",
    }
    viscosity = drop["material"][0]["dynamic_viscosity"]
    sim = treacle.Simulation(drop, backend="cpu")
    sim.step()
    dt = sim.time
    np.testing.assert_allclose(sim.fluid.states["age"], 2 + dt)
    np.testing.assert_allclose(sim.fluid.viscosities, viscosity * (3 + dt))
    wanted = 0.5 * np.arange(len(sim.fluid))
    sim.fluid.set(states={"age": wanted})
    by_id = dict(zip(sim.fluid.ids, wanted, strict=True))
    sim.step()
    np.testing.assert_allclose(sim.fluid.states["age"], [by_id[i] + sim.time - dt for i in sim.fluid.ids])
    sim.write_frame(tmp_path / "fluid.vtp")
    frame = treacle.read_frame(tmp_path / "fluid.vtp")
    np.testing.assert_allclose(frame.states["age"], [by_id[i] + sim.time - dt for i in frame.ids], rtol=1e-6)
    with pytest.raises(treacle.InputError, match="the case has no state 'cure'"):
        sim.fluid.set(states={"cure": 1.0})
    with pytest.raises(treacle.InputError, match="states: expected finite numbers"):
        sim.fluid.set(states={"age": np.nan})
    with pytest.raises(treacle.InputError, match="follows from shear rates or temperatures"):
        sim.fluid.viscosities = 5
    sim.step()


def test_film_with_a_graded_viscosity(drop):
    """A film that runs down a plate, of mu = mu_0 exp(3 y/H): u(H) = rho g H^2/mu_0 (1/3 - (1 - exp(-3))/9)."""
    del drop["probe"]
    drop["domain"] = {"min": [-0.008, -0.01], "max": [0.008, 0.03], "periodic": [True, False]}
    drop["gravity"] = {"acceleration": [9.81, 0]}
    drop["body"][0] = {
        "name": "film",
        "type": "fluid",
        "material": "honey",
        "shape": "box",
        "min": [-0.008, 0],
        "max": [0.008, 0.02],
    }
    drop["body"][1]["min"], drop["body"][1]["max"] = [-0.008, -0.005], [0.008, 0]
    drop["time"]["end"] = 0.3
    sim = treacle.Simulation(drop, backend="cpu")
    sim.fluid.viscosities = 10 * np.exp(3 * sim.fluid.positions[:, 1] / 0.02)
    sim.run(progress=False)
    exact = 1400 * 9.81 * 0.02**2 / 10 * (1 / 3 - (1 - np.exp(-3)) / 9)
    assert sim.history["max_speed"][-1] == pytest.approx(exact, rel=0.02)


def test_viscosities_that_cannot_be(sim, warm_drop):
    text = sim.case_text
    for values in (-1, 0, np.nan, [0.0, *np.ones(len(sim.fluid) - 1)]):
        with pytest.raises(treacle.InputError, match="viscosities: expected positive numbers"):
            sim.fluid.viscosities = values
    assert sim.case_text == text
    warm = treacle.Simulation(warm_drop, backend="cpu")
    with pytest.raises(treacle.InputError, match="follows from shear rates or temperatures"):
        warm.fluid.viscosities = 5
    before = warm.fluid.viscosities
    warm.fluid.viscosity_factors = 3
    np.testing.assert_allclose(warm.fluid.viscosities, 3 * before)
    with pytest.raises(treacle.InputError, match="viscosity_factors: expected positive numbers"):
        warm.fluid.viscosity_factors = 0
    warm.step()


def test_several_materials(drop):
    drop["material"].append({**drop["material"][0], "name": "syrup", "dynamic_viscosity": 2})
    drop["body"].insert(1, {**drop["body"][0], "name": "other", "material": "syrup", "center": [0.018, 0.01]})
    sim = treacle.Simulation(drop, backend="cpu")
    assert set(sim.fluid.viscosities) == {2.0, 10.0}
    sim.fluid.viscosities = 2 * sim.fluid.viscosities
    assert set(sim.fluid.viscosities) == {4.0, 20.0}
    np.testing.assert_array_equal(sim.fluid.viscosities == 4, sim.fluid.materials == 1)
    np.testing.assert_array_equal(sim.fluid.bodies, np.where(sim.fluid.materials == 1, 1, 0))


def test_array_in_place_refuses_when_it_is_out_of_date(sim):
    """The class is that of GPUs; where the memory is does not matter to it."""
    array = treacle.DeviceArray(sim._session, "positions")
    there = np.from_dlpack(array)
    assert there.__array_interface__["data"][0] == sim._session.field_address("positions")[0]
    np.testing.assert_array_equal(there, sim.fluid.positions)
    np.testing.assert_array_equal(np.asarray(array), sim.fluid.positions)
    assert (array.shape, array.dtype) == (sim.fluid.positions.shape, np.float64)
    with pytest.raises(BufferError, match="expected no copy"):
        array.__dlpack__(copy=True)
    sim.step()
    for use in (lambda: array.shape, array.get, array.__dlpack__, lambda: np.asarray(array)):
        with pytest.raises(RuntimeError, match="out of date"):
            use()
    with pytest.raises(AttributeError):
        _ = treacle.DeviceArray(sim._session, "positions").__cuda_array_interface__

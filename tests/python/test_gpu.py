"""Fields in the memory of a GPU: without a copy, with the values of a copy, and given from there. Skipped without one."""

import numpy as np
import pytest
import treacle
from treacle import _treacle

if not (_treacle.cuda_compiled and any(device[-1] for device in _treacle.cuda_devices())):
    pytest.skip("no GPU, or a build without CUDA", allow_module_level=True)

NAMES = ("positions", "velocities", "pressures", "number_densities", "materials", "bodies", "ids")


@pytest.fixture
def sim(drop):
    sim = treacle.Simulation(drop, backend="cuda")
    for _ in range(3):
        sim.step()
    return sim


@pytest.fixture
def torch():
    torch = pytest.importorskip("torch")
    if not torch.cuda.is_available():
        pytest.skip("PyTorch without CUDA")
    return torch


@pytest.fixture
def cupy():
    return pytest.importorskip("cupy")


def test_auto_takes_the_gpu(drop):
    sim = treacle.Simulation(drop)
    assert sim.backend == "cuda"
    assert isinstance(sim.fluid.positions, treacle.DeviceArray)
    assert isinstance(sim.walls.positions, np.ndarray)


def test_copies_are_those_of_the_cpu(sim, drop):
    cpu = treacle.Simulation(drop, backend="cpu")
    for _ in range(3):
        cpu.step()
    a, b = np.argsort(sim.fluid.ids.get()), np.argsort(cpu.fluid.ids)
    for name, bound in (("positions", 1e-9), ("velocities", 1e-7)):
        np.testing.assert_allclose(np.asarray(getattr(sim.fluid, name))[a], getattr(cpu.fluid, name)[b], atol=bound)
    np.testing.assert_array_equal(sim.fluid.materials.get(), np.zeros(len(sim.fluid)))


@pytest.mark.parametrize("name", [name for name in NAMES if name != "ids"])  # of a type that PyTorch hardly knows
def test_torch_by_dlpack(sim, torch, name):
    field = getattr(sim.fluid, name)
    tensor = torch.from_dlpack(field)
    assert tensor.is_cuda
    assert tensor.data_ptr() == field.__cuda_array_interface__["data"][0]
    assert tuple(tensor.shape) == field.shape
    np.testing.assert_array_equal(tensor.cpu().numpy(), field.get())


@pytest.mark.parametrize("name", [name for name in NAMES if name != "ids"])
def test_torch_by_cuda_array_interface(sim, torch, name):
    field = getattr(sim.fluid, name)
    tensor = torch.as_tensor(field, device="cuda")
    assert tensor.data_ptr() == field.__cuda_array_interface__["data"][0]
    np.testing.assert_array_equal(tensor.cpu().numpy(), field.get())


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("way", ["from_dlpack", "asarray"])
def test_cupy(sim, cupy, name, way):
    field = getattr(sim.fluid, name)
    array = getattr(cupy, way)(field)
    assert array.data.ptr == field.__cuda_array_interface__["data"][0]
    assert array.dtype == field.dtype
    np.testing.assert_array_equal(cupy.asnumpy(array), field.get())


def test_array_is_out_of_date_after_a_step(sim):
    field = sim.fluid.velocities
    sim.step()
    for use in (field.get, field.__dlpack__, lambda: field.__cuda_array_interface__):
        with pytest.raises(RuntimeError, match="out of date"):
            use()


def test_arrays_keep_the_simulation(drop, torch):
    tensor = torch.from_dlpack(treacle.Simulation(drop, backend="cuda").fluid.positions)
    assert torch.isfinite(tensor).all()


def test_torch_gives(sim, torch):
    given = 2 * torch.from_dlpack(sim.fluid.velocities)
    expected = given.cpu().numpy()
    sim.fluid.velocities = given
    np.testing.assert_array_equal(sim.fluid.velocities.get(), expected)
    x = torch.from_dlpack(sim.fluid.positions) + torch.tensor([1e-3, 0], dtype=torch.float64, device="cuda")
    sim.fluid.positions = x
    np.testing.assert_array_equal(sim.fluid.positions.get(), x.cpu().numpy())
    sim.step()


def test_cupy_gives(sim, cupy):
    given = cupy.full((len(sim.fluid), 2), 0.25)
    sim.fluid.velocities = given
    np.testing.assert_array_equal(sim.fluid.velocities.get(), cupy.asnumpy(given))
    sim.step()


def test_host_gives(sim):
    sim.fluid.velocities = np.full((len(sim.fluid), 2), 0.125)
    np.testing.assert_array_equal(sim.fluid.velocities.get(), 0.125)
    sim.fluid.velocities = sim.fluid.velocities
    sim.step()


def test_given_on_the_device_and_on_the_host_are_the_same(drop, torch):
    ends = []
    for device in ("cpu", "cuda"):
        sim = treacle.Simulation(drop, backend="cuda")
        u = torch.zeros((len(sim.fluid), 2), dtype=torch.float64, device=device)
        u[:, 0] = 0.1
        sim.fluid.velocities = u
        for _ in range(5):
            sim.step()
        ends.append(sim.fluid.positions.get())
    np.testing.assert_array_equal(*ends)


def test_bad_values_change_nothing(sim, torch):
    x = sim.fluid.positions.get()
    for bad, message in (
        (torch.full(x.shape, 7.0, dtype=torch.float64, device="cuda"), "expected places in the domain"),
        (torch.full(x.shape, float("nan"), dtype=torch.float64, device="cuda"), "expected places in the domain"),
        (torch.zeros(x.shape, dtype=torch.float32, device="cuda"), "expected 64 bit numbers, found torch.float32"),
        (torch.zeros((3, 2), dtype=torch.float64, device="cuda"), "expected an array of shape"),
    ):
        with pytest.raises(treacle.InputError, match=message):
            sim.fluid.positions = bad
    np.testing.assert_array_equal(sim.fluid.positions.get(), x)


def test_temperatures(warm_drop, torch):
    sim = treacle.Simulation(warm_drop, backend="cuda")
    sim.step()
    sim.fluid.temperatures = torch.full((len(sim.fluid),), 320.0, dtype=torch.float64, device="cuda")
    np.testing.assert_array_equal(sim.fluid.temperatures.get(), 320)
    with pytest.raises(treacle.InputError, match="positive"):
        sim.fluid.temperatures = torch.zeros(len(sim.fluid), dtype=torch.float64, device="cuda")
    sim.step()
    assert sim.fluid.viscosities.mean() < 5
    assert sim.fluid.shear_rates.shape == (len(sim.fluid),)


def test_viscosities_of_particles(drop, torch):
    sim = treacle.Simulation(drop, backend="cuda")
    sim.fluid.viscosities = np.linspace(5, 50, len(sim.fluid))
    wanted = dict(zip(sim.fluid.ids.get(), sim.fluid.viscosities, strict=True))
    sim.step()
    np.testing.assert_array_equal(sim.fluid.viscosities, [wanted[i] for i in sim.fluid.ids.get()])
    sim.fluid.viscosity_factors = 2 * torch.from_dlpack(sim.fluid.viscosity_factors)
    np.testing.assert_array_equal(sim.fluid.viscosities, [2 * wanted[i] for i in sim.fluid.ids.get()])
    sim.step()


def test_the_cpu_does_not_take_what_lies_on_the_gpu(drop, torch):
    sim = treacle.Simulation(drop, backend="cpu")
    with pytest.raises(treacle.InputError, match="in the memory of a GPU, but the CPU computes"):
        sim.fluid.velocities = torch.zeros((len(sim.fluid), 2), dtype=torch.float64, device="cuda")


def test_files_and_tables(sim, tmp_path):
    sim.run(output=tmp_path / "run", progress=False)
    assert sim.at_end
    assert len(sim.history["step"]) == 20
    frame = treacle.read_frame(tmp_path / "run/frames/fluid_000001.vtp")
    assert len(frame) == len(sim.fluid)
    resumed = treacle.Simulation.from_checkpoint(tmp_path / "run/checkpoint.h5", backend="cuda")
    a, b = np.argsort(resumed.fluid.ids.get()), np.argsort(sim.fluid.ids.get())
    np.testing.assert_array_equal(resumed.fluid.positions.get()[a], sim.fluid.positions.get()[b])

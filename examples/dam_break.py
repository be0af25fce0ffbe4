# %% [markdown]
# # A dam break on two backends
#
# A square column of 20 mm of a fluid of 10 Pa s collapses beside a wall, on the CPU and on a GPU. Where there is no GPU
# the CPU runs twice, with the preconditioner in single and in double precision, so that there is something to compare.
#
# `RESOLUTION=4 python dam_break.py` runs it with four times as many particles along each side, and steps a quarter as long.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np
import treacle

RESOLUTION = float(os.environ.get("RESOLUTION", 1))

case = {
    "title": "Dam break",
    "dimensions": 2,
    "spacing": 1e-3,
    "domain": {"min": [-0.01, -0.01], "max": [0.05, 0.04]},
    "gravity": {"acceleration": [0, -10]},
    "time": {"step": 1e-3, "end": 0.2},
    "material": [
        {"name": "fluid", "density": 1000, "dynamic_viscosity": 10, "bulk_viscosity": 1e4, "bulk_modulus": 1e6}
    ],
    "body": [
        {"name": "column", "type": "fluid", "material": "fluid", "shape": "box", "min": [0, 0], "max": [0.02, 0.02]},
        {"name": "wall", "type": "wall", "material": "fluid", "shape": "box", "min": [-0.01, -0.01], "max": [0, 0.04]},
        {"name": "floor", "type": "wall", "material": "fluid", "shape": "box", "min": [0, -0.01], "max": [0.05, 0]},
    ],
}

# %% [markdown]
# `backend="auto"` takes a GPU where there is one, and `sim.backend` says what it took.

# %%
first = treacle.Simulation(case, backend="cpu", resolution=RESOLUTION)
second = treacle.Simulation(case, backend="auto", resolution=RESOLUTION)
names = ["CPU", "GPU"]
if second.backend == "cpu":
    second = treacle.Simulation(case, backend="cpu", resolution=RESOLUTION, precision="double")
    names = ["CPU, mixed precision", "CPU, double precision"]

# %% [markdown]
# Both go on by turns. Particles are compared by their identifiers: their order in memory is the search's and may differ.


# %%
def by_id(sim):
    order = np.argsort(np.asarray(sim.fluid.ids))
    return np.asarray(sim.fluid.positions)[order]


times, differences = [], []
for until in np.linspace(0, first.end, 21)[1:]:
    for sim in (first, second):
        sim.run(until=until, progress=False)
    apart = np.linalg.norm(by_id(first) - by_id(second), axis=1)
    times.append(first.time)
    differences.append(apart.max())

# %% [markdown]
# The two solve the same equations to the same tolerance, in other orders of summation. What differs in the last digits
# grows as the particles rearrange themselves, so trajectories part in the end; front and energy do not.

# %%
histories = [sim.history for sim in (first, second)]
front = [h["front_x"][-1] for h in histories]
energy = [h["potential_energy"][-1] for h in histories]
for name, sim, history in zip(names, (first, second), histories):
    step = np.median(history["seconds"])
    print(
        f"{name}: {len(sim.fluid)} particles, {len(history['time'])} steps, median {step * 1e3:.3g} ms, "
        f"{history['iterations'].mean():.1f} iterations a step ({sim.device})"
    )
print(f"particles differ by up to {differences[0]:.1e} m at {times[0]:.2g} s, {differences[-1]:.1e} m at {times[-1]:.2g} s")
print(f"fronts: {front[0]:.6f} and {front[1]:.6f} m, potential energies differ by {abs(energy[1] / energy[0] - 1):.1e}")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3), layout="constrained")
for sim, name, mark in zip((first, second), names, ("o", "x")):
    x = np.asarray(sim.fluid.positions) * 1e3
    left.plot(x[:, 0], x[:, 1], mark, markersize=2, label=name)
left.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title=f"after {first.time:.2g} s")
left.legend(fontsize=7)
right.semilogy(times, np.maximum(differences, 1e-18))
right.axhline(first.spacing, color="grey", linestyle=":", label="spacing")
right.set(xlabel="time [s]", ylabel="m", title="largest difference of a particle's place")
right.legend(fontsize=7)
figure.savefig("dam_break.png", dpi=80)

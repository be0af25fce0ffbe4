# %% [markdown]
# # Eight cases at once, and a law for all of them
#
# A column of 20 mm collapses on the floor, for four viscosities and two gravities, that of the Earth and that of the Moon. Each case is a
# process of its own, as many at a time as there are cores. Without inertia nothing but
# viscosity over weight, $\mu / (\rho g H)$, sets the clock, so that one curve should hold for all eight: the front against
# $t \rho g H / \mu$.
#
# `RESOLUTION=2 python parameter_study.py` runs it with half the spacing.

# %%
import csv
import itertools
import multiprocessing
import os
import time
from concurrent.futures import ProcessPoolExecutor

import matplotlib.pyplot as plt
import numpy as np
import treacle

RESOLUTION = float(os.environ.get("RESOLUTION", 1))
VISCOSITIES = [5, 10, 20, 40]  # Pa s
GRAVITIES = [9.81, 1.62]  # m/s2
DENSITY, HEIGHT = 1000, 0.02  # kg/m3, m
WAY = 0.5 * HEIGHT  # of the front, at which the clocks are compared
END = 15  # of the runs, in units of viscosity over weight

# %% [markdown]
# Steps are as long as their errors allow (`step = "auto"`), because the slowest case takes 48 times as long as the fastest one.


# %%
def column(viscosity, gravity):
    return {
        "title": f"Column of {viscosity} Pa s, {gravity} m/s2",
        "dimensions": 2,
        "spacing": 1e-3,
        "resolution": RESOLUTION,
        "domain": {"min": [-0.01, -0.01], "max": [0.06, 0.04]},
        "gravity": {"acceleration": [0, -gravity]},
        "time": {"step": "auto", "end": END * viscosity / (DENSITY * gravity * HEIGHT)},
        "material": [
            {
                "name": "fluid",
                "density": DENSITY,
                "dynamic_viscosity": viscosity,
                "bulk_viscosity": 1e4,
                "bulk_modulus": 1e6,
            }
        ],
        "body": [
            {"name": "column", "type": "fluid", "material": "fluid", "shape": "box", "min": [0, 0], "max": [HEIGHT, HEIGHT]},
            {"name": "wall", "type": "wall", "material": "fluid", "shape": "box", "min": [-0.01, -0.01], "max": [0, 0.04]},
            {"name": "floor", "type": "wall", "material": "fluid", "shape": "box", "min": [0, -0.01], "max": [0.06, 0]},
        ],
    }


def run(parameters):
    """Times and ways of the front of one case, and what it took."""
    sim = treacle.Simulation(column(*parameters), backend="cpu", threads=1)
    sim.run(progress=False)
    history = sim.history
    way = history["front_x"] - HEIGHT + sim.spacing / 2
    return history["time"], way, history["seconds"].sum()


# %% [markdown]
# Processes are forked, which works in a notebook, too, as long as this process itself has simulated nothing before: threads of
# OpenMP do not survive a fork.

# %%
cases = list(itertools.product(VISCOSITIES, GRAVITIES))
began = time.perf_counter()
with ProcessPoolExecutor(len(os.sched_getaffinity(0)), multiprocessing.get_context("fork")) as pool:
    results = list(pool.map(run, cases))
print(f"{len(cases)} cases in {time.perf_counter() - began:.1f} s")

# %% [markdown]
# A table: when the front has gone half of the column's height, in seconds and in units of viscosity over weight.

# %%
rows = []
for (viscosity, gravity), (times, way, seconds) in zip(cases, results):
    clock = viscosity / (DENSITY * gravity * HEIGHT)
    arrival = np.interp(WAY, way, times)
    rows.append((viscosity, gravity, arrival, arrival / clock, len(times), seconds))

with open("parameter_study.csv", "w", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(["viscosity_pa_s", "gravity_m_s2", "arrival_s", "arrival_over_clock", "steps", "seconds"])
    writer.writerows(rows)
print("viscosity  gravity  arrival [s]  in units  steps")
for viscosity, gravity, arrival, units, steps, _ in rows:
    print(f"{viscosity:9g}  {gravity:7g}  {arrival:11.4f}  {units:8.3f}  {steps:5d}")

# %% [markdown]
# The law says that arrival times go with the first power of viscosity over gravity. The slope of a line through the logarithms is
# what these cases have.

# %%
table = np.array(rows)
exponent = np.polyfit(np.log(table[:, 0] / table[:, 1]), np.log(table[:, 2]), 1)[0]
scatter = table[:, 3].max() / table[:, 3].min() - 1
print(f"arrival ~ (viscosity / gravity)^{exponent:.4f}; in units of the clock they differ by up to {100 * scatter:.1f} %")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3), layout="constrained", sharey=True)
for (viscosity, gravity), (times, way, _) in zip(cases, results):
    clock = viscosity / (DENSITY * gravity * HEIGHT)
    style = "-" if gravity == GRAVITIES[0] else "--"
    left.plot(times, way / HEIGHT, style, label=f"{viscosity} Pa s, {gravity} m/s²")
    right.plot(times / clock, way / HEIGHT, style)
left.set(xscale="log", xlim=(1e-2, None), xlabel="time [s]", ylabel="way of the front over height")
right.set(xlabel="time in units of viscosity over weight")
left.legend(fontsize=6)
figure.savefig("parameter_study.png", dpi=80)

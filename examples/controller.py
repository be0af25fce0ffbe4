# %% [markdown]
# # A controller that moves a nozzle
#
# A nozzle goes over a plate and lays a bead of adhesive, here in a plane along its way. The bead should be 4 mm thick, but the pump drifts,
# and the controller does not know how. Ten times a second it reads how thick the bead is behind the nozzle, and says how fast the
# nozzle is to go next: slower where the bead is too thin.
#
# `sim.steer` tells the nozzle how to go on. What is read are the places of the particles.
#
# `RESOLUTION=2 python controller.py` runs it with half the spacing.

# %%
import os
import tomllib

import matplotlib.pyplot as plt
import numpy as np
import treacle

RESOLUTION = float(os.environ.get("RESOLUTION", 1))
WANTED = 4e-3  # thickness [m]
INTERVAL = 0.1  # between two decisions [s]
DURATION = 11.0  # s
FIRST_SPEED = 0.02  # of the nozzle, right for the pump's first flow rate [m/s]
BEHIND, WINDOW = 8e-3, 5e-3  # the sensor: its middle behind the nozzle's, its length [m]
PUMP = {"times": [0, 1.5, 5, 6, 10], "values": [8e-5, 8e-5, 1.2e-4, 1.2e-4, 7e-5]}  # flow rate [m2/s]


def bead():
    adhesive = {"name": "adhesive", "density": 1200, "dynamic_viscosity": 50, "bulk_viscosity": 3e4, "bulk_modulus": 3e6}
    return {
        "title": "A bead of adhesive under control",
        "dimensions": 2,
        "spacing": 1e-3,
        "resolution": RESOLUTION,
        "domain": {"min": [-0.03, -0.01], "max": [0.32, 0.02]},
        "gravity": {"acceleration": [0, -9.81]},
        "time": {"step": 2e-3, "end": DURATION},
        "material": [adhesive],
        "body": [
            {
                "name": "nozzle",
                "type": "inflow",
                "material": "adhesive",
                "flow_rate": PUMP,
                "nozzle": {"shape": "rectangle", "center": [0, 7e-3], "direction": [0, -1], "width": 4e-3},
            },
            {
                "name": "plate",
                "type": "wall",
                "material": "adhesive",
                "shape": "box",
                "min": [-0.02, -4e-3 / RESOLUTION],
                "max": [0.31, 0],
            },
        ],
    }


# %% [markdown]
# The controller. What it sees now was laid when the nozzle was there, with the speed that it had then: thickness times that
# speed is what the pump gave, and that over the wanted thickness is the speed for now. It takes 60 % of the correction at a
# time, and may change the speed by at most 3 mm/s in an interval.


# %%
def controlled(thickness, sensor, way):
    times, places = np.array(way)
    speeds = np.diff(places) / np.diff(times)
    now = speeds[-1]
    if sensor - WINDOW / 2 < 0.005:
        return now  # nothing to be seen yet but the bead's beginning
    then = speeds[min(np.searchsorted(places, sensor), len(speeds)) - 1]
    change = 0.6 * (thickness * then / WANTED - now)
    return float(now + np.clip(change, -3e-3, 3e-3))


def uncontrolled(thickness, sensor, way):
    return FIRST_SPEED


# %%
def thickness_at(sim, sensor):
    x = np.asarray(sim.fluid.positions)[:, 0]
    return np.count_nonzero(abs(x - sensor) < WINDOW / 2) * sim.spacing**2 / WINDOW


def lay(controller):
    """The bead in the end, the way of the nozzle, and what the sensor saw."""
    sim, way, seen = treacle.Simulation(bead(), backend="cpu"), ([0.0], [0.0]), []
    speed = FIRST_SPEED
    while not sim.at_end:
        sim.steer("nozzle", velocity=[speed, 0])
        sim.run(until=sim.time + INTERVAL, progress=False)
        way[1].append(way[1][-1] + speed * (sim.time - way[0][-1]))
        way[0].append(sim.time)
        sensor = way[1][-1] - BEHIND
        thickness = thickness_at(sim, sensor)
        seen.append((sim.time, sensor, thickness))
        speed = controller(thickness, sensor, way)
    return sim, np.array(way), np.array(seen)


# %% [markdown]
# The thickness in the end is counted from the particles, in strips of 10 mm, from 10 mm to where the nozzle was 10 mm before its last place.


# %%
def profile(sim, way):
    edges = np.arange(0.01, way[1, -1] - 0.01, 10e-3)
    count, _ = np.histogram(np.asarray(sim.fluid.positions)[:, 0], edges)
    return (edges[1:] + edges[:-1]) / 2, count * sim.spacing**2 / np.diff(edges)


results = {}
for name, controller in (("fixed speed", uncontrolled), ("controller", controlled)):
    sim, way, seen = lay(controller)
    places, thickness = profile(sim, way)
    error = np.sqrt(np.mean((thickness - WANTED) ** 2))
    results[name] = sim, way, places, thickness, error
    moved = np.abs(sim.walls.positions[:, 0][sim.walls.positions[:, 1] > 0].mean() - way[1, -1])
    print(
        f"{name}: thickness {thickness.min() * 1e3:.2f} to {thickness.max() * 1e3:.2f} mm, "
        f"rms error {error * 1e3:.3f} mm; nozzle {moved:.1e} m from where it was sent"
    )
ratio = results["fixed speed"][-1] / results["controller"][-1]
print(f"the controller makes the error {ratio:.1f} times smaller")

# %% [markdown]
# The simulation's case has the way that the nozzle was steered along: run from the start, it should lay the same bead.

# %%
steered = results["controller"][0]
again = treacle.Simulation(tomllib.loads(steered.case_text), backend="cpu")
again.run(progress=False)
beads = [np.asarray(sim.fluid.positions)[np.argsort(np.asarray(sim.fluid.ids))] for sim in (steered, again)]
print(f"steered and run again particles are {np.abs(beads[0] - beads[1]).max():.1e} m apart")

# %%
figure, axes = plt.subplots(4, 1, figsize=(8, 6.5), layout="constrained", height_ratios=[1, 1, 1.6, 1.6])
for axis, (name, (sim, way, places, thickness, _)) in zip(axes, results.items()):
    x, walls = np.asarray(sim.fluid.positions) * 1e3, sim.walls.positions * 1e3
    axis.plot(x[:, 0], x[:, 1], ".", markersize=2 / RESOLUTION)
    axis.plot(walls[:, 0], walls[:, 1], ".", color="grey", markersize=2 / RESOLUTION)
    axis.axhline(WANTED * 1e3, color="k", linewidth=0.5)
    axis.set(xlim=(-10, 290), ylim=(-4, 13), ylabel="mm", title=name)
    axes[2].plot(places * 1e3, thickness * 1e3, label=name)
    axes[3].plot(way[0, 1:], np.diff(way[1]) / np.diff(way[0]) * 1e3, label=f"nozzle, {name}")
axes[2].axhline(WANTED * 1e3, color="k", linewidth=0.5)
axes[2].set(xlim=(-10, 290), xlabel="mm", ylabel="thickness [mm]")
axes[2].legend(fontsize=7)
axes[3].plot(PUMP["times"] + [DURATION], np.array(PUMP["values"] + [PUMP["values"][-1]]) / WANTED * 1e3, "k:", label="right for the pump")
axes[3].set(xlabel="time [s]", ylabel="speed [mm/s]")
axes[3].legend(fontsize=7)
figure.savefig("controller.png", dpi=80)

# %% [markdown]
# # A controller that moves a nozzle
#
# A nozzle goes over a plate and lays a bead of adhesive, here in a plane along its way. The bead should be 4 mm thick, but the pump drifts,
# and the controller does not know how. Ten times a second it reads how thick the bead is behind the nozzle, and says how fast the
# nozzle is to go next: slower where the bead is too thin.
#
# How the program is steered: motions of nozzles are part of the case and cannot change while a simulation runs. So the case is run
# for a tenth of a second, to a checkpoint, and the next tenth goes on from there with a case whose table of the nozzle's way
# has one more entry. What is before that time stays as it was, so that the nozzle stands where the checkpoint has it. The table also says how
# the nozzle would go on, with the same speed: otherwise it would stop where the table ends, and the layer of fluid that leaves it just then would have half its
# speed. The probe, too, is put to another place each time, behind the nozzle.
#
# `RESOLUTION=2 python controller.py` runs it with half the spacing.

# %%
import os
import tempfile
from pathlib import Path

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


def bead(way, sensor):
    """`way`: times [s] and places [m] of the nozzle; `sensor`: where the thickness is read [m]."""
    adhesive = {"name": "adhesive", "density": 1200, "dynamic_viscosity": 50, "bulk_viscosity": 3e4, "bulk_modulus": 3e6}
    times, places = way
    ahead = {"times": [*times, times[-1] + INTERVAL], "values": [*places, 2 * places[-1] - places[-2]]}
    return {
        "title": "A bead of adhesive under control",
        "dimensions": 2,
        "spacing": 1e-3,
        "resolution": RESOLUTION,
        "domain": {"min": [-0.03, -0.01], "max": [0.32, 0.02]},
        "gravity": {"acceleration": [0, -9.81]},
        "time": {"step": 2e-3, "end": times[-1]},
        "material": [adhesive],
        "body": [
            {
                "name": "nozzle",
                "type": "inflow",
                "material": "adhesive",
                "flow_rate": PUMP,
                "displacement": [ahead, 0],
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
        "probe": [
            {
                "name": "sensor",
                "type": "region",
                "box": {"min": [sensor - WINDOW / 2, 0], "max": [sensor + WINDOW / 2, 0.02]},
                "interval": INTERVAL,
            }
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
def lay(controller):
    """The bead in the end, the way of the nozzle, and what the sensor saw."""
    way, seen = ([0.0, INTERVAL], [0.0, FIRST_SPEED * INTERVAL]), []
    with tempfile.TemporaryDirectory() as folder:
        checkpoint = Path(folder) / "bead.h5"
        sensor = way[1][-1] - BEHIND
        sim = treacle.Simulation(bead(way, sensor), backend="cpu")
        while True:
            sim.run(progress=False)
            thickness = sim.probe("sensor")["volume"][-1] / WINDOW
            seen.append((sim.time, sensor, thickness))
            if sim.time > DURATION - INTERVAL / 2:
                return sim, np.array(way), np.array(seen)
            speed = controller(thickness, sensor, way)
            way[0].append(round(way[0][-1] + INTERVAL, 9))
            way[1].append(way[1][-1] + speed * INTERVAL)
            sensor = way[1][-1] - BEHIND
            sim.write_checkpoint(checkpoint)
            sim = treacle.Simulation.from_checkpoint(checkpoint, bead(way, sensor), backend="cpu")


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
# Do the checkpoints change anything? The way of the nozzle at fixed speed, given as a whole to one run without a stop, should
# lay the same bead.

# %%
stopped, way = results["fixed speed"][:2]
straight = treacle.Simulation(bead(way.tolist(), 0), backend="cpu")
straight.run(progress=False)
beads = [np.asarray(sim.fluid.positions)[np.argsort(np.asarray(sim.fluid.ids))] for sim in (stopped, straight)]
print(f"with and without {len(way[0]) - 2} checkpoints particles are {np.abs(beads[0] - beads[1]).max():g} m apart")

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

# %% [markdown]
# # A stirred tank
#
# A paddle turns in a round tank that is full of syrup, seen along its axis. A probe reads the torque on it at four speeds, and with two other viscosities. At low
# Reynolds numbers the torque goes with viscosity and speed, $T \propto \mu \omega$, and the power number with 1/Re.
#
# All bodies are cut out of squares, whose particles stand on one lattice: a tank that is filled with more than it holds would
# press on the stirrer.
#
# That the torques are right as such is seen beforehand, on a round rotor in place of the paddle, for which there is a
# formula: $T = 4 \pi \mu \omega R_1^2 R_2^2 / (R_2^2 - R_1^2)$ per metre of depth.
#
# `RESOLUTION=2 python stirred_tank.py` runs it with half the spacing.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np
import treacle

RESOLUTION = float(os.environ.get("RESOLUTION", 1))
TANK = 0.024  # radius [m]
ROTOR = 0.012  # radius of the round rotor [m]
LENGTH, THICKNESS = 0.032, 0.008  # of the paddle [m]
DENSITY = 1400  # kg/m3
RUNS = [(10, 1), (10, 2), (10, 4), (10, 8), (5, 4), (20, 4)]  # viscosity [Pa s], speed [rad/s]
END = 0.4  # s


def square(half):
    return {"shape": "box", "min": [-half, -half], "max": [half, half]}


def tank(stirrer, hole, viscosity, speed):
    """`hole`: where the stirrer leaves room for the fluid."""
    syrup = {"name": "syrup", "density": DENSITY, "dynamic_viscosity": viscosity, "bulk_viscosity": 1e4, "bulk_modulus": 1e6}
    fluid, wall = {"type": "fluid", "material": "syrup"}, {"type": "wall", "material": "syrup"}
    side = TANK + 0.004 / RESOLUTION
    return {
        "title": "Stirred tank",
        "dimensions": 2,
        "spacing": 1e-3,
        "resolution": RESOLUTION,
        "domain": {"min": [-0.035, -0.035], "max": [0.035, 0.035]},
        "time": {"step": 1e-3, "end": END},
        "material": [syrup],
        "body": [
            fluid | square(TANK) | {"name": "syrup", "where": f"x^2 + y^2 < {TANK**2} && ({hole})"},
            wall | square(side) | {"name": "tank", "where": f"x^2 + y^2 >= {TANK**2}"},
            wall | stirrer | {"name": "stirrer", "rotation": {"center": [0, 0], "speed": speed}},
        ],
        "probe": [{"name": "torque", "type": "load", "body": "stirrer"}],
    }


PADDLE = {"shape": "box", "min": [-LENGTH / 2, -THICKNESS / 2], "max": [LENGTH / 2, THICKNESS / 2]}
AROUND_PADDLE = f"abs(x) > {LENGTH / 2} || abs(y) > {THICKNESS / 2}"
ROUND = square(ROTOR) | {"where": f"x^2 + y^2 < {ROTOR**2}"}
AROUND_ROUND = f"x^2 + y^2 >= {ROTOR**2}"


# %% [markdown]
# The flow is developed after about $\rho R^2 / \mu$, 0.04 to 0.16 s. The torque is the mean over the second half of the run.


# %%
def torque(stirrer, hole, viscosity, speed):
    """That the stirrer needs, per metre of depth [N m/m], and the simulation."""
    sim = treacle.Simulation(tank(stirrer, hole, viscosity, speed), backend="cpu")
    sim.run(progress=False)
    load = sim.probe("torque")
    return -load["torque"][load["time"] > END / 2].mean(), sim


found, _ = torque(ROUND, AROUND_ROUND, 10, 2)
exact = 4 * np.pi * 10 * 2 * ROTOR**2 * TANK**2 / (TANK**2 - ROTOR**2)
print(f"round rotor: {found:.4f} N m/m, formula {exact:.4f}, error {100 * (found / exact - 1):+.1f} %")

# %% [markdown]
# With the paddle. Re is $\rho N L^2 / \mu$ with the number of turns a second, $N = \omega / 2\pi$, and the power number $T \omega
# / (\rho N^3 L^4)$, per metre of depth.

# %%
torques = []
print("viscosity [Pa s]  speed [rad/s]      Re  torque [N m/m]  power number * Re")
for viscosity, speed in RUNS:
    value, sim = torque(PADDLE, AROUND_PADDLE, viscosity, speed)
    torques.append(value)
    turns = speed / (2 * np.pi)
    reynolds = DENSITY * turns * LENGTH**2 / viscosity
    power_number = value * speed / (DENSITY * turns**3 * LENGTH**4)
    print(f"{viscosity:16g}  {speed:13g}  {reynolds:6.4f}  {value:14.5f}  {power_number * reynolds:17.2f}")

rates = np.prod(RUNS, axis=1)  # viscosity times speed [Pa]
exponent = np.polyfit(np.log(rates), np.log(torques), 1)[0]
per_rate = np.array(torques) / rates
print(f"torque ~ (viscosity speed)^{exponent:.4f}; over both it differs by up to {100 * (per_rate.max() / per_rate.min() - 1):.1f} %")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
x, u = np.asarray(sim.fluid.positions) * 1e3, np.linalg.norm(np.asarray(sim.fluid.velocities), axis=1)
dots = left.scatter(x[:, 0], x[:, 1], c=u * 1e3, s=4 / RESOLUTION**2)
figure.colorbar(dots, ax=left, label="speed [mm/s]")
walls = sim.walls.positions * 1e3
left.plot(walls[:, 0], walls[:, 1], ".", color="lightgrey", markersize=1.5 / RESOLUTION)
left.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title=f"{speed} rad/s, {viscosity} Pa s, after {sim.time:.2g} s")
right.plot(rates, torques, "o", label="paddle")
right.plot(np.sort(rates), np.sort(rates) * per_rate.mean(), ":", color="grey", label="in proportion")
right.set(xlabel="viscosity times speed [Pa]", ylabel="torque [N m/m]")
right.legend(fontsize=7)
figure.savefig("stirred_tank.png", dpi=80)

# %% [markdown]
# # The rheology of a paste from its slump
#
# A block of paste, 100 mm wide and high, is let go. It slumps, and what is seen from outside, its height and how far it
# spreads, tells its constants: the yield stress holds the heap in the end, the plastic viscosity sets how fast it gets
# there. SciPy's `least_squares` finds both from the two curves.
#
# **The measurement is made, not measured**: the solver runs with constants that the fit is not told, and noise of 0.5 mm is added. So the
# example can say how far the fit is from the truth. With curves of your own, put them in place of `measured`; what the model does
# not know of the paste is then in the result, too.
#
# `RESOLUTION=2 python fit_rheology.py` runs it with half the spacing.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np
import treacle
from scipy.optimize import least_squares

RESOLUTION = float(os.environ.get("RESOLUTION", 1))
TRUTH = {"yield_stress": 75.0, "plastic_viscosity": 8.0}
NOISE = 0.5e-3  # m
SIDE = 0.1  # of the block [m]


def slump_case(yield_stress, plastic_viscosity):
    paste = {"model": "bingham", "yield_stress": yield_stress, "plastic_viscosity": plastic_viscosity}
    return {
        "title": "Slump",
        "dimensions": 2,
        "spacing": 5e-3,
        "resolution": RESOLUTION,
        "domain": {"min": [-0.4, -0.05], "max": [0.4, 0.15]},
        "gravity": {"acceleration": [0, -9.81]},
        "time": {"step": 2e-3, "end": 0.8},
        "material": [
            {
                "name": "paste",
                "density": 1000,
                "bulk_viscosity": 1e4,
                "bulk_modulus": 1e6,
                "rheology": paste | {"regularisation": 100},
            }
        ],
        "body": [
            {
                "name": "block",
                "type": "fluid",
                "material": "paste",
                "shape": "box",
                "min": [-SIDE / 2, 0],
                "max": [SIDE / 2, SIDE],
            },
            {"name": "table", "type": "wall", "material": "paste", "shape": "box", "min": [-0.35, -0.02 / RESOLUTION], "max": [0.35, 0]},
        ],
        "probe": [
            {"name": "top", "type": "height", "from": [0, 0], "to": [0, 0.15], "interval": 0.02},
            {"name": "spread", "type": "height", "from": [0, 0.005], "to": [0.35, 0.005], "interval": 0.02},
        ],
    }


# %% [markdown]
# A run gives two curves, the height in the middle and the half width at the table, each at 41 times.


# %%
def curves(yield_stress, plastic_viscosity):
    sim = treacle.Simulation(slump_case(yield_stress, plastic_viscosity), backend="cpu")
    sim.run(progress=False)
    top, spread = sim.probe("top"), sim.probe("spread")
    return top["time"], np.array([top["height"], spread["height"]])


times, truth = curves(**TRUTH)
measured = truth + np.random.default_rng(20).normal(0, NOISE, truth.shape)

# %% [markdown]
# The constants are fitted by their logarithms, so that they stay positive and a step of the optimiser is a ratio. Over small ranges
# of the constants particles rearrange, and the curves jump a little: at the truth the slopes over the yield stress from differences
# of 1e-6 to 5 % differ by up to a third. A fit by small differences can stop where a jump hides the slope, so `diff_step` is 20 %.
# The fit starts at 30 Pa and 20 Pa s.

# %%
runs = []


def residuals(logarithms):
    constants = np.exp(logarithms)
    runs.append(constants)
    return ((curves(*constants)[1] - measured) / NOISE).ravel()


start = np.log([30.0, 20.0])
step = np.log(1.2) / np.abs(start)  # least_squares takes steps relative to the unknowns
fit = least_squares(residuals, start, diff_step=step, xtol=1e-3, ftol=1e-4)
fitted = np.exp(fit.x)
deviations = np.sqrt(np.diag(np.linalg.inv(fit.jac.T @ fit.jac)))  # of the logarithms, from the noise alone
misfit = np.sqrt(np.mean(fit.fun**2))

# %%
for name, unit, value, deviation in zip(TRUTH, ("Pa", "Pa s"), fitted, deviations):
    error = value / TRUTH[name] - 1
    print(f"{name}: {value:.2f} {unit} ± {100 * deviation:.1f} %, truth {TRUTH[name]:g} {unit}, error {100 * error:+.1f} %")
print(f"{len(runs)} runs; what remains is {misfit:.2f} times the noise")

# %%
first_guess, best = curves(*np.exp(start))[1], curves(*fitted)[1]
figure, axes = plt.subplots(figsize=(5.5, 3.2), layout="constrained")
for k, (what, color) in enumerate((("height", "tab:blue"), ("half width", "tab:orange"))):
    axes.plot(times, measured[k] * 1e3, ".", color=color, label=f"{what}, measured")
    axes.plot(times, best[k] * 1e3, "-", color=color, label="fitted")
    axes.plot(times, first_guess[k] * 1e3, ":", color=color, label="first guess")
axes.set(xlabel="time [s]", ylabel="mm", title=f"yield stress {fitted[0]:.1f} Pa, plastic viscosity {fitted[1]:.1f} Pa s")
axes.legend(fontsize=7, ncols=2)
figure.savefig("fit_rheology.png", dpi=80)

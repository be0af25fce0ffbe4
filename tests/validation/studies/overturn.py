"""The root mean square of the velocity while two fluids change places, in units of h/T with T = mu / ((rho_1 - rho_2) g h): its
largest value and when it is there, against codes with fixed grids and markers (van Keken et al. 1997, table 2). An interface between
particles of a lattice has another amplitude than the 0.02 h of the cosine: the time is that of 0.02 h, by the rate of the growth."""

import numpy as np
from study import Level, Outcome, Study

height, length, mu, weight = 0.07, 0.128, 10, 100  # [m], [m], [Pa s], [N/m3]
unit = mu / (weight * height)  # [s]
most, when, amplitude = 0.003091, 208.5, 0.02


def measure(run):
    time, start = run.history["time"] / unit, next(run.frames())
    volume = length * height / len(start.position)
    mass = volume * np.where(start.material == 1, 500, 1000).sum()
    speed = np.sqrt(2 * run.history["kinetic_energy"] / mass) / (height / unit)
    light = start.position[start.material == 1, 0]
    began = 2 / length * volume * np.cos(2 * np.pi / length * light).sum() / height
    linear = (time > 40) & (time < 90)
    rate = np.polyfit(time[linear], np.log(speed[linear]), 1)[0]
    k = speed.argmax()
    late = time[k] + np.log(began / amplitude) / rate
    scatter = np.std(speed[k - 8 : k + 9] / speed[k])
    errors = {"largest speed": abs(speed[k] / most - 1), "time": abs(late / when - 1), "scatter": scatter}
    values = {"largest": speed[k], "at": late, "amplitude": began}
    exact = {"van Keken et al.": (np.array([when, when, 0]), np.array([0, most, most]))}
    return Outcome(errors, values, {"measured": (time, speed)}, exact)


study = Study(
    name="overturn",
    title="Overturn of two fluids",
    levels=[Level(1), Level(2)],
    bars={"largest speed": 0.3, "time": 0.15, "scatter": 0.01},
    orders={"largest speed": 0.7, "time": 0.7},
    measure=measure,
    x_label="t / T",
    y_label="root mean square of the velocity over h/T",
)

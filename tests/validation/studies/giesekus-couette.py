"""Steady shear of a Giesekus fluid (H. Giesekus, J. Non-Newton. Fluid Mech. 11, 1982): viscosities from the forces on the plates, normal
stresses from the fluid."""

import numpy as np
from study import Level, Outcome, Study

rates, length = np.array([0.5, 5.0, 20.0]), 0.02  # [1/s], plates [m]
solvent, polymer, relaxation, mobility = 1.0, 9.0, 0.5, 0.2


def exact(rate):
    """Viscosity [Pa s] and first normal stress difference [Pa]."""
    w2, a = (relaxation * rate) ** 2, mobility
    k = 8 * a * (1 - a) * w2
    chi = np.sqrt((np.sqrt(1 + 2 * k) - 1) / k)
    f = (1 - chi) / (1 + (1 - 2 * a) * chi)
    viscosity = solvent + polymer * (1 - f) ** 2 / (1 + (1 - 2 * a) * f)
    normal = 2 * polymer * relaxation * rate**2 * f * (1 - a * f) / (w2 * a * (1 - f))
    return viscosity, normal


def measure(run):
    late = run.balance["time"] > run.times[-1] - 0.5
    forces = np.array([np.mean(run.balance[f"plate {k}_force_x"][late]) for k in range(4)])
    found = np.cumsum(forces)[:3] / length / rates  # the fluid drags a plate forward from above and holds it from below
    viscosity, normal = exact(rates)
    frame = run.frame()
    y, difference = frame.position[:, 1], frame.elastic_stress_xx - frame.elastic_stress_yy
    errors, values = {}, {}
    for k, rate in enumerate(rates):
        inside = abs(y - 0.012 * k - 0.004) < 0.0025
        n1 = np.mean(difference[inside])
        errors[f"viscosity at {rate:g}/s"] = abs(found[k] / viscosity[k] - 1)
        errors[f"normal stress at {rate:g}/s"] = abs(n1 / normal[k] - 1)
        values[f"viscosity at {rate:g}/s [Pa s]"] = found[k]
    line = np.geomspace(0.1, 100, 61)
    return Outcome(errors, values, {"measured": (rates, found)}, {"exact": (line, exact(line)[0])})


study = Study(
    name="giesekus-couette",
    title="Couette flow of a Giesekus fluid",
    levels=[Level(1), Level(2)],
    bars={f"{what} at {rate:g}/s": 0.02 for rate in rates for what in ("viscosity", "normal stress")},
    measure=measure,
    x_label="shear rate [1/s]",
    y_label="viscosity [Pa s]",
    refined=False,
)

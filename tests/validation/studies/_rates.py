"""Viscosity at five shear rates, from the forces on the plates between which the fluid is sheared."""

import numpy as np
from study import Outcome

rates, length = np.array([0.3, 1, 3, 10, 30]), 0.02  # [1/s], plates [m]


# No order is asked for. What is left of the errors is that of a sum over a lattice within 3.5 spacings, whatever the
# spacing: Newtonian fluid has the same, and 4 spacings have 0.1 to 0.3 %.


def measurement(viscosity):
    """viscosity(rate): the exact one [Pa s]."""

    def measure(run):
        late = run.balance["time"] > run.times[-1] / 2
        forces = np.array([np.mean(run.balance[f"plate {k}_force_x"][late]) for k in range(6)])
        stress = np.cumsum(forces)[:5] / length  # the fluid drags a plate forward from above and holds it from below
        found, exact = stress / rates, viscosity(rates)
        errors = {f"viscosity at {rate:g}/s": abs(error) for rate, error in zip(rates, found / exact - 1, strict=True)}
        line = np.geomspace(0.1, 100, 61)
        return Outcome(errors, {f"at {rate:g}/s [Pa s]": mu for rate, mu in zip(rates, found, strict=True)},
                       {"measured": (rates, found)}, {"exact": (line, viscosity(line))})

    return measure

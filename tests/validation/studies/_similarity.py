"""What the gravity currents share. Their late shape is h = h0 (1 - (x / x_N)^2)^(1/3) with x_N = prefactor (g V^s t / 3 nu)^exponent
[Huppert 1982]; x_N is measured as the end of that shape with the second moment that the fluid has."""

import numpy as np
from study import Outcome

gravity, viscosity = 10, 0.02  # [m/s2], kinematic [m2/s]


def measurement(dimensions, prefactor, power, exponent, moment, since):
    """measure() of a current; moment: <x^2> / x_N^2 of the similarity shape; since: what is fitted begins there [s]."""

    def measure(run):
        first = run.frame(0).position
        volume = len(first) * np.diff(np.unique(first[:, 0].round(9))).min() ** dimensions
        volume /= 2 if dimensions == 2 else 1  # on one side of the origin
        times = run.times[1:]
        distances = [np.linalg.norm(f.position[:, :-1], axis=1) for f in run.frames()][1:]
        fronts = {
            "by moment": np.array([np.sqrt(np.mean(x**2) / moment) for x in distances]),
            "outermost particle": np.array([x.max() for x in distances]),
        }
        unit = (gravity * volume**power / (3 * viscosity)) ** exponent
        late = times >= since * (1 - 1e-9)
        errors, values, curves = {}, {}, {}
        for name, front in fronts.items():
            found = np.polyfit(np.log(times[late]), np.log(front[late]), 1)[0]
            factor = np.mean(front[late] / times[late] ** exponent) / unit
            if name == "by moment":
                errors = {"prefactor": abs(factor / prefactor - 1), "exponent": abs(found / exponent - 1)}
            values[f"exponent {name} (exact {exponent:g})"] = found
            values[f"prefactor {name} (exact {prefactor:g})"] = factor
            curves[name] = (times, front / (unit * times**exponent))
        return Outcome(errors, values, curves, {"exact": (times, np.full_like(times, prefactor))})

    return measure

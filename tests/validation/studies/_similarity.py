"""What the gravity currents share. Their late shape is h = h0 (1 - (x / x_N)^2)^(1/3) with x_N = prefactor (g V^s t / 3 nu)^exponent
[Huppert 1982]; x_N is measured as the end of that shape with the second moment that the fluid has. At a finite time the prefactor and
the exponent of the same fluid in the thin-film equation are others; errors are those against these (reference/thin_film.py)."""

import json

import numpy as np
from study import Outcome, cases

gravity, viscosity = 10, 0.02  # [m/s2], kinematic [m2/s]
record = cases.parent / "reference" / "thin_film.json"


def measurement(name, dimensions, prefactor, power, exponent, moment, since):
    """measure() of a current; name: in the record; prefactor, exponent: Huppert's; moment: <x^2> / x_N^2 of the similarity shape;
    since: what is fitted begins there [s]."""

    def measure(run):
        first = run.frame(0).position
        volume = len(first) * np.diff(np.unique(first[:, 0].round(9))).min() ** dimensions
        volume /= 2 if dimensions == 2 else 1  # on one side of the origin
        times = run.times[1:]
        distances = [np.linalg.norm(f.position[:, :-1], axis=1) for f in run.frames()][1:]
        exact_times, exact_front = np.array(json.loads(record.read_text())[name]["fronts"]).T
        fronts = {
            "by moment": np.array([np.sqrt(np.mean(x**2) / moment) for x in distances]),
            "outermost particle": np.array([x.max() for x in distances]),
            "thin film": np.exp(np.interp(np.log(times), np.log(exact_times), np.log(exact_front))),
        }
        unit = (gravity * volume**power / (3 * viscosity)) ** exponent
        late = times >= since * (1 - 1e-9)
        powers = {label: np.polyfit(np.log(times[late]), np.log(front[late]), 1)[0] for label, front in fronts.items()}
        factors = {label: np.mean(front[late] / times[late] ** exponent) / unit for label, front in fronts.items()}
        errors = {"prefactor": abs(factors["by moment"] / factors["thin film"] - 1),
                  "exponent": abs(powers["by moment"] / powers["thin film"] - 1)}
        values = {}
        for label in fronts:
            values[f"exponent {label} (Huppert {exponent:g})"] = powers[label]
            values[f"prefactor {label} (Huppert {prefactor:g})"] = factors[label]
        curves = {label: (times, front / (unit * times**exponent)) for label, front in fronts.items()}
        exact = {"thin film": curves.pop("thin film"), "Huppert": (times, np.full_like(times, prefactor))}
        return Outcome(errors, values, curves, exact)

    return measure

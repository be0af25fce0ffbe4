"""A fluid whose structure follows its shear: stresses at the plates against the rate equation."""

import numpy as np
from study import Level, Outcome, Study

length, build_up, break_down = 0.02, 0.2, 0.1  # plates [m], [1/s], [-]


def structure(times, shear_rate):
    """At rising times, by steps of fourth order from 1; shear_rate(t) [1/s]."""
    h, s, t, found = 1e-3, 1.0, 0.0, []

    def f(t, s):
        return build_up * (1 - s) - break_down * s * shear_rate(t)

    for end in times:
        while t < end - h / 2:
            a = f(t + 1e-9, s)
            b = f(t + h / 2, s + h / 2 * a)
            c = f(t + h / 2, s + h / 2 * b)
            s, t = s + h / 6 * (a + 2 * b + 2 * c + f(t + h - 1e-9, s + h * c)), t + h
        found.append(s)
    return np.array(found)


def study(name, title, shear_rate, stress, skipped, x_of, x_label, bar):
    """stress(rate, structure) [Pa]; skipped(t): where the flow has not yet followed the plate; x_of(t): of the picture."""

    def measure(run):
        times = run.balance["time"]
        force = (run.balance["lower plate_force_x"] - run.balance["upper plate_force_x"]) / 2
        rates = np.array([shear_rate(t) for t in times])
        s = structure(times, shear_rate)
        exact, found = stress(rates, s), force / length
        counted = ~np.array([skipped(t) for t in times])
        largest = np.max(exact)
        frame = run.frame()
        errors = {
            "stress": np.sqrt(np.mean((found - exact)[counted] ** 2)) / largest,
            "structure": abs(np.mean(frame.structure) / structure([frame.time], shear_rate)[0] - 1),
        }
        x = np.array([x_of(t) for t in times])
        return Outcome(errors, {"largest stress [Pa]": np.max(found[counted])}, {"measured": (x[counted], found[counted])},
                       {"exact": (x[counted], exact[counted])})

    return Study(
        name=name,
        title=title,
        levels=[Level(1), Level(2)],
        bars={"stress": bar, "structure": bar},
        measure=measure,
        x_label=x_label,
        y_label="shear stress [Pa]",
        refined=False,
    )

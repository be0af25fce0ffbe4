import numpy as np
from study import Level, Outcome, Study


def measure(run):
    """What is missing from kinetic + potential + elastic energy + dissipated - work of walls = constant, over the potential
    energy released in the run: the largest of all times, and its two parts. Elastic energies are known at the start of a step,
    so the state after the last step is left out."""
    h, b = run.history, run.balance
    dt = h["time_step"]
    first = run.frame(0)
    mass = 1000 * 1e-3**2  # of a particle, per metre [kg/m]
    at_start = 10 * mass * first.position[:, 1].sum()
    motion = np.append(at_start, h["kinetic_energy"] + h["potential_energy"])  # at step 0, 1, ...
    released = at_start - h["potential_energy"][-1]
    spent = np.cumsum(dt * (b["shear_dissipation"] + b["bulk_dissipation"] - b["wall_power"]
                              - b.get("repulsion_power", 0) - b.get("shift_power", 0)))
    missing = (motion[1:-1] + b["elastic_energy"][1:] + spent[:-1] - at_start) / released
    work = np.cumsum(dt * b["elastic_power"])[:-1]
    elastic = (b["elastic_energy"][1:] + work) / released  # that elastic pressures gave and did not have
    inertial = np.cumsum(dt * b["inertial_loss"])[:-1] / released
    errors = {"closing": abs(missing).max(), "elastic part": abs(elastic).max(), "inertial part": inertial.max(),
              "beyond the two parts": abs(missing - elastic + inertial).max()}

    def share(column):
        return (dt * b[column]).sum() / released

    values = {"shear dissipation / released": share("shear_dissipation"), "bulk dissipation / released": share("bulk_dissipation")}
    return Outcome(errors, values, {"missing": (h["time"][:-1], missing)}, {"exact": (h["time"], np.zeros_like(dt))})


study = Study(
    name="energy",
    title="Energy balance of the dam break, at one spacing and several time steps",
    levels=[Level(1, (f"time.step={dt:g}",)) for dt in (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)],
    bars={"closing": 0.0125, "elastic part": 0.0145, "inertial part": 0.0057, "beyond the two parts": 1e-7},
    published={"closing": 0.013, "elastic part": 0.018, "inertial part": 0.0055},
    # What elastic pressures give is not what elastic energies lose where the gradient is renormalised, whatever the step: only the bars
    # hold that part. The sum of both parts, which have opposite signs, has no order either.
    orders={"closing": float("-inf"), "elastic part": float("-inf")},
    measure=measure,
    x_label="t [s]",
    y_label="missing energy / potential energy released",
    size=lambda level: float(level.settings[0].split("=")[1]),
)

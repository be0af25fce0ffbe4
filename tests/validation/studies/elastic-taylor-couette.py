"""Taylor-Couette flow of an Oldroyd-B fluid: the pressure that its hoop stress makes. The velocity is that of a Newtonian fluid,
A r + B / r, tau_tt - tau_rr = 2 eta lambda (2 B / r^2)^2, and dp/dr = rho u^2 / r - (tau_tt - tau_rr) / r (R. B. Bird,
R. C. Armstrong, O. Hassager, Dynamics of Polymeric Liquids 1, 1987)."""

import itertools

import numpy as np
from studies._cylinders import A, B, inner, outer, polar, spin
from study import Level, Outcome, Study

density, solvent, polymer, relaxation = 1000.0, 5.0, 5.0, 0.05


def pressure(r):
    """Less that in the middle of the gap [Pa]."""

    def integral(x):
        inertia = density * (A**2 * x**2 / 2 + 2 * A * B * np.log(x) - B**2 / (2 * x**2))
        return inertia + 2 * polymer * relaxation * B**2 / x**4

    return integral(r) - integral((inner + outer) / 2)


def hoop(r):
    """First normal stress difference [Pa]."""
    return 2 * polymer * relaxation * (2 * B / r**2) ** 2


def measure(run):
    half = run.times[-1] / 2
    frames = [frame for frame in run.frames() if frame.time > half]
    r, along, across = polar(frames)
    late = run.balance["time"] > half
    exact = 4 * np.pi * (solvent + polymer) * B  # torque per metre [N]
    torque = {name: abs(np.mean(run.balance[f"{name}_torque"][late])) / exact for name in ("inner", "outer")}
    names = ["pressure", "elastic_stress_xx", "elastic_stress_xy", "elastic_stress_yy"]
    field = {name: np.concatenate([getattr(frame, name) for frame in frames]) for name in names}
    position = np.concatenate([frame.position for frame in frames])
    c, s = position[:, 0] / r, position[:, 1] / r
    xx, xy, yy = (field[f"elastic_stress_{k}"] for k in ("xx", "xy", "yy"))
    normal = (xx - yy) * (s**2 - c**2) - 4 * xy * c * s  # tau_tt - tau_rr
    # Means over rings, away from the cylinders.
    edges = np.linspace(inner + 0.001, outer - 0.001, 9)
    middle = (edges[1:] + edges[:-1]) / 2
    ring = [(r > a) & (r < b) for a, b in itertools.pairwise(edges)]
    p = np.array([np.mean(field["pressure"][k]) for k in ring])
    n1 = np.array([np.mean(normal[k]) for k in ring])
    expected, hoops = (np.array([np.mean(f(r[k])) for k in ring]) for f in (pressure, hoop))
    p -= np.mean(p - expected)
    errors = {"velocity": np.sqrt(np.mean((along - A * r - B / r) ** 2 + across**2)) / (spin * inner),
              "torque, inner": abs(torque["inner"] - 1), "torque, outer": abs(torque["outer"] - 1),
              "normal stress": np.max(abs(n1 - hoops)) / np.max(hoops),
              "pressure": np.max(abs(p - expected)) / np.ptp(expected)}
    line = np.linspace(inner, outer, 101)
    return Outcome(errors, {}, {"measured": (middle, p)}, {"exact": (line, pressure(line))})


study = Study(
    name="elastic-taylor-couette",
    title="Taylor-Couette flow of an Oldroyd-B fluid",
    levels=[Level(1), Level(2)],
    bars={"velocity": 0.035, "torque, inner": 0.01, "torque, outer": 0.01, "normal stress": 0.05, "pressure": 1.4},
    measure=measure,
    x_label="r [m]",
    y_label="pressure [Pa]",
)

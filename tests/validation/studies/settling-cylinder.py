import numpy as np
from study import Level, Outcome, Study

mu, weight = 10, 1000 * 9.81  # [Pa s], [N/m3] less buoyancy
radius, gap = 0.005, 0.025    # from the middle to the plates [m]


def speed(a):
    """Of a cylinder in the middle between plates (Faxen 1946)."""
    k = a / gap
    slowed = -0.9157 - np.log(k) + 1.7244 * k**2 - 1.7302 * k**4 + 2.4056 * k**6 - 4.5913 * k**8
    return weight * np.pi * a**2 * slowed / (4 * np.pi * mu)


def measure(run):
    bodies = run.rigid_bodies
    t, found = bodies["time"], -bodies["cylinder_velocity_y"]
    late = found[t > 0.75 * t[-1]].mean()
    return Outcome({"speed": abs(late / speed(radius) - 1)},
                   {"speed [mm/s]": 1e3 * late, "sideways over that": np.max(abs(bodies["cylinder_velocity_x"])) / late},
                   {"particles": (t, 1e3 * found)}, {"Faxen": (t, np.full(len(t), 1e3 * speed(radius)))})


study = Study(
    name="settling-cylinder",
    title="Cylinder that settles between plates",
    levels=[Level(1), Level(2)],
    bars={"speed": 0.14},
    refined=False,
    measure=measure,
    x_label="t [s]",
    y_label="speed [mm/s]",
)

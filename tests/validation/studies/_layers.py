"""Plane Couette flow of two layers, whatever the viscosity of the upper one."""

import numpy as np
from study import Level, Outcome, Study

H, U, width = 0.01, 0.2, 0.016  # of each layer [m], upper plate [m/s], period [m]
lower = 10  # viscosity [Pa s]


def layered(name, title, upper, bars, published=None):
    """upper: viscosity [Pa s]. The velocity of the interface is what the profile of either layer says there, a line through the particles
    that are three spacings and more from interface and plates; both must be right, in parts of U."""
    stress = U / (H / lower + H / upper)
    interface = stress * H / lower

    def extrapolated(frame, bottom, spacing):
        y, u = frame.position[:, 1], frame.velocity[:, 0]
        inside = (y > bottom + 3 * spacing) & (y < bottom + H - 3 * spacing)
        return np.polyval(np.polyfit(y[inside], u[inside], 1), H)

    def measure(run):
        frame = run.frame()
        spacing = np.sqrt(2 * H * width / len(frame.position))
        late = run.balance["time"] > 0.8 * run.times[-1]
        forces = [run.balance["lower plate_force_x"][late].mean() / width, -run.balance["upper plate_force_x"][late].mean() / width]
        found = [extrapolated(frame, bottom, spacing) for bottom in (0, H)]
        errors = {"stress": max(abs(f / stress - 1) for f in forces),
                  "interface velocity": max(abs(u - interface) / U for u in found)}
        values = {"stress / exact, lower plate": forces[0] / stress, "upper plate": forces[1] / stress,
                  f"interface / U (exact {interface / U:.1e}), from below": found[0] / U, "from above": found[1] / U}
        rows = np.argsort(frame.position[:, 1])
        y = np.array([0, H, 2 * H])
        return Outcome(errors, values, {"particles": (frame.position[rows, 1], frame.velocity[rows, 0] / U)},
                       {"exact": (y, np.array([0, interface / U, 1]))})

    return Study(name=name, title=title, case="two-layer-couette.toml", settings=(f"upper.dynamic_viscosity={upper}",),
                 levels=[Level(1), Level(2), Level(4)], bars=bars, published=published or {}, measure=measure,
                 x_label="y [m]", y_label="u / U")

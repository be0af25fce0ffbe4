import numpy as np
from study import Level, Outcome, Study

h0, omega, nu = 2e-3, 50.0, 1e-2  # thickness [m], [rad/s], viscosity [m2/s]
strip = 8e-3  # half of the width that the thickness is measured over, far from the ends [m]


def measure(run):
    """Thicknesses from the volume over the middle of the plate, each particle with the part of its width that is there."""
    spacing = np.sqrt(0.04 * h0 / run.summary["fluid_particles"])
    thickness = []
    for frame in run.frames():
        x = frame.position[:, 0]
        part = np.clip((strip + spacing / 2 - abs(x)) / spacing, 0, 1)
        thickness.append(np.sum(part) * spacing**2 / (2 * strip))
    t = run.times
    # Thin film: q = omega^2 x h^3 / (3 nu) along a plate, and dh/dt = -dq/dx.
    exact = h0 / np.sqrt(1 + 2 * omega**2 * h0**2 * t / (3 * nu))
    off = np.array(thickness) / exact - 1
    return Outcome({"thickness at the end": abs(off[-1]), "thickness": np.sqrt(np.mean(off**2))},
                   {"thickness at the end [mm]": 1e3 * thickness[-1]}, {"middle of the plate": (t, np.array(thickness))},
                   {"thin film": (t, exact)})


study = Study(
    name="spin-coating",
    title="Film on a turning plate",
    levels=[Level(1), Level(2), Level(4)],
    bars={"thickness at the end": 0.004, "thickness": 0.003},
    measure=measure,
    x_label="t [s]",
    y_label="thickness [m]",
)

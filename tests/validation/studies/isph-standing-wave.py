import numpy as np
from study import Level, Outcome, Study

L, H, g, nu, U = 1.0, 0.5, 9.81, 1e-2, 0.1  # tank, depth [m], [m/s2], viscosity [m2/s], speed at the surface [m/s]
k = np.pi / L
omega, decay = np.sqrt(g * k * np.tanh(k * H)), 2 * nu * k**2  # linear theory [1/s]


def fit(t, x):
    """(frequency, decay) of exp(-decay t) (c cos wt + s sin wt) + constant, by Gauss-Newton steps from theory; the linear part is
    solved for at each."""
    def model(p):
        wave = np.exp(-p[1] * t)
        basis = np.stack([wave * np.cos(p[0] * t), wave * np.sin(p[0] * t), np.ones_like(t)], axis=1)
        return basis @ np.linalg.lstsq(basis, x, rcond=None)[0]
    p = np.array([omega, decay])
    for _ in range(20):
        step = 1e-5
        slopes = np.stack([(model(p + step * e) - model(p - step * e)) / (2 * step) for e in np.eye(2)], axis=1)
        p = p + np.linalg.lstsq(slopes, x - model(p), rcond=None)[0]
    return p


def measure(run):
    """From the centre of mass, which swings along the tank with the first mode and with none of the other even ones."""
    centre = np.array([f.position[:, 0].mean() for f in run.frames()]) - L / 2
    frequency, damping = fit(run.times, centre)
    # The mean of u = U sin(kx) cosh(ky) / sinh(kH) is 2 U / (pi k H).
    size = 2 * U / (np.pi * k * H) / omega
    exact = size * np.exp(-decay * run.times) * np.sin(omega * run.times)
    errors = {"frequency": abs(frequency / omega - 1), "decay": abs(damping / decay - 1),
              "centre": np.sqrt(np.mean((centre - exact) ** 2)) / size}
    values = {"frequency / exact": frequency / omega, "decay / exact": damping / decay,
              "mean density at the end": run.history["mean_density"][-1]}
    return Outcome(errors, values, {"centre of mass": (run.times, centre)}, {"exact": (run.times, exact)})


study = Study(
    name="isph-standing-wave",
    title="ISPH: standing wave",
    levels=[Level(1), Level(2), Level(4)],
    bars={"frequency": 0.02, "decay": 0.16, "centre": 0.03},
    ranges={"isph": {"frequency / exact": (0.98, 1.02)}},
    measure=measure,
    x_label="t [s]",
    y_label="centre of mass along the tank [m]",
)

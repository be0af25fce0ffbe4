import numpy as np
from studies._channels import profiles
from study import Level, Outcome, Study

H, nu, slip, g = 0.02, 0.01, 0.1, 1.0  # depth [m], viscosity [m2/s], slip length [m], acceleration [m/s2]
U = 0.4  # [m/s]


def modes(count=60):
    """Wave numbers k of cos k(H - y), for which u(0) = slip du/dy(0): cos kH = slip k sin kH; the n-th is between n pi/H and
    (n + 1/2) pi/H, and is found by bisection."""
    low = np.arange(count) * np.pi / H
    high = low + np.pi / (2 * H)
    for _ in range(80):
        middle = (low + high) / 2
        sign = (np.cos(middle * H) - slip * middle * np.sin(middle * H)) * np.cos(np.arange(count) * np.pi)
        low, high = np.where(sign > 0, middle, low), np.where(sign > 0, high, middle)
    return (low + high) / 2


def film(y, t):
    """u(y, t) / U: the steady profile and the modes that fade."""
    k = modes()[:, None]
    mean, square = np.sin(k * H) / k, H / 2 + np.sin(2 * k * H) / (4 * k)  # integrals of a mode and of its square
    fading = g / (nu * k**2) * mean / square * np.cos(k * (H - y)) * np.exp(-nu * k**2 * t)
    return (g / nu * (slip * H + y * (H - y / 2)) - fading.sum(axis=0)) / U


def measure(run):
    errors, curves, solutions = profiles(run, (0.1, 0.25, 0.5), film, H, U)
    frame = run.frame()
    line = np.linspace(0, H, 201)
    return Outcome(errors, {"speed / exact": np.mean(frame.velocity[:, 0]) / (U * np.mean(film(line, frame.time)))}, curves, solutions)


study = Study(
    name="sliding-film",
    title="Film that slides on a floor",
    levels=[Level(1), Level(2), Level(4)],
    bars={"t = 0.1 s": 0.004, "t = 0.25 s": 0.004, "t = 0.5 s": 0.004},
    measure=measure,
    x_label="y [m]",
    y_label="u / U",
)

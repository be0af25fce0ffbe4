import numpy as np
from studies._tension import centred, radius, spacing_of, tension, viscosity
from study import Level, Outcome, Study

reach = 3.5  # of the stress at the surface, in spacings


def measure(run):
    """Pressures inside are those of the particles deeper than the stress reaches, over the last half of the run; velocities are
    counted in gamma/mu, at the end."""
    spacing = spacing_of(run.frame(0))
    frames = list(run.frames())
    pressure, speed = [], []
    for frame in frames[1:]:
        x = centred(frame)
        size = np.sqrt(len(x) * spacing**2 / np.pi)
        inside = np.hypot(*x.T) < size - reach * spacing
        pressure.append(frame.pressure[inside].mean() * size / tension)
        speed.append(np.sqrt((frame.velocity**2).sum(axis=1).mean()) * viscosity / tension)
    ratio = np.mean(pressure[len(pressure) // 2:])
    last = frames[-1]
    largest = np.sqrt((last.velocity**2).sum(axis=1).max()) * viscosity / tension
    errors = {"Laplace pressure": abs(ratio - 1), "spurious currents": largest}
    values = {"pressure over gamma/R": ratio, "fastest particle over gamma/mu": largest,
              "mean speed over gamma/mu": speed[-1], "least distance over l": last.nearest_distance.min()}
    times = run.times[1:]
    return Outcome(errors, values, {"particles": (times, np.array(pressure))}, {"exact": (times, np.ones(len(times)))})


study = Study(
    name="static-drop",
    title="Laplace pressure of a drop",
    levels=[Level(1), Level(2), Level(4)],
    bars={"Laplace pressure": 0.03, "spurious currents": 1e-3},
    orders={"Laplace pressure": 0.8},
    measure=measure,
    x_label="t [s]",
    y_label="pressure over gamma/R",
)

import numpy as np
from studies._tension import capillary_time, centred
from study import Level, Outcome, Study

exact_rate = 1 / capillary_time  # gamma/(mu R), of an ellipse


def measure(run):
    """The ellipse is that of the second moments of the mass."""
    times = run.times
    moments = np.array([(centred(frame)**2).mean(axis=0) for frame in run.frames()])
    shape = (moments[:, 0] - moments[:, 1]) / moments.sum(axis=1)
    fitted = times > 0.009  # after the start from rest
    rate = -np.polyfit(times[fitted], np.log(shape[fitted]), 1)[0]
    values = {f"rate [1/s] (exact {exact_rate:.4g})": rate}
    return Outcome({"rate": abs(rate / exact_rate - 1)}, values, {"particles": (times, shape / shape[0])},
                   {"exact": (times, np.exp(-exact_rate * times))})


study = Study(
    name="relaxing-drop",
    title="Relaxation of a drop",
    levels=[Level(1), Level(2), Level(4)],
    bars={"rate": 0.065},
    orders={"rate": 0.7},
    measure=measure,
    x_label="t [s]",
    y_label="ellipticity over that at the start",
)

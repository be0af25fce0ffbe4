import numpy as np
from study import Level, Outcome, Study

finest = 0.7365  # the front at rest by a run at x4 [m]


def measure(run):
    """The front is the foremost particle; at rest is the end of the run, and creep what its last third adds."""
    front = np.array([frame.position[:, 0].max() for frame in run.frames()])
    creep = 1 - np.interp(2 / 3 * run.times[-1], run.times, front) / front[-1]
    return Outcome({"front at rest": abs(front[-1] / finest - 1), "creep": creep}, {"front at rest [m]": front[-1]},
                   {"front": (run.times, front)}, {"at rest, x4": (run.times, np.full(len(front), finest))})


study = Study(
    name="grease-dam-break",
    title="Dam break of grease, which comes to rest",
    levels=[Level(1), Level(2)],
    bars={"front at rest": 0.045, "creep": 0.01},
    measure=measure,
    x_label="t [s]",
    y_label="front [m]",
    case="../../../cases/grease-dam-break-2d.toml",
)

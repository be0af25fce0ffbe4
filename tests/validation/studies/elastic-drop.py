"""A drop of an Oldroyd-B fluid falls on a plate, spreads, and is drawn together by its elasticity, against a calculation on a grid."""

from pathlib import Path

import numpy as np
from study import Level, Outcome, Study

diameter, speed = 0.02, 1.0  # of the drop at the start [m], [m/s]
film = 0.05 * diameter  # below it a film of particles stays on the plate; on the grid air keeps the drop off
reference = np.loadtxt(Path(__file__).parents[1] / "reference" / "elastic_drop.csv", delimiter=",", skiprows=4)


def measure(run):
    times, widths = [], []
    spacing = (np.pi / 6 * diameter**3 / len(run.frame(0).position)) ** (1 / 3)
    for frame in run.frames():
        times.append(frame.time * speed / diameter)
        drop = frame.position[frame.position[:, 2] > film]
        widths.append((2 * np.hypot(drop[:, 0], drop[:, 1]).max() + spacing) / diameter)
    times, widths = np.array(times), np.array(widths)
    time, width = reference.T
    found = np.interp(time, times, widths)
    last = time > 2.5  # after the largest width

    def off(ours, theirs):
        return abs(ours / theirs - 1)

    errors = {"largest diameter": off(widths[times < 2.5].max(), width.max()),
              "smallest diameter after it": off(widths[times > 2.5].min(), width[last].min()),
              "diameter at the end": off(found[-1], width[-1]),
              "diameter, mean of t > 1.7": np.mean(abs(found / width - 1)[time > 1.7])}
    return Outcome(errors, {}, {"treacle": (times, widths)}, {"grid": (time, width)})


study = Study(
    name="elastic-drop",
    title="Impact of an elastic drop",
    levels=[Level(1), Level(2), Level(4)],
    bars={"largest diameter": 0.03, "smallest diameter after it": 0.06, "diameter at the end": 0.04, "diameter, mean of t > 1.7": 0.03},
    refined=False,  # the reference has another contact with the plate
    measure=measure,
    x_label="time [diameters over the first speed]",
    y_label="diameter over the first one",
)

import numpy as np
from study import Level, Outcome, Study
from treacle_data import read_table

H, mu, length, pressure = 0.02, 1.0, 0.06, 60.0  # gap [m], [Pa s], between the faces [m], [Pa]
exact = pressure * H**3 / (12 * mu * length)  # flow rate [m2/s]


def measure(run):
    """Flow rate and pressures of the second half of the run, when the flow is steady; volumes that went through, in and out then."""
    flow, middle = (read_table(run.path / "probes" / f"{name}.csv") for name in ("flow", "middle"))
    history = run.history
    late = flow["time"] > run.times[-1] / 2
    rate = flow["volume_flow_rate"][late]
    through = np.sum(np.diff(flow["time"][late]) * (rate[1:] + rate[:-1]) / 2)
    late = history["time"] > run.times[-1] / 2
    went = {way: np.ptp(history[f"{way}_volume"][late]) for way in ("inflow", "outflow")}
    steady = middle["time"] > run.times[-1] / 2
    x = np.unique(middle["x"])
    p = np.array([np.mean(middle["pressure"][steady & (middle["x"] == place)]) for place in x])
    slope, start = np.polyfit(x, p, 1)
    errors = {
        "flow rate": abs(np.mean(rate) / exact - 1),
        "pressure": np.sqrt(np.mean((p / pressure - (1 - x / length)) ** 2)),
        "volume in": abs(went["inflow"] / through - 1),
        "volume out": abs(went["outflow"] / through - 1),
    }
    values = {"flow rate / exact": np.mean(rate) / exact, "pressure at the inlet [Pa]": start,
              "pressure at the outlet [Pa]": start + slope * length}
    return Outcome(errors, values, {"middle of the channel": (x, p)}, {"exact": (x, pressure * (1 - x / length))})


study = Study(
    name="pressure-channel",
    title="Flow between openings",
    levels=[Level(1), Level(2), Level(4)],
    bars={"flow rate": 0.06, "pressure": 0.05, "volume in": 0.02, "volume out": 0.02},
    orders={"flow rate": 0.5, "pressure": 0.5, "volume in": 0.0, "volume out": 0.0},
    measure=measure,
    x_label="x [m]",
    y_label="pressure [Pa]",
)

"""Natural convection in a square cavity, against the benchmark of G. de Vahl Davis, Int. J. Numer. Methods Fluids 3, 1983."""

import numpy as np
from study import Level, Outcome, Study

side, warm, cold = 0.02, 350.0, 250.0  # [m], [K]
diffusivity = 1.408451e-4  # [m2/s]
tabled = {1e3: 1.118, 1e4: 2.243, 1e5: 4.519}  # mean Nusselt numbers by Rayleigh number


def nusselt(frame):
    """Of the whole cavity. The heat that crosses upright lines is the same for all of them once the flow is steady, and its mean over them
    is that of conduction between the sides and what the flow carries."""
    carried = np.mean(frame.velocity[:, 0] * (frame.temperature - (warm + cold) / 2))
    return 1 + carried * side / (diffusivity * (warm - cold))


def study(name, rayleigh, step, end, bars, levels=(1, 2, 4)):
    """step: at the first level [s]. end: when the flow is steady [s]. The mean is over the last fifth of the time."""

    def measure(run):
        times = np.array(run.times)
        numbers = np.array([nusselt(frame) for frame in run.frames()])
        late = times > 0.8 * times[-1] - 1e-9
        found = numbers[late].mean()
        expected = tabled[rayleigh]
        return Outcome({"Nusselt number": abs(found / expected - 1)},
                       {"Nusselt number": found, "its spread": np.ptp(numbers[late]), "at the start of the mean": numbers[late][0]},
                       {"found": (times, numbers)}, {"de Vahl Davis": (times[[0, -1]], np.array([expected, expected]))})

    settings = (f"gravity.acceleration=[0, {-0.880282 * rayleigh / 1e3:g}]", f"time.step={step:g}", f"time.end={end:g}",
                f"fluid.bulk_modulus={200 / step:g}", f"output.interval={end / 60:g}")
    return Study(name=name, title=f"Natural convection, Rayleigh number {rayleigh:g}", case="heated-cavity.toml", settings=settings,
                 levels=[Level(resolution) for resolution in levels], bars=bars, measure=measure, x_label="t [s]", y_label="Nu")

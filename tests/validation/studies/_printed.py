"""A wall of fresh concrete under a weight that grows while it builds up structure: the time of its collapse against bounds.

The concrete yields at k = 400 Pa (1 + t/30 s). In a plane the wall of height H and width w stands while rho g H <= 2 k, a field of
stress in balance below the yield stress; it collapses at the latest where a wedge of 45 degrees at its foot slides, rho g (H - w/2) = 2 k.
"""

from study import Level, Outcome, Study

H, width, density, gravity, yield_stress, build_up = 0.15, 0.02, 2100.0, 9.81, 400.0, 400.0 / 30  # [m], ..., [Pa], [Pa/s]


def collapse(printing, height):
    """When half the weight of that height reaches the yield stress, where that of the whole wall is reached in `printing` [s]."""
    return yield_stress / (density * gravity * height / 2 / printing - build_up)


def study(name, title, printing, end):
    load = density * gravity * H / 2 / printing
    collapses = load > build_up

    def measure(run):
        time, speed = run.history["time"], run.history["max_speed"]
        fast = time[speed > 3e-4]
        height = run.history["top"] / run.history["top"][0]
        if not collapses:
            return Outcome({"height": 1 - height[-1]}, {}, {"measured": (time, height)})
        found = fast[0] if len(fast) else end
        earliest, latest = collapse(printing, H), collapse(printing, H - width / 2)
        outside = max(earliest - found, found - latest, 0) / earliest if len(fast) else 1
        values = {"collapse [s]": found, "earliest [s]": earliest, "latest [s]": latest}
        return Outcome({"collapse outside of the bounds": outside}, values, {"measured": (time, height)})

    return Study(
        name=name,
        title=title,
        levels=[Level(1), Level(2)],
        bars={"collapse outside of the bounds": 0.01} if collapses else {"height": 0.01},
        measure=measure,
        x_label="t [s]",
        y_label="height over that at the start",
        case="../../../cases/concrete-wall-2d.toml",
        settings=(f'gravity.acceleration=[0,"-9.81*t/{printing:g}"]', f"time.end={end:g}", "time.step=0.05"),
        refined=False,
    )

"""What judgements are made with: functions of Results that hold one statement of a paper against our numbers and return
(verdict, numbers), or None where nothing was measured."""

from cases import resolutions, scaled
from item import number
from spec import Spec


def verdict(all_hold, some_hold):
    return "confirmed" if all_hold else "partly" if some_hold else "contradicted"


def told(found):
    return ", ".join(f"{label} {number(a)}/{number(b)}" for label, a, b in found)


def smaller(points, what):
    """points: (label, value that the paper has smaller, the other)."""
    found = [p for p in points if p[1] is not None and p[2] is not None]
    if not found:
        return None
    holds = [a < b for _, a, b in found]
    missing = [p[0] for p in points if p not in found]
    more = f" (not measured: {', '.join(missing)})" if missing else ""
    return verdict(all(holds), any(holds)), f"{what}: {told(found)}{more}"


def both(*judged):
    """All of several; not confirmed where one of them was not measured."""
    known = [j for j in judged if j]
    if not known:
        return None
    verdicts = [v for v, _ in known] + ["partly"] * (len(known) < len(judged))
    return verdict(all(v == "confirmed" for v in verdicts), any(v != "contradicted" for v in verdicts)), "; ".join(
        text for _, text in known
    )


def sizes(results):
    """2D cases with a state at 0.2 s."""
    found = [(scaled(f), results.get(Spec("state", scaled(f)))) for f in resolutions]
    return [c for c, state in found if state and abs(state["time"] - 0.2) < 1e-9]


def iteration_points(results, cases, a, b):
    return [(c.full_label, results.iterations(c, a), results.iterations(c, b)) for c in cases]


def time_points(results, cases, a, b, backend="device", threads=0):
    return [
        (c.full_label, results.unit_time(c, a, backend, threads), results.unit_time(c, b, backend, threads)) for c in cases
    ]

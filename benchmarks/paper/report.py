"""Writes docs/reproduction.md, and its pictures, from a record. The page holds nothing that is not computed from the record, but
for what the papers say."""

from draw import draw
from item import number
from plan import items
from statements import statements

head = """# Reproduction of the two papers

treacle reproduces every table and figure of [K23] and [O23] that has numbers. One script measures them and writes this page:

```sh
benchmarks/paper/reproduce.py --program treacle --backend cuda --out DIR --portion 1      # then 2, 3, 4; or --all
benchmarks/paper/reproduce.py --collect DIR --record benchmarks/results/RECORD.json
benchmarks/paper/reproduce.py --report benchmarks/results/RECORD.json                     # this page
```

- CG, CR, MGCG and MGCR are the solvers of the papers in treacle: double precision, the last velocity as first guess, |r|²/|b|² < 1e-12, the sweeps of the authors' program. *Ours* is treacle's default solver.
- The cases of [K23] use its formulas (`scheme = "published"`, `cases/published` and `cases/small`). Cases have the names of the paper: x1/4 is resolution 4, x2 is resolution 0.5. N is the number of fluid particles.
- The default solver computes the states at 0.2 s. Each solver takes a few steps from their checkpoints. Iterations are those of the first step (of ours, the mean), times those of the median of the other steps.
- The figures in the papers have no readable points. This page therefore judges the statements of the papers, and compares iterations with those of the authors' published program. Rounding changes counts of late states by some 5 %.
- A number agrees with a printed one if it is within 0.6 %, the rounding of three digits.
- The authors' machines are one NVIDIA A100 (80 GB) and one Xeon Gold 6252.
- Tables show the first and the last case, pictures and the record all. The commit of the record, named below, may be an earlier state of the program.
"""


headings = {"time": "t [s]", "particles": "N"}
told_alone = {f"k23-fig{n}" for n in (4, 5, 7, 9, 10, 11, 14)}  # their readings have what a table would
hidden = {"on", "front_x", "top", "kinetic_energy", "potential_energy"}  # of the comparison of backends: differences say it


def shown(rows):
    """Of a longer series the first and the last row that is in the picture; the time is that of the pictures."""
    ends = [row for row in rows if row.get("time") == rows[0].get("time")]
    if "solver" not in rows[0] and "run" not in rows[0]:
        ends = ends[:1] + ends[1:][-1:]
    return [{k: v for k, v in row.items() if k != "time" and k not in hidden} for row in ends]


def markdown(rows):
    columns = list(dict.fromkeys(name for row in rows for name in row))
    columns = [c for c in columns if any(row.get(c) is not None for row in rows)]
    lines = ["| " + " | ".join(headings.get(c, c) for c in columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join(lines + ["| " + " | ".join(number(row.get(c)) for c in columns) + " |" for row in rows])


def used(item, results):
    return [found for spec in item.needs if (found := results.get(spec))]


def notes(item, results):
    """What is shortened or not there."""
    text = []
    for spec in item.needs:
        found = results.all.get(spec.key)
        if spec.kind == "state" and spec.case.shortened and results.get(spec):
            text.append(f"{spec.case.label} is taken at t = {spec.case.end:g} s instead of {spec.case.full_end:g} s.")
        if spec.kind == "convergence" and found and found.get("time", 0) < found.get("full_time", 0):
            text.append(f"{spec.case.label} is taken at t = {found['time']:g} s instead of {found['full_time']:g} s.")
        if found and "failed" in found:
            text.append(f"{spec.key} failed: {found['failed'].splitlines()[0][:200]}")
        if found and found.get("fallbacks") and spec.kind != "check":
            text.append(f"{spec.key}: {found['fallbacks']} fallbacks.")
    missing = [spec.key for spec in item.needs if spec.key not in results.all]
    if missing:
        text.append(
            f"{len(missing)} of {len(item.needs)} measurements were not made: {', '.join(missing[:6])}{' …' * (len(missing) > 6)}."
        )
    return list(dict.fromkeys(text))


def machines(item, results):
    """Device with threads where it is a processor, once each."""
    found = {
        f"{m['device']}" + (f" ({m['backend']})" if m["backend"] == "cpu" else "")
        for m in used(item, results)
        if "device" in m
    }
    return ", ".join(sorted(found))


def section(item, results, images, known):
    """known: sentences that the page has already."""

    def new(sentences):
        found = [text for text in sentences if text not in known]
        known.update(found)
        return found

    rows = item.rows(results)
    parts = [f"## {item.title}"]
    if not any(s.item == item.name for s in statements):  # else the statements are on the page
        parts.append(item.claim if item.name == "backends" else f"*Paper*: {item.claim}")
    if rows and "quantity" not in rows[0] and item.name not in told_alone:  # of parameters the reading names those that differ
        parts.append(markdown(shown(rows)))
    picture = images / f"reproduction-{item.name}.png"
    if item.plot and (plot := item.plot(rows, results)).curves:
        draw(item, plot, picture)
    if picture.exists() and (item.plot or used(item, results)):
        parts.append(f"![{item.title.split(':')[0]}](images/{picture.name})")
    reading = item.reading(rows, results)
    if not rows and not reading:
        parts.append("Not measured.")
    if told := new(reading):
        again = bool(rows) and "quantity" in rows[0] and len(told) < len(reading)
        parts.append(" ".join(told + ["The others differ for the reasons above."] * again))
    if extra := new(notes(item, results)):
        parts.append("*Notes*: " + " ".join(extra))
    return "\n\n".join(parts)


def judged(results):
    """Rows of the last table: a statement each."""
    rows = []
    for s in statements:
        verdict, numbers = s.judge(results) or ("not measured", "")
        rows.append({"statement": f"{s.text} ({s.source})", "verdict": verdict, "our numbers": numbers, "rule": s.rule})
    return rows


def page(record, results, docs):
    about = record["about"]
    lines = [
        head,
        f"Record: commit {', '.join(about['commits'])}; {', '.join(about['devices'])}. The measurements take "
        f"{sum(about['portion_seconds'].values()):.0f} s.",
    ]
    if about["quick"]:
        lines.append("**This is a quick trial of the script with few and small cases, not the reproduction.**")
    rows = judged(results)
    counts = {v: sum(r["verdict"] == v for r in rows) for v in ("confirmed", "partly", "contradicted", "not measured")}
    told = ", ".join(f"{n} {v}" for v, n in counts.items() if n)
    lines += [
        "## Statements",
        f"What the papers conclude, judged by our numbers: {told}. [statements.py](../benchmarks/paper/statements.py) has the rule "
        "of each verdict, and the record the numbers.",
    ]
    agreed = [(s.source, s.text) for s, r in zip(statements, rows, strict=True) if r["verdict"] == "confirmed"]
    for source in dict.fromkeys(source for source, _ in agreed):
        lines += [f"Confirmed, {source}:", "\n".join(f"- {text}" for at, text in agreed if at == source)]
    apart = [r for r in rows if r["verdict"] in ("partly", "contradicted")]
    if bullets := [f"- {r['statement']} *{r['verdict'].capitalize()}*: {r['our numbers']}." for r in apart]:
        lines += ["Confirmed in part, or contradicted (of a/b the paper has the first smaller):", "\n".join(bullets)]
    if missing := [f"- {r['statement']}" for r in rows if r["verdict"] == "not measured"]:
        lines += ["Not measured:", "\n".join(missing)]
    known: set[str] = set()
    lines += [section(item, results, docs / "images", known) for item in items.values()]
    (docs / "images").mkdir(parents=True, exist_ok=True)
    (docs / "reproduction.md").write_text("\n\n".join(line.rstrip() for line in lines) + "\n")

"""Writes docs/reproduction.md, and its pictures, from a record. The page holds nothing that is not computed from the record, but
for what the papers say."""

from draw import draw
from item import number
from plan import items, portions
from statements import statements

head = """# Reproduction of the two papers

Every table and figure of [K23] and [O23] that has numbers, measured with this program; written by one script from one record:

```sh
benchmarks/paper/reproduce.py --program treacle --backend cuda --out DIR --portion 1      # then 2, 3, 4; or --all
benchmarks/paper/reproduce.py --collect DIR --record benchmarks/results/RECORD.json
benchmarks/paper/reproduce.py --report benchmarks/results/RECORD.json                     # this page
```

CG, CR, MGCG, MGCR are the papers' solvers by this program: double precision, first guess the last velocity, |r|²/|b|² < 1e-12, the sweeps of
the authors' program. *Ours* is the program's default. States at 0.2 s are made by our default solver; from their checkpoints every solver
takes a few steps: iterations are those of the first of them (of ours, the mean), times those of the others' median step. The figures of the
papers have no readable points in the scans, so what is compared are their statements, and iterations that the authors' published program
gave. The cases of [K23] have its formulas, weights and radii (`scheme = "published"`, `cases/published` and `cases/small`). The authors'
machines: one NVIDIA A100 (80 GB), one Xeon Gold 6252. N is the number of fluid particles.
"""


headings = {"time": "t [s]", "particles": "N"}


def pivot(rows):
    """Parameters, a column per case; where the printed number is another one, it stands in brackets."""
    table = {}
    for r in rows:
        apart = r["difference"] is not None and abs(r["difference"]) > 0.006
        told = number(r["ours"]) + (f" ({number(r['printed'])})" if apart or r["ours"] is None else "")
        table.setdefault(r["quantity"], {"ours (printed, if another)": r["quantity"]})[r["case"]] = told
    return list(table.values())


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


def section(item, results, images):
    rows = item.rows(results)
    parts = [f"## {item.title}", f"*{'Task' if item.name == 'backends' else 'Paper'}*: {item.claim}"]
    if rows:
        parts.append(markdown(pivot(rows) if "quantity" in rows[0] else rows))
    picture = images / f"reproduction-{item.name}.png"
    if item.plot and (plot := item.plot(rows, results)).curves:
        draw(item, plot, picture)
    if picture.exists() and (item.plot or used(item, results)):
        parts.append(f"![{item.title}](images/{picture.name})")
    reading = item.reading(rows, results)
    parts += ["*Reading*: " + " ".join(reading)] if reading else ["Not measured."]
    if verdicts := [
        f"{s.text[:-1]}: **{s.judge(results)[0]}**." for s in statements if s.item == item.name and s.judge(results)
    ]:
        parts.append("*Verdict*: " + " ".join(verdicts))
    if extra := notes(item, results):
        parts.append("*Notes*: " + " ".join(extra))
    if on := machines(item, results):
        parts.append(f"Measured on {on}.")
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
        f"Record: commit {', '.join(about['commits'])}; {', '.join(about['devices'])}. Time of the measurements: "
        + ", ".join(f"portion {k} ({portions[int(k)]}) {v:.0f} s" for k, v in about["portion_seconds"].items())
        + ".",
    ]
    if about["quick"]:
        lines.append("**This is a quick trial of the script with few and small cases, not the reproduction.**")
    lines += [section(item, results, docs / "images") for item in items.values()]
    rows = judged(results)
    counts = {v: sum(r["verdict"] == v for r in rows) for v in ("confirmed", "partly", "contradicted", "not measured")}
    told = ", ".join(f"{n} {v}" for v, n in counts.items() if n)
    lines += [
        "## Statements",
        f"What the papers conclude and what that rests on, with our numbers: {told}. Of numbers a/b the paper has the first "
        "smaller. The rule that a verdict follows from stands in the last column.",
        markdown(rows),
    ]
    (docs / "images").mkdir(parents=True, exist_ok=True)
    (docs / "reproduction.md").write_text("\n\n".join(line.rstrip() for line in lines) + "\n")

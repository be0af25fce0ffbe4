"""The work of `treacle report`: parts of the page from the files of a run."""

import sys
from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from tqdm import tqdm

from . import report_curves, report_page, report_summary
from .arrays import Array
from .continued_run import run_of
from .errors import PictureError
from .report_frames import ReportFrames
from .run_files import RunFiles


def charts(run: RunFiles) -> list[dict[str, Any]]:
    """All curves of a RunFiles."""
    found = report_curves.of_history(run.history) + report_curves.of_balance(run.balance, run.history)
    found += report_curves.of_rigid_bodies(run.rigid_bodies)
    kinds = {probe["name"]: probe["type"] for probe in run.case.get("probe", [])}
    for name, table in run.probes.items():
        found += report_curves.of_probe(name, kinds.get(name), table)
    return found


def make(options: Namespace) -> None:
    """Makes the page. Raises PictureError, OSError."""
    run = run_of(options.directories)
    path = Path(options.output or run.path / "report.html")
    if not path.parent.is_dir():
        raise PictureError(f"{path}: no such directory: {path.parent}")

    def progress(work: Array) -> Iterable[int]:
        return tqdm(work, desc="reading frames", unit="frame", file=sys.stderr, disable=options.quiet)

    frames = ReportFrames(run, options.frames, options.max_points, progress)
    status, message = report_summary.status(run)
    content = report_page.page(
        title=run.title,
        subtitle=" · ".join(word for word in (run.places, report_summary.begun(run)) if word),
        status=status,
        message=message,
        rows=report_summary.rows(run),
        lines=run.warnings,
        remark=frames.remark(),
        case=(run.path / "case.toml").read_text(),
        data={"view": frames.data(), "charts": charts(run), "phases": report_summary.phases(run)},
    )
    hidden = path.with_name(f".{path.name}.tmp")
    try:
        hidden.write_text(content, encoding="utf-8")
        hidden.replace(path)
    finally:
        hidden.unlink(missing_ok=True)
    if not options.quiet:
        print(f"{path}: {path.stat().st_size / 1e6:.3g} MB")

"""What Matplotlib draws: curves in panels below each other, residuals on a logarithmic axis, a plane."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from .._command import write_files
from .arrays import Floats

colors = ["#215c99", "#d96b14", "#1a8059", "#6b3385", "#bf2633", "#4d9ecc", "#8c731a", "#66666e"]
most = 1e150  # farther from zero numbers are left out: arithmetic with them might not be finite
width = 12  # [in], 100 px each


@dataclass
class Panel:
    """Curves of one quantity: name, x and y of each."""

    label: str
    unit: str
    curves: list[tuple[str, Floats, Floats]]


def drawable(x: ArrayLike, y: ArrayLike) -> tuple[Floats, ...]:
    """The points that can be drawn; numbers next to nothing are nothing."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    keep = (np.abs(x) <= most) & (np.abs(y) <= most)
    return tuple(np.where(np.abs(values[keep]) < 1 / most, 0, values[keep]) for values in (x, y))


def draw_panels(path: str, title: str, x_label: str, panels: Sequence[Panel]) -> None:
    """A PNG with the panels below each other, over a common axis."""
    figure, axes = _figure(0.9 + 2.2 * len(panels), title, rows=max(1, len(panels)))
    for ax, panel in zip(axes, panels, strict=False):
        ax.set_title(panel.label + (f" [{panel.unit}]" if panel.unit else ""), loc="left", fontsize="medium")
        for k, (name, x, y) in enumerate(panel.curves):
            x, y = drawable(x, y)
            ax.plot(x, y, color=colors[k % len(colors)], label=name, marker="o" if len(x) == 1 else None)
        low, high = ax.get_ylim()
        if 0 < low < high / 2:  # zero belongs to the picture where the values come near it
            ax.set_ylim(0, high)
        if any(name for name, _, _ in panel.curves):
            ax.legend(loc="upper left", bbox_to_anchor=(1, 1), fontsize="small", frameon=False)
    axes[-1].set_xlabel(x_label)
    _save(figure, path)


def draw_residuals(path: str, curves: Sequence[tuple[str, Sequence[float]]], title: str, remark: str) -> None:
    """A PNG of residuals over iterations. curves: text and residuals of each solver."""
    figure, (ax,) = _figure(6 + 0.25 * len(curves), title, remark)
    ax.set_yscale("log")
    ax.set_xlabel("iterations")
    ax.set_title("|r| / |b|", loc="left", fontsize="medium")
    for k, (text, residuals) in enumerate(curves):
        y = np.asarray(residuals, float)
        seen = np.flatnonzero((y > 0) & (y <= most))
        marker = "o" if len(y) < 50 else None  # iterations that stand apart
        ax.plot(seen, y[seen], color=colors[k % len(colors)], label=text, marker=marker, markersize=4)
    longest = max(len(text) for text, _ in curves)
    ax.legend(loc="upper left", bbox_to_anchor=(0, -0.15), fontsize=min(10, 1150 / longest), frameon=False)
    _save(figure, path)


def draw_plane(
    path: str, title: str, remark: str, grid: Sequence[Floats], label: str, least: float | None = None
) -> None:
    """A PNG of values at the points of a rectangle. grid: x, y and values, as rows; not finite where no fluid is.
    least: where the colours begin, if not at the least value."""
    x, y, values = grid
    values = np.ma.masked_where(~(np.abs(values) <= most), values)  # type: ignore[no-untyped-call]  # NumPy has none
    aspect = np.clip(np.ptp(y) / max(np.ptp(x), 1e-300), 0.25, 1)
    figure, (ax,) = _figure(1.5 + 8 * aspect, title, remark)
    if min(values.shape) > 1:
        drawn = ax.pcolormesh(x, y, values, shading="nearest", vmin=least)
    else:
        drawn = ax.scatter(x, y, c=values, vmin=least)
    ax.grid(False)
    ax.set(aspect="equal", xlabel="along [m]", ylabel="up [m]")
    figure.colorbar(drawn, ax=ax, label=label)
    _save(figure, path)


def _figure(height: float, title: str, remark: str = "", rows: int = 1) -> tuple[Figure, Any]:
    figure = Figure(figsize=(width, height), dpi=100, layout="constrained")
    figure.suptitle(title, x=0.02, ha="left", weight="bold", parse_math=False)
    figure.text(0.98, 0.99, remark, ha="right", va="top", parse_math=False)
    axes = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    for ax in axes:
        ax.grid(color="#e6e6e8")
        ax.margins(x=0)
    return figure, axes


def _save(figure: Figure, path: str) -> None:
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    write_files({str(path): picture.getvalue()})

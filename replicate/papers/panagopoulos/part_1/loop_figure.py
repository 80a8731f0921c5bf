"""Rows of Nyquist curve, output and control signal, one row for each plant (Figures 5, 6, 8 and 9)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.loops import Circle, Loop
from replicate.papers.panagopoulos.part_1.drawing import curve, draw_circle, experiment, nyquist_axes, time_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Line:
    """One loop in a row, with its label and line style; one circle for each Ms of a row is drawn."""

    loop: Loop
    ms: float
    label: str
    style: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Row:
    """One plant: its loops, the range of its time axis, of its frequencies and of its Nyquist diagram."""

    title: str
    lines: Sequence[Line]
    until: float
    frequencies: tuple[float, float]
    load_at: float = 0.0  # half time if 0
    load: float = 1.0
    window: tuple[float, float, float, float] = (-2.0, 1.0, -2.0, 1.0)


def draw_rows(fig: Figure, rows: Sequence[Row]) -> None:
    """Draw the rows, and one legend for all."""
    grid = fig.subplots(len(rows), 3, squeeze=False, width_ratios=(1.15, 1.3, 1.3))
    for axes, row in zip(grid, rows, strict=True):
        for ms in sorted({line.ms for line in row.lines}):
            draw_circle(axes[0], Circle.of(ms))
        w = np.geomspace(*row.frequencies, 6000)
        for line in row.lines:
            curve(axes[0], line.loop, w, label=line.label, **line.style)
            experiment(axes[1:], line.loop, row.until, row.load_at or 0.5 * row.until, row.load, **line.style)
        nyquist_axes(axes[0], row.window)
        time_axes(axes[1:], row.until)
        axes[1].tick_params(labelbottom=True)
        axes[1].set_xlabel("time $t$")
        axes[0].set_title(row.title)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    if len(labels) > 1:
        fig.legend(handles, labels, loc="outside lower center", ncols=len(labels))

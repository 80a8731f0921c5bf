"""One panel of Figure 7 for any dead time: curves of constant gain margin and phase crossover frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.papers.krajewski.drawing import draw_locus, label_locus, plane
from replicate.papers.krajewski.loci import (
    constant_gain_ratio,
    constant_phase_crossover,
    largest_a,
    stability_boundary,
    upper_end,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RATIOS = {0.5: "-", 0.7: (0, (1, 1.4))}  # solid and dotted, as in the paper
PHASE_CROSSOVER = 2.0


def gain_chart(axes: Axes, tau: float) -> None:
    """Draw g = 0.5, g = 0.7 and the line ω_B = 2 inside the stability region of one τ."""
    top = upper_end(tau, 0.0)
    plane(axes, (0.0, 1.2 * largest_a(tau, 0.0)), (-1.0 - 0.06 * top, 1.07 * top), f"τ = {tau:g}")
    draw_locus(axes, stability_boundary(tau), "stability boundary", edgecolor="0.5", linewidth=1.0)
    for g, line in RATIOS.items():
        locus = constant_gain_ratio(tau, g)
        draw_locus(axes, locus, f"g = {g:g}", edgecolor="C1", linestyle=line, linewidth=1.7)
        label_locus(axes, locus, 0.9, f"{g:g}", "C1", fontsize=9)
    segment = constant_phase_crossover(tau, PHASE_CROSSOVER)
    if segment is not None:
        draw_locus(axes, segment, "phase crossover 2", edgecolor="C3", linestyle="--", linewidth=1.3)
        (tip,) = segment.curve(np.array([1.0]))[0]
        style: dict[str, Any] = {"color": "C3", "fontsize": 9, "va": "center"}
        offset = (5, 6) if tip[1] > 0.7 * top else (5, -5)
        axes.annotate("$\\omega_B = 2$", tip, xytext=offset, textcoords="offset points", **style)

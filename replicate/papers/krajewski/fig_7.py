"""Figure 7: curves of constant gain margin and of constant phase crossover frequency for ten dead times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, label_locus, plane
from replicate.papers.krajewski.fig_6 import TAUS
from replicate.papers.krajewski.loci import (
    constant_gain_ratio,
    constant_phase_crossover,
    largest_a,
    stability_boundary,
    upper_end,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
        label_locus(axes, locus, 0.9, f"{g:g}", "C1", fontsize=7.5)
    segment = constant_phase_crossover(tau, PHASE_CROSSOVER)
    if segment is not None:
        draw_locus(axes, segment, "phase crossover 2", edgecolor="C3", linestyle="--", linewidth=1.3)
        (tip,) = segment.curve(np.array([1.0]))[0]
        style: dict[str, Any] = {"color": "C3", "fontsize": 8, "va": "center"}
        offset = (5, 6) if tip[1] > 0.7 * top else (5, -5)
        axes.annotate("$\\omega_B = 2$", tip, xytext=offset, textcoords="offset points", **style)


@paper.figure(
    "fig-7",
    "Curves of constant gain margin",
    caption="$g = 0.5$ (solid), $g = 0.7$ (dotted) and the line of phase crossover frequency $\\omega_B = "
    "2$ (dashed) inside the stability region (grey), for $\\tau = 0.1$ to 1. Every curve is the boundary "
    "shrunk towards the origin by $g$: it runs from $(0, -g)$ to $(0, g\\,b_u)$ with $b_u$ the boundary's "
    "upper end.",
    alt="Ten panels, one for each dead time. Two curves of the shape of the stability boundary nested "
    "inside it, and a straight dashed line from the origin to the boundary that is steeper for larger "
    "dead times.",
    size=(7.4, 17.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 7."""
    for axes, tau in zip(fig.subplots(5, 2).flat, TAUS, strict=True):
        gain_chart(axes, tau)

"""Where in the parameter plane a shorter, and where a longer time constant is the worse case. Not in the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.drawing import draw_locus, inside, label_locus, plane
from replicate.papers.krajewski.loci import constant_phase_margin, largest_a, upper_end
from replicate.papers.krajewski.normalised_loop import phase_margin
from replicate.papers.krajewski.points import TAU
from replicate.papers.krajewski.robustness import POINTS, changed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TAUS = (0.2, 0.5, 1.0)
SPREAD = 0.2


def draw_map(axes: Axes, tau: float) -> None:
    """Shade the designs whose phase margin suffers more from the shortest than from the longest time constant."""
    a, b = (0.0, 1.04 * largest_a(tau, 30.0)), (-1.0, 1.05 * upper_end(tau, 30.0))
    plane(axes, a, b, f"τ = {tau:g}")
    x, y = np.meshgrid(np.linspace(1e-6, a[1], 401), np.linspace(*b, 401))
    design = np.array([x, y, np.full_like(x, tau)])
    up = 1.0 + SPREAD
    # phase margin and crossover are closed forms of a, b and τ: no loop has to be computed
    shorter, longer = (changed(design, up, up, T).phase_margin for T in (1.0 - SPREAD, up))
    difference = np.ma.masked_where(phase_margin(x, y, tau) < 30.0, shorter - longer)
    axes.contourf(x, y, difference, levels=[-1e3, 0.0, 1e3], colors=["C1", "C0"], alpha=0.25)
    for margin in (30.0, 45.0, 60.0, 75.0):
        locus = constant_phase_margin(tau, margin)
        draw_locus(axes, locus, f"phase margin {margin:g}", edgecolor="0.45", linewidth=1.0)
        u = inside(locus, a, b, 0.76)
        if u is not None:
            label_locus(axes, locus, u, f"{margin:g}°", "0.45", fontsize=8.5)


@paper.figure(
    "robustness-map",
    "Which time constant is the worst case",
    caption="Not in the paper. $K$ and $L$ at their largest, 20 % above nominal: where the *shortest* $T$ "
    "leaves the smaller phase margin, as the paper expects (upper region, orange), and where the "
    "*longest* does (blue). Designs of less than 30 degrees are left out. Dots at $\\tau = 0.5$: the "
    "paper's own points; those of Figures 9 and 10 are above the border, those of Figures 8, 11 and 12 "
    "below.",
    alt="Three panels of the a-b plane. Each is divided by a border that falls from left to right into an "
    "upper region, where a short time constant is worse, and a lower region, where a long one is.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw the map for three dead times."""
    for axes, tau in zip(fig.subplots(1, 3), TAUS, strict=True):
        draw_map(axes, tau)
        if tau == TAU:
            a, b = np.array(list(POINTS.values())).T
            axes.plot(a, b, "o", color=axes.xaxis.label.get_color(), markersize=3.5, label="points of Figures 8 to 12")

"""Figure 4: arcs of constant gain crossover frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import FREQUENCIES
from replicate.papers.krajewski.drawing import draw_locus, label_locus, plane
from replicate.papers.krajewski.loci import crossover_ellipse

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-4",
    "Arcs of constant crossover frequency",
    caption="The ellipses (16), $\\omega_A = 0.25k$ for $k = 1$ to 8; they do not depend on $\\tau$. Each "
    "meets the dashed line $b = a$ at $a = b = \\omega_A$ (dots); $\\omega_A = 1$ is a circle of radius "
    "$\\sqrt2$.",
    alt="Right halves of eight ellipses centred at the origin, growing with the crossover frequency, and "
    "the line b = a.",
    size=(6.4, 5.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 4."""
    axes = fig.add_subplot()
    plane(axes, (0.0, 4.7), (-2.4, 2.4))
    axes.plot([0.0, 2.4], [0.0, 2.4], color="0.5", linestyle="--", linewidth=1.0, label="b = a")
    axes.plot(FREQUENCIES, FREQUENCIES, "o", color="0.5", markersize=3.2, label="a = b = crossover")
    for w in FREQUENCIES:
        ellipse = crossover_ellipse(w)
        draw_locus(axes, ellipse, f"crossover {w:g}", edgecolor="C2")
        label_locus(axes, ellipse, 0.36, f"{w:g}", "C2")
    axes.set_aspect("equal")

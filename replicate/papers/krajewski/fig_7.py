"""Figure 7: curves of constant gain margin and of constant phase crossover frequency for ten dead times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.gain_chart import gain_chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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

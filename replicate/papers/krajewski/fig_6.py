"""Figure 6: the ten design charts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.design_chart import design_chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-6",
    "Design charts",
    caption="Loci $m_\\varphi = 60$ degrees (solid), $m_\\varphi = 75$ degrees (dashed) and $\\omega_A$ "
    "constant (dotted, labelled with $\\omega_A$) for $\\tau = 0.1$ to 1; grey: the stability boundary. A point "
    "on a dotted arc, left of a curve of phase margin, has that crossover frequency and more than that phase "
    "margin. The values of $\\omega_A$ are not printed in the paper. The curves are cubic splines with exact "
    "points and tangents: enlarge the page as far as you like.",
    alt="Ten panels, one for each dead time. Each shows two nested curves of phase margin from the lower "
    "to the upper b axis, and elliptic arcs of crossover frequency across them.",
    size=(7.4, 17.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 6."""
    for axes, tau in zip(fig.subplots(5, 2).flat, TAUS, strict=True):
        design_chart(axes, tau)

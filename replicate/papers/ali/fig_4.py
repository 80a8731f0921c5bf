"""Figure 4: control signals of Example 1, load."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.responses import draw_load_controls

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-4",
    "Control signals for the load step, Example 1",
    caption="Unit step of a load at the plant input; structures as in Figure 1. A load step makes no kick; "
    "the control signal ends at $-1$, where it cancels the load.",
    alt="Two panels of control signals over 30 time units. The proposed signal dips to about minus 3.3 and "
    "returns smoothly to minus 1; Padma Sree's dips deeper and oscillates to the end.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 4."""
    draw_load_controls(fig, padma_sree("load"), limits=(-4.2, 1.8))

"""Figure 1: set-point responses of Example 1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.responses import draw_outputs

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-1",
    "Set-point responses, Example 1",
    caption="Unit step of the set point, exact dead time. Proposed controller in the form (2); Padma Sree's "
    "in the form (2) on the left and in the parallel form on the right. In both it rings for far longer than "
    "the time shown; contrary to the text, its overshoot is the larger one.",
    alt="Two panels of set-point responses over 30 time units. The proposed response peaks above 3 and "
    "settles in about 11; Padma Sree's peaks higher still and oscillates around the set point to the end.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 1."""
    draw_outputs(fig, padma_sree("setpoint"), limits=(-0.3, 4.4))

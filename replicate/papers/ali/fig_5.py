"""Figure 5: set-point responses of Example 2."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.responses import draw_outputs

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-5",
    "Set-point responses, Example 2",
    caption="Unit step of the set point, exact dead time. Proposed controller in the form (2); Visioli's "
    "set-point setting in the form (2) on the left and in the parallel form on the right. Which of the two "
    "settles first depends on that choice.",
    alt="Two panels of set-point responses. Visioli's response rises first, overshoots by more than 100 per "
    "cent and oscillates; the proposed one overshoots by about 54 per cent without oscillation.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 5."""
    draw_outputs(fig, visioli("setpoint", 6.0), limits=(-0.2, 2.7))

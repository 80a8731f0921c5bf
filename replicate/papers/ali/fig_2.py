"""Figure 2: load disturbance responses of Example 1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.responses import draw_outputs

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-2",
    "Load responses, Example 1",
    caption="Unit step of a load at the plant input, exact dead time; structures as in Figure 1. The "
    "proposed controller has the larger peak and settles; Padma Sree's keeps oscillating.",
    alt="Two panels of load responses over 30 time units. The proposed response peaks at about 1.8 and "
    "returns to zero without oscillation; Padma Sree's peaks lower and oscillates to the end.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 2."""
    draw_outputs(fig, padma_sree("load"), limits=(-0.4, 2.1))

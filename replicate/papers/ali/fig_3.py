"""Figure 3: control signals of Example 1, set point."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import padma_sree
from replicate.papers.ali.responses import draw_setpoint_controls

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-3",
    "Control signals for the set-point step, Example 1",
    caption="Unit step of the set point; structures as in Figure 1. The derivative of the step makes the "
    "control signal start at ten $K_p$ in the form (2), at eleven in the parallel form: narrow panels on "
    "the left. The wide panels are cut off and show the rest.",
    alt="Four panels. On the left the initial kick of the control signals, decaying within a tenth of a time "
    "unit; on the right the control signals over 30 time units, where Padma Sree's oscillates to the end and "
    "the proposed one does not.",
    size=(7.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 3."""
    draw_setpoint_controls(fig, padma_sree("setpoint"), limits=(-9.5, 9.0), kick_until=0.15, kick_top=24.0)

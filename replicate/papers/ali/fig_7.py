"""Figure 7: control signals of Example 2, set point."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.responses import draw_setpoint_controls

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-7",
    "Control signals for the set-point step, Example 2",
    caption="Unit step of the set point; Visioli's set-point setting, structures as in Figure 5. Narrow "
    "panels: the initial kick of ten $K_p$ in the form (2), eleven in the parallel form. The wide panels "
    "are cut off and show the rest.",
    alt="Four panels. On the left the initial kick of the control signals; on the right the control signals "
    "over 6 time units, where Visioli's oscillates with a large amplitude before it settles.",
    size=(7.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 7."""
    draw_setpoint_controls(fig, visioli("setpoint", 6.0), limits=(-16.0, 24.0), kick_until=0.045, kick_top=76.0)

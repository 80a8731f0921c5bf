"""Figure 8: control signals of Example 2, load."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.ali import paper
from replicate.papers.ali.comparisons import visioli
from replicate.papers.ali.responses import draw_load_controls

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-8",
    "Control signals for the load step, Example 2",
    caption="Unit step of a load at the plant input; Visioli's load setting, structures as in Figure 6.",
    alt="Two panels of control signals. Left, Visioli's grows without bound; right, it oscillates several "
    "times before it reaches minus 1, while the proposed signal gets there after one undershoot.",
    size=(7.4, 3.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 8."""
    draw_load_controls(fig, visioli("load", 6.0), limits=(-6.0, 5.4))

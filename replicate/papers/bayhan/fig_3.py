"""Figure 3: unit step responses for Example 4.2."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_42
from replicate.papers.bayhan.responses import compare_rules
from replicate.papers.bayhan.table_3 import ROWS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-3",
    "Unit step responses for Example 4.2",
    caption="The six rules of Table 3 with the exact dead time: left with the integral gain that equation "
    "(3) asks for, right with the one that the tables were computed with. With a dead time of five time "
    "constants the choice decides between sluggish and oscillatory.",
    alt="Two panels of six unit step responses over time. Left, with the gains of equation (3), the "
    "competing rules creep to the set point; right, with integral gain one over integral time, three of "
    "them oscillate strongly. PA reaches the set point quickly and without overshoot in both.",
    size=(7.4, 3.8),
)
def draw(fig: Figure) -> None:
    """Draw Figure 3."""
    compare_rules(fig, EXAMPLE_42, ROWS, until=8.0, top=1.8)

"""Figure 2: unit step responses for Example 4.1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import EXAMPLE_41, RULES
from replicate.papers.bayhan.responses import compare_rules

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-2",
    "Unit step responses for Example 4.1",
    caption="The eleven rules of Table 2 with the exact dead time: left with the integral gain that "
    "equation (3) asks for, right with the one that the tables were computed with. The pole assignment "
    "(PA) is the same in both. The grey band is the 2 % settling band.",
    alt="Two panels of eleven unit step responses over time. In the left panel the three set-point rules "
    "barely overshoot; in the right one every rule but PA and ZN overshoots clearly. PA rises slowly and "
    "does not overshoot in either.",
    size=(7.4, 4.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 2."""
    compare_rules(fig, EXAMPLE_41, RULES, until=16.0, top=1.6)

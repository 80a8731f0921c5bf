"""Figure 5: step responses of the PT326 model under several rules."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import PT326, RULES
from replicate.papers.bayhan.responses import compare_rules

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@paper.figure(
    "fig-5",
    "Step responses of the PT326 set for different rules",
    caption="All eleven rules on the identified model $G(s) = 0.875\\,e^{-0.43s}/(0.62s+1)$, exact dead "
    "time, with $a = 1.3$ and $\\tau_{cl} = 0.3$. The paper does not say which of the two integral "
    "gains the experiments used.",
    alt="Two panels of eleven unit step responses over time, left with the gains of equation (3), right "
    "with integral gain one over integral time. PA rises to the set point without overshoot; IMC and "
    "ITAESPC overshoot once and settle at about the same time; the others ring or creep.",
    size=(7.4, 4.0),
    stands_for="The paper shows measurements on the PT326 set and does not list the rules it compares. "
    "What is drawn is the identified model under all rules of Table 1.",
)
def draw(fig: Figure) -> None:
    """Draw Figure 5."""
    compare_rules(fig, PT326, RULES, until=8.0, top=1.6)

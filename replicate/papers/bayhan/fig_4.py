"""Figure 4: step responses of the PT326 model for several values of a."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.processes import PT326
from replicate.papers.bayhan.responses import draw_step, step_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The paper names only 1.3; the others show both sides of it.
VALUES = (0.5, 0.7, 1.0, 1.3, 1.8, 2.0)
UNTIL = 8.0


@paper.figure(
    "fig-4",
    "Step responses of the PT326 set for different $a$",
    caption="Pole assignment on the identified model $G(s) = 0.875\\,e^{-0.43s}/(0.62s+1)$, exact dead "
    "time, for several values of the free parameter, among them the paper's choice $a = 1.3$. Beyond it "
    "(dashed) the response becomes slower again.",
    alt="Six unit step responses over time. The response gets faster as a grows to 1.3 and slower again "
    "beyond; none overshoots visibly.",
    size=(6.4, 3.8),
    stands_for="The paper shows measurements on the PT326 set, and of the values of $a$ its text names "
    "only 1.3. What is drawn is the identified model, with values of $a$ chosen here.",
)
def draw(fig: Figure) -> None:
    """Draw Figure 4."""
    axes = fig.subplots()
    step_axes(axes, UNTIL)
    for a in VALUES:
        style = {"linewidth": 2.6, "color": axes.xaxis.label.get_color()} if a == PT326.a else {"linewidth": 1.4}
        line = "-" if a <= PT326.a else "--"
        draw_step(axes, PT326, PT326.pole_assignment(a), UNTIL, label=f"$a = {a}$", linestyle=line, **style)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("output $y(t)$")
    axes.legend(loc="lower right")

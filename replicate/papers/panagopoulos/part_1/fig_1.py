"""Figure 1: Ms and Mp as design parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI, Circle, Loop, design_pi
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.drawing import curve, draw_circle, experiment, nyquist_axes, time_axes
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BOUNDS = (1.2, 1.4, 2.0)
PLANT = "G1"
UNTIL, LOAD_AT = 40.0, 20.0


@paper.figure(
    "I-fig-1",
    "$M_s$ (left) and $M_p$ (right) as design parameters",
    caption="Nyquist curves with their circles, then output and control signal for a set-point step at 0 and "
    "a load step. The paper does not name its plant; here it is $G_1 = 1/(s+1)^3$, with $b = 1$.",
    alt="Two columns. Left, designs for maximum sensitivities 1.2, 1.4 and 2: the responses range from sluggish to "
    "oscillatory. Right, designs for resonance peaks 1.2, 1.4 and 2: the three pairs of curves differ less.",
    size=(7.2, 7.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 1."""
    grid = fig.subplots(3, 2, sharey="row", height_ratios=(1.55, 1.0, 1.0))
    w = np.geomspace(0.02, 50.0, 1500)
    for column, symbol in enumerate(("s", "p")):
        for number, bound in enumerate(BOUNDS):
            found = design_pi(PLANTS[PLANT], **{f"m{symbol}": bound})
            loop = Loop(PLANTS[PLANT], PI(found.k, found.ki))
            color = f"C{number}"
            curve(grid[0, column], loop, w, color=color, label=f"$M_{symbol} = {bound}$")
            draw_circle(grid[0, column], Circle.of(**{f"m{symbol}": bound}), color=color, linewidth=0.9, linestyle=":")
            experiment(grid[1:, column], loop, UNTIL, LOAD_AT, color=color)
        nyquist_axes(grid[0, column], (-3.0, 1.0, -2.0, 1.0))
        grid[0, column].legend(loc="lower left")
        time_axes(grid[1:, column], UNTIL)

"""Figure 3: Nyquist curves of G1 to G6."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import Circle
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import SIX, loop
from replicate.papers.panagopoulos.part_1.drawing import curve, draw_circle, nyquist_axes
from replicate.papers.panagopoulos.part_1.plants import label

if TYPE_CHECKING:
    from matplotlib.figure import Figure


# G3 and G5 lie over each other, G1 and G6 have similar colours
LINES = {"G5": (0, (4.0, 3.0)), "G6": (0, (6.0, 2.0, 1.5, 2.0))}


@paper.figure(
    "I-fig-3",
    "Nyquist curves of the loops with $G_1$ to $G_6$",
    caption="Designs for $M_s = 1.4$ (left; above in the paper) and 2 (right). Every curve touches the circle "
    "of its $M_s$ and stays outside it.",
    alt="Two Nyquist diagrams with six curves each. In both all curves come up from below and touch a circle "
    "around minus one, which is larger on the left, from the right and below.",
    size=(7.4, 3.9),
)
def draw(fig: Figure) -> None:
    """Draw Figure 3."""
    both = fig.subplots(1, 2)
    w = np.geomspace(1e-3, 300.0, 6000)
    for axes, ms in zip(both, (1.4, 2.0), strict=True):
        draw_circle(axes, Circle.of(ms))
        for plant in SIX:
            curve(axes, loop(plant, ms), w, label=label(plant), linestyle=LINES.get(plant, "-"))
        nyquist_axes(axes)
        axes.set_title(f"$M_s = {ms}$")
    handles, labels = both[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=6)

"""Figure 9: the unstable plant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import controller
from replicate.papers.panagopoulos.part_1.example_7 import MS, PARAMETERS
from replicate.papers.panagopoulos.part_1.loop_figure import Line, Row, draw_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNTIL = {4: 30.0, 8: 8.0}


@paper.figure(
    "I-fig-9",
    "The unstable plant $G_{14}$, $M_s = 2$",
    caption="Nyquist curve, output and control signal for $a = 4$ and $a = 8$; the load comes at half time. "
    "With one unstable pole the Nyquist curve has to go once around the point $-1$, and it touches the circle "
    "from below.",
    alt="Two rows of a Nyquist diagram, an output and a control signal. The Nyquist curves come from the far "
    "left, pass below the circle around minus one and end in the origin. The outputs settle with an "
    "overshoot.",
    size=(7.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 9."""
    rows = []
    for a in PARAMETERS:
        plant = f"G14 a={a}"
        loop = Loop(PLANTS[plant], controller(plant, MS, "w_0"))
        rows.append(Row(f"$a = {a}$", [Line(loop, MS, "")], UNTIL[a], (0.02, 400.0), window=(-3.5, 1.0, -2.25, 2.25)))
    draw_rows(fig, rows)

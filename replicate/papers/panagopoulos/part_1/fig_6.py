"""Figure 6: the oscillatory plant, as the errata correct it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import PI, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.loop_figure import Line, Row, draw_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MS = 2.0
UNTIL = 40.0


@paper.figure(
    "I-fig-6",
    "The oscillatory plant $G_{12}$, $M_s = 2$ (corrected by the errata)",
    caption="Nyquist curves, which touch the circle twice, and responses for $a = 0.2$, 0.5 and 1 with $b = "
    "0$; the load comes at half time. The time responses of the article are wrong, says the errata; these are "
    "the ones that belong to Table 3.",
    alt="A Nyquist diagram with three curves that touch the circle around minus one at two points each, and "
    "three outputs and control signals. The less damping the plant has, the longer a ripple remains after the "
    "load step.",
    size=(7.4, 3.0),
)
def draw(fig: Figure) -> None:
    """Draw Figure 6."""
    lines = []
    for a in (0.2, 0.5, 1.0):
        plant = f"G12 a={a}"
        found = design(plant, MS)
        lines.append(Line(Loop(PLANTS[plant], PI(found.k, found.ki, 0.0)), MS, f"$a = {a}$"))
    draw_rows(fig, [Row("", lines, UNTIL, (0.02, 60.0), window=(-2.0, 1.5, -1.5, 2.0))])

"""Figure 8: the two solutions for the conditionally stable plant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import controller
from replicate.papers.panagopoulos.part_1.example_6 import PLANT, SOLUTIONS
from replicate.papers.panagopoulos.part_1.loop_figure import Line, Row, draw_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# title, end of the time axis, lowest and highest frequency, load: a unit load would not be seen in the second
ROWS = {
    "slow": ("low gain", 120.0, (0.02, 200.0), 1.0),
    "fast": ("high gain", 8.0, (0.5, 5000.0), 500.0),
}


@paper.figure(
    "I-fig-8",
    "Two solutions for the conditionally stable plant $G_{13}$, $M_s = 2$",
    caption="Nyquist curve, output and control signal for the two solutions of example 6; the load comes at "
    "half time. Mind the scales: the second time axis is much shorter, its control signal starts in the hundreds, and "
    f"its load step is {ROWS['fast'][3]:g} times as large, since a unit load would not be seen.",
    alt="Two rows of a Nyquist diagram, an output and a control signal. The Nyquist curves near minus one "
    "look alike, but the second loop settles within a few seconds, the first within a minute.",
    size=(7.4, 5.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 8."""
    rows = []
    for name, (title, until, frequencies, load) in ROWS.items():
        ms, place = SOLUTIONS[name]
        loop = Loop(PLANTS[PLANT], controller(PLANT, ms, "w_0", place))
        rows.append(Row(title, [Line(loop, ms, "")], until, frequencies, load=load))
    draw_rows(fig, rows)

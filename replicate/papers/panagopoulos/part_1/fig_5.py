"""Figure 5: the more complex plants."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import controller
from replicate.papers.panagopoulos.part_1.drawing import STYLES
from replicate.papers.panagopoulos.part_1.loop_figure import Line, Row, draw_rows
from replicate.papers.panagopoulos.part_1.plants import PLANTS, label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# not in the text: end of the time axis, lowest and highest frequency
RANGES = {
    "G7": (40.0, (0.05, 25.0)),
    "G8": (100.0, (0.01, 25.0)),
    "G10": (20.0, (0.01, 300.0)),
    "G11": (20.0, (0.01, 300.0)),
}


@paper.figure(
    "I-fig-5",
    "Nyquist curves and responses for $G_7$, $G_8$, $G_{10}$ and $G_{11}$",
    caption="Designs for $M_s = 1.4$ (dashed) and 2 (full): Nyquist curve with the two circles, output, "
    "control signal; the load comes at half time. The paper's caption says $G_2$ where it means $G_7$.",
    alt="Four rows of a Nyquist diagram, an output and a control signal. The output of the pure dead time is "
    "made of jumps; the rows of the plants with and without slow mode look the same but for slow changes of "
    "the control signal.",
    size=(7.4, 9.4),
)
def draw(fig: Figure) -> None:
    """Draw Figure 5."""
    rows = []
    for plant, (until, frequencies) in RANGES.items():
        lines = [
            Line(
                Loop(PLANTS[plant], controller(plant, ms, "w_0")),
                ms,
                f"$M_s = {ms}$",
                {"color": "C0" if ms > 1.5 else "C1", "linestyle": STYLES[ms]},
            )
            for ms in (1.4, 2.0)
        ]
        rows.append(Row(label(plant), lines, until, frequencies))
    draw_rows(fig, rows)

"""Figure 7: the oscillatory plant without any damping."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import PI, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.drawing import experiment, time_axes
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PLANT, MS = "G12 a=0.0", 1.4
UNTIL, LOAD_AT = 120.0, 50.0


@paper.figure(
    "I-fig-7",
    "The undamped plant, $a = 0$, $M_s = 1.4$",
    caption="Output and control signal for a set-point step and a load step, $b = 0$. The set point barely excites the "
    "oscillatory mode, but the load does, and PI control can damp it only slowly.",
    alt="The output rises smoothly to the set point with a faint ripple; after the load step it oscillates "
    "with a large, slowly decaying amplitude.",
    size=(6.6, 4.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 7."""
    pair = list(fig.subplots(2, 1, height_ratios=(1.5, 1.0)))
    found = design(PLANT, MS)
    experiment(pair, Loop(PLANTS[PLANT], PI(found.k, found.ki, 0.0)), UNTIL, LOAD_AT)
    time_axes(pair, UNTIL)

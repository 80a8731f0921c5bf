"""Figure 4: set-point and load responses of G1 to G6."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import SIX, controller
from replicate.papers.panagopoulos.part_1.drawing import STYLES, experiment, time_axes
from replicate.papers.panagopoulos.part_1.plants import PLANTS, label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The text gives neither horizons nor loads: the load comes at half time; G4 would answer a unit load with a peak of 5.
UNTIL = {"G1": 40.0, "G2": 10.0, "G3": 400.0, "G4": 200.0, "G5": 80.0, "G6": 20.0}
LOAD = {"G4": 0.2}


@paper.figure(
    "I-fig-4",
    "Set-point and load responses of $G_1$ to $G_6$",
    caption="Output above control signal, for $M_s = 1.4$ (dashed) and 2 (full), $b$ as the paper's numbers "
    "have it; unit steps, the load at half time (0.2 for $G_4$).",
    alt="Six pairs of panels. For every plant the set-point response rises without or with little overshoot "
    "and the load is rejected; the responses for maximum sensitivity 2 are faster and oscillate more than the "
    "dashed ones for 1.4.",
    size=(7.4, 9.2),
)
def draw(fig: Figure) -> None:
    """Draw Figure 4."""
    grid = fig.subplots(6, 2, height_ratios=(1.5, 1.0) * 3)
    for number, plant in enumerate(SIX):
        row, column = 2 * (number // 2), number % 2
        pair = [grid[row, column], grid[row + 1, column]]
        until = UNTIL[plant]
        for ms in (1.4, 2.0):
            loop = Loop(PLANTS[plant], controller(plant, ms, "w_0"))
            experiment(
                pair,
                loop,
                until,
                0.5 * until,
                LOAD.get(plant, 1.0),
                color="C0" if ms > 1.5 else "C1",
                linestyle=STYLES[ms],
                label=f"$M_s = {ms}$",
            )
        time_axes(pair, until)
        pair[0].set_title(label(plant), loc="left")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=2)

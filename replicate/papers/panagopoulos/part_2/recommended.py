"""What to use: for each process the best PID controller under the stated constraints and under Ms alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PID, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import optimal, pi_controller, printed
from replicate.papers.panagopoulos.part_2.load_experiment import load_experiment
from replicate.papers.panagopoulos.part_2.processes import LEVELS, NEAR_INTEGRATING, PLANTS, ROW_LABELS, ROWS, split
from replicate.papers.panagopoulos.part_2.tables import REPLACEMENT

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

COLUMNS = ("k", "Ti", "Td", "IE", "IAE", "undershoot")

table = paper.table(
    "II-recommended",
    "What to use",
    printed=False,
    rows=ROWS,
    columns=COLUMNS,
    caption="The controllers with the largest $k_i$: gains, integrated and integrated absolute error after a unit load "
    "step, and how far the response swings to the other side, as a fraction of its peak.",
    labels=ROW_LABELS
    | {
        "k": "$k$",
        "Ti": "$T_i$",
        "Td": "$T_d$",
        "undershoot": "swing back",
    },
)
table.computed_trial = lambda row, numbers: (
    PLANTS[split(row)[0]].notation(),
    PID(numbers["k"], numbers["k"] / numbers["Ti"], numbers["k"] * numbers["Td"]).notation(),
)


@cache
def load_numbers(row: str, controller: PID) -> dict[str, float]:
    """Return one row of the table for any controller."""
    load = load_experiment(split(row)[0], controller).output
    return {
        "k": controller.k,
        "Ti": controller.integral_time,
        "Td": controller.derivative_time,
        "IE": 1.0 / controller.ki,
        "IAE": load.iae(),
        "undershoot": max(0.0, -float(load.trough()) / float(load.peak())),
    }


def _reading(of: Callable[[str], PID]) -> Callable[[], pd.DataFrame]:
    def compute() -> pd.DataFrame:
        return table.frame({row: load_numbers(row, of(row)) for row in ROWS})

    return compute


table.reading(
    "as-written",
    "Best PID under the stated constraints",
    r"Circle, curvature and phase; without curvature for $G_1$ and $G_3$, as the text says.",
)(_reading(optimal))
table.reading("ms-only", "Best PID under $M_s$ alone")(_reading(lambda row: optimal(row, "ms-only")))
table.reading("printed-gains", "The errata's controllers")(_reading(lambda row: printed(REPLACEMENT, row)))
table.reading("pi", "Best PI under $M_s$ (paper I)")(_reading(pi_controller))

HORIZONS = {"G1": 60.0, "G2": 50.0, "G3": 1.2, "G4": 25.0, "G5": 30.0, "G6": 40.0, "G7": 45.0, "G8": 35.0}
# the errata's controllers are drawn where they are not the optimum
STYLES = (
    ("PID, stated constraints", "C0", "-", optimal, tuple(PLANTS)),
    ("PID, $M_s$ alone", "C1", "-", lambda row: optimal(row, "ms-only"), tuple(PLANTS)),
    ("PID of the errata ($G_1$, $G_3$)", "C2", "-", lambda row: printed(REPLACEMENT, row), NEAR_INTEGRATING),
    ("PI", "C6", "--", pi_controller, tuple(PLANTS)),
)


@paper.figure(
    "II-recommended-responses",
    "The recommended controllers at work",
    caption="Responses to a unit load step: the best PID under the stated constraints, the best under $M_s$ "
    "alone and the best PI. Under $M_s$ alone the deviation is smaller but oscillates; the constraints on the shape "
    "improve the damping. For $G_1$ and $G_3$ the stated constraints cost most of what derivative action gains; the "
    "controllers that the errata print are in between. The scales follow the PID controllers: a PI response may leave "
    "the panel.",
    alt="Sixteen panels, eight processes in rows and the two values of Ms in columns, each with three load responses, "
    "those of the first and third process with a fourth. The PID responses have lower peaks than the PI response and "
    "return sooner, except for the first process; the one under Ms alone swings below zero, the one under the stated "
    "constraints less.",
    size=(7.4, 13.0),
)
def responses(fig: Figure) -> None:
    """Draw the load responses of the three designs for every process."""
    panels = fig.subplots(len(PLANTS), len(LEVELS))
    for row, axes in zip(ROWS, panels.flat, strict=True):
        name, ms = split(row)
        until = HORIZONS[name]
        t = np.linspace(0.0, until, 401)
        highest = lowest = 0.0
        for label, color, line, of, where in STYLES:
            if name not in where:
                continue
            y = Loop(PLANTS[name], of(row)).load_step(until=until)(t)
            axes.plot(t, y, color=color, linestyle=line, label=label, linewidth=1.4)
            if line == "-":
                highest, lowest = max(highest, float(y.max())), min(lowest, float(y.min()))
        axes.set_ylim(1.15 * lowest - 0.05 * highest, 1.15 * highest)
        axes.set_xlim(0.0, until)
        axes.set_title(f"$G_{name[1]}$, $M_s = {ms}$", fontsize=10)
        if axes in panels[:, 0]:
            axes.set_ylabel("$y(t)$")
    for axes in panels[-1]:
        axes.set_xlabel("time $t$")
    fig.align_ylabels(panels[:, 0])
    handles, labels = panels[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside upper center", ncols=4)

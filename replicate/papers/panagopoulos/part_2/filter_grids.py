"""Which grids of frequencies were tried for the set-point filters of Table 1, and how many of them each meets."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.matching import match
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.load_experiment import loop_of
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number, printed_pid
from replicate.papers.panagopoulos.part_2.processes import ROWS, split
from replicate.papers.panagopoulos.part_2.setpoint import GRIDS_TRIED, Resonance, filter_corrected
from replicate.papers.panagopoulos.part_2.tables import SUPERSEDED

if TYPE_CHECKING:
    import pandas as pd

GRIDS = {
    f"{points} points, {first} to {last}": np.logspace(first, last, points)
    for points, first, last in product(*GRIDS_TRIED.values())
}

grids = paper.table(
    "II-filter-grids",
    "Grids tried for the set-point filters",
    printed=False,
    rows=tuple(GRIDS),
    columns=("equal", "near", "of"),
    caption="How many of the non-zero $T_{sp}$ of Table 1 follow from the printed gains, by (16) over $\\omega_{mp}$, "
    "with the peak of $|T|$ read off a logarithmic grid between two decades (exponents of ten, rad/s): to the last "
    "printed digit, and within two units of it or 1 %.",
    labels={"equal": "to the last digit", "near": "or near", "of": "of"},
)


@grids.reading("as-written", "Printed values met")
def counts() -> pd.DataFrame:
    """Count the values that every grid meets."""
    printed = paper.printed_cells(SUPERSEDED)
    rows = [row for row in ROWS if printed_number(SUPERSEDED, row, "Tsp") > 0.0]
    found = {}
    for name, frequencies in GRIDS.items():
        kinds = []
        for row in rows:
            controller = printed_pid(SUPERSEDED, row)
            peak = Resonance.on_grid(loop_of(split(row)[0], controller), frequencies)
            kinds.append(match(printed[row, "Tsp"], filter_corrected(controller, peak)).kind)
        found[name] = (kinds.count("equal"), kinds.count("equal") + kinds.count("near"), len(rows))
    return grids.frame(found)

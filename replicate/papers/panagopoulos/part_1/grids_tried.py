"""Which grids of frequencies were tried for w0 of Table 1, and how many of its values each meets."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.matching import meets
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import BOUNDS, SIX, loop
from replicate.papers.panagopoulos.part_1.frequency_grid import DECADES_TRIED, FIRST_TRIED, POINTS_TRIED

if TYPE_CHECKING:
    import pandas as pd

GRIDS = {
    f"{points} points, {decades} decades": (points, decades) for points, decades in product(POINTS_TRIED, DECADES_TRIED)
}

grids = paper.table(
    "I-grids",
    "Grids tried for $\\omega_0$ of Table 1",
    printed=False,
    rows=tuple(GRIDS),
    columns=(*SIX, "all"),
    caption="How many of the four printed $\\omega_0$ of each plant are the point of a logarithmic grid at which $|S|$ "
    f"is largest, for the best of the first decades $10^{{{FIRST_TRIED[0]}}}$ to $10^{{{FIRST_TRIED[-1]}}}$.",
    labels={"all": "all"},
)


@grids.reading("as-written", "Printed values met")
def counts() -> pd.DataFrame:
    """Count the values that every grid meets."""
    printed = paper.printed_cells("I-table-1")
    found = {}
    for name, (points, decades) in GRIDS.items():
        best = dict.fromkeys(SIX, 0)
        for plant, first in product(SIX, FIRST_TRIED):
            w = np.logspace(first, first + decades, points)
            met = 0
            for ms in BOUNDS:
                peak = float(w[np.argmin(np.abs(1.0 + loop(plant, ms)(1j * w)))])
                met += meets(printed[f"{plant} Ms={ms}", "w0"], peak)
            best[plant] = max(best[plant], met)
        found[name] = {**best, "all": sum(best.values())}
    return grids.frame(found)

"""What the printed digits leave open: columns that follow from the gains, and a sensitivity with two equal peaks.

The gains are printed with two or three digits. A number that follows from them is only known to lie between its values
over all gains that round to the printed ones; some of the formulas are much more sensitive than others.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PID, Loop, Plant
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_2.designs import printed
from replicate.papers.panagopoulos.part_2.printed_gains import printed_number
from replicate.papers.panagopoulos.part_2.processes import LEVELS, PLANTS, ROW_LABELS, split
from replicate.papers.panagopoulos.part_2.properties import LABELS
from replicate.papers.panagopoulos.part_2.setpoint import Resonance, filter_corrected, weight
from replicate.papers.panagopoulos.part_2.tables import GAINS, REPLACEMENT, SUPERSEDED

if TYPE_CHECKING:
    import pandas as pd

    from replicate.exhibits import Table

QUANTITIES: dict[str, Callable[[Plant, PID], float]] = {
    "IE": lambda _, c: 1.0 / c.ki,
    "IE/IAE": lambda plant, c: 1.0 / (c.ki * Loop(plant, c).load_step().iae()),
    "b": lambda plant, c: weight(c, Resonance.of(plant, c)),
    "Tsp": lambda plant, c: filter_corrected(c, Resonance.on_default_grid(plant, c)),
    "w0": lambda plant, c: Loop(plant, c).sensitivity_peak().frequency,
    "Mp": lambda plant, c: Resonance.of(plant, c).value,
    "Ms": lambda plant, c: Loop(plant, c).sensitivity_peak().value,
}

# the printed values that do not come out of the printed gains, and the sensitivity that they are for G3
OPEN = {
    SUPERSEDED: {
        "IE": ("G1 Ms=2.0", "G2 Ms=2.0", "G4 Ms=1.4", "G5 Ms=2.0", "G6 Ms=2.0"),
        "b": ("G3 Ms=1.4", "G8 Ms=1.4"),
        "Tsp": ("G2 Ms=2.0", "G4 Ms=1.4", "G4 Ms=2.0", "G5 Ms=1.4", "G6 Ms=1.4", "G6 Ms=2.0", "G8 Ms=2.0"),
        "w0": ("G3 Ms=1.4",),
        "Mp": ("G2 Ms=2.0", "G3 Ms=1.4", "G4 Ms=2.0"),
        "Ms": ("G3 Ms=1.4",),
    },
    REPLACEMENT: {
        "IE": ("G1 Ms=1.4", "G8 Ms=1.4"),
        "IE/IAE": ("G1 Ms=2.0", "G3 Ms=2.0", "G4 Ms=1.4", "G4 Ms=2.0"),
        "b": ("G3 Ms=2.0",),
        "w0": ("G3 Ms=1.4", "G3 Ms=2.0"),
        "Mp": ("G3 Ms=1.4", "G3 Ms=2.0", "G7 Ms=2.0"),
        "Ms": tuple(f"G3 Ms={ms}" for ms in LEVELS),
    },
}


def gains_that_round(table: str, row: str) -> list[PID]:
    """Return the controllers in the middle, at the corners and on the edges of what rounds to the printed gains."""
    cells = paper.printed_cells(table)
    steps = []
    for column in GAINS:
        text = cells[row, column]
        half = 0.5 * 10.0 ** -len(text.partition(".")[2])
        steps.append([float(text) + side * half for side in (-1.0, 0.0, 1.0)])
    return [PID.ideal(*gains) for gains in product(*steps)]


def left_open_by(id: str, printed_in: str, name: str) -> Table:
    """Add the table of the columns that the gains printed in a table leave open."""
    labels = LABELS | {"Ms": "$M_s$"}
    cells = {f"{row} {quantity}": (row, quantity) for quantity, where in OPEN[printed_in].items() for row in where}
    table = paper.table(
        id,
        f"What the digits of the gains in {name} leave open",
        printed=False,
        rows=tuple(cells),
        columns=("low", "printed", "high"),
        caption="The print, and the smallest and largest value over all $k$, $T_i$ and $T_d$ that round to the "
        "printed ones, for columns that the printed gains do not give to the last digit. The print is rounded too: it "
        "may stand outside by half a unit. $T_{sp}$ is (16) over $\\omega_{mp}$ on Matlab's default grid.",
        labels={"low": "from", "printed": "printed", "high": "to"}
        | {key: f"{labels[quantity]}, {ROW_LABELS[row]}" for key, (row, quantity) in cells.items()},
    )

    @table.reading("as-written", "From the printed gains")
    def left_open() -> pd.DataFrame:
        rows = {}
        for key, (row, quantity) in cells.items():
            process, ms = split(row)
            values = [QUANTITIES[quantity](PLANTS[process], c) for c in gains_that_round(printed_in, row)]
            text = ms if quantity == "Ms" else printed_number(printed_in, row, quantity)
            rows[key] = {"low": min(values), "printed": text, "high": max(values)}
        return table.frame(rows)

    return table


by_table_1 = left_open_by("II-rounding", SUPERSEDED, "Table 1")
by_errata = left_open_by("IIs-rounding", REPLACEMENT, "the errata")


TWO_PEAKS = "G8 Ms=1.4"
peaks = paper.table(
    "II-two-peaks",
    "Two equal peaks of the sensitivity",
    printed=False,
    rows=("first", "second"),
    columns=("w", "S"),
    caption="$G_8$, $M_s = 1.4$, the printed gains of Table 1: the two highest local maxima of $|S|$.",
    labels={"w": r"$\omega$", "S": "$|S|$"},
)


@peaks.reading("as-written", "From the printed gains")
def two_peaks() -> pd.DataFrame:
    """Return the local maxima of the sensitivity."""
    loop = Loop(PLANTS[split(TWO_PEAKS)[0]], printed(SUPERSEDED, TWO_PEAKS))
    w = np.geomspace(0.1, 5.0, 40001)
    size = np.abs(1.0 / (1.0 + loop(1j * w)))
    at = np.nonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:]))[0] + 1
    at = np.sort(at[np.argsort(-size[at])][:2])
    return peaks.frame({row: (float(w[i]), float(size[i])) for row, i in zip(peaks.rows, at, strict=True)})

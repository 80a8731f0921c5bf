"""Table 3: example 5, the oscillatory plant with less and less damping."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.labels import COLUMNS
from replicate.papers.panagopoulos.part_1.printed_gains import trials

if TYPE_CHECKING:
    import pandas as pd

ROWS = tuple(f"a={a}" for a in (0.0, 0.1, 0.2, 0.5, 1.0, 2.0))

table_3 = paper.table(
    "I-table-3",
    "Controllers for the oscillatory plant $G_{12}$, $M_s = 2$",
    rows=ROWS,
    columns=("k", "ki", "w1", "w2"),
    caption="$G_{12}(s) = 9/((s+1)(s^2+as+9))$, relative damping $a/6$; $\\omega_1$ and $\\omega_2$ are the "
    "frequencies at which the Nyquist curve touches the circle.",
    shared_labels=COLUMNS,
    labels={row: f"${row.replace('=', ' = ')}$" for row in ROWS},
)
table_3.trials = lambda: trials(table_3.id, {row: f"G12 {row}" for row in ROWS}, {})


@table_3.reading(
    "as-written",
    "Corner of the envelope (15), or its smooth top (18)",
    note="Where the Nyquist curve touches the circle once, $\\omega_1 = \\omega_2$.",
)
def as_written() -> pd.DataFrame:
    """Design for every a."""
    rows = {}
    for row in ROWS:
        found = design(f"G12 {row}", 2.0)
        rows[row] = [found.k, found.ki, found.frequencies[0], found.frequencies[-1]]
    return table_3.frame(rows)

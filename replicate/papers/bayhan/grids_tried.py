"""Which sample grids were tried for Tables 2 and 3, and how many of their values each meets."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from replicate.papers.bayhan import paper
from replicate.papers.bayhan.evidence import TABLES, agree
from replicate.papers.bayhan.processes import controllers
from replicate.papers.bayhan.readings import AUTHORS
from replicate.papers.bayhan.toolchain import GRIDS_TRIED, SampleGrid, sampled_specifications

if TYPE_CHECKING:
    import pandas as pd

SAMPLES, HORIZONS, LOOKS = GRIDS_TRIED.values()
ROWS = {f"{steps} steps, {decays:g} decays": (int(steps), decays) for steps, decays in product(SAMPLES, HORIZONS)}
COLUMNS = {f"again {again:g}": again for again in LOOKS}

grids = paper.table(
    "sample-grids",
    "Sample grids tried for Tables 2 and 3",
    printed=False,
    rows=tuple(ROWS),
    columns=(*COLUMNS, "of"),
    caption="How many printed values of both tables agree in all six digits, with $K_i = 1/T_i$, the Padé model and "
    "the original Cohen–Coon fractions, for so many sample steps over so many times of decay to 2 % of the dominant "
    "mode. A response that settles in the first half is looked at again over so many settling times, or not.",
    labels={key: f"again over {again:g}" if again else "no second look" for key, again in COLUMNS.items()},
)


@grids.reading("as-written", "Printed values met")
def counts() -> pd.DataFrame:
    """Count the values that every grid meets."""
    printed = {table.id: paper.printed_cells(table.id) for table, _ in TABLES}
    rows = {}
    for name, (steps, decays) in ROWS.items():
        found: dict[str, int] = {}
        for column, again in COLUMNS.items():
            grid, met = SampleGrid(steps, decays, again), 0
            for table, process in TABLES:
                pi = controllers(process, AUTHORS.convention, AUTHORS.variant)
                computed = {rule: sampled_specifications(process, pi[rule], grid) for rule in table.rows}
                met += sum(agree(text, computed[row][quantity]) for (row, quantity), text in printed[table.id].items())
            found[column] = met
        rows[name] = found | {"of": sum(map(len, printed.values()))}
    return grids.frame(rows)

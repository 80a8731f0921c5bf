"""An exhibit that the paper does not have: what the load response does at the printed settling time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from replicate.loops import Signal
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1 import table_1, table_5
from replicate.papers.panagopoulos.part_1.designs import load_response
from replicate.papers.panagopoulos.part_1.plants import PLANTS
from replicate.papers.panagopoulos.part_1.settling import one_sided, two_sided

if TYPE_CHECKING:
    import pandas as pd

TABLE_5 = {f"Table 5, {row}": row for row in table_5.ROWS}

evidence = paper.table(
    "I-settling",
    "What the printed settling times mean",
    printed=False,
    rows=(*table_1.ROWS, *TABLE_5),
    columns=("printed", "level", "above_5", "late", "above_3", "within_5", "within_2"),
    caption="The printed $t_s$; the height of the response to a unit load at that time; the last time above "
    "$+5$ % and how much later the print is, in percent; the last time above $+3$ %; the settling times to "
    "$\\pm 5$ % and $\\pm 2$ %. Times count from the end of the dead time. In Table 1 the print is late "
    "throughout, as if read off a coarse time grid; $G_4$ must have had a smaller load than 1, since its "
    "response is still far above 5 % then.",
    labels={
        **{row: text for row, text in table_1.table_1.labels.items() if row in table_1.ROWS},
        **{row: f"Table 5, {table_5.table_5.labels[key]}" for row, key in TABLE_5.items()},
        "printed": "Printed",
        "level": "$y$ then",
        "above_5": "Above $+5$ %",
        "late": "Print later by, %",
        "above_3": "Above $+3$ %",
        "within_5": "$\\pm 5$ %",
        "within_2": "$\\pm 2$ %",
    },
)


def _row(text: str, response: Signal, dead_time: float) -> list[float]:
    time = float(text)
    last = one_sided(response, dead_time)
    return [
        time,
        float(response(time + dead_time)),
        last,
        100.0 * (time / last - 1.0),
        one_sided(response, dead_time, level=0.03),
        two_sided(response) - dead_time,
        two_sided(response, band=0.02) - dead_time,
    ]


@evidence.reading("as-written", "Exact load responses")
def levels() -> pd.DataFrame:
    """Read every load response at the printed settling time."""
    rows = {}
    for row, (plant, ms) in table_1.ROWS.items():
        rows[row] = _row(paper.printed_cells("I-table-1")[row, "ts"], load_response(plant, ms), PLANTS[plant].dead_time)
    for row, key in TABLE_5.items():
        plant, method = table_5.ROWS[key]
        pi = table_5.authors_controller(plant, method)
        _, load = table_5.responses(plant, pi.k, pi.ki, pi.b)
        rows[row] = _row(paper.printed_cells("I-table-5")[key, "ts"], load, PLANTS[plant].dead_time)
    return evidence.frame(rows)

"""The printed numbers of an exhibit, for statements about the print itself."""

from __future__ import annotations

import csv
from functools import cache

from replicate.papers.panagopoulos import paper


@cache
def printed_values(exhibit: str) -> dict[tuple[str, str], float]:
    """Return the printed numbers by (row, column); blank cells are not there."""
    text = (paper.folder() / "printed" / f"{exhibit}.csv").read_text(encoding="utf-8")
    return {
        (row["row"], column): float(cell)
        for row in csv.DictReader(text.splitlines())
        for column, cell in row.items()
        if column != "row" and cell
    }

"""The paper's own numbers, where a reading takes one of them as its input."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import cache

from replicate.papers.panagopoulos import paper


@cache
def printed(exhibit: str) -> Mapping[tuple[str, str], str]:
    """Return the printed strings of an exhibit by row and column; blank cells are empty."""
    text = (paper.folder() / "printed" / f"{exhibit}.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines())
    return {(row["row"], column): cell for row in rows for column, cell in row.items() if column != "row"}

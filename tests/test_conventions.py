"""Which convention a column follows: small tables whose cells were rounded or truncated by hand."""

from __future__ import annotations

import pytest

from replicate.exhibits import Table
from replicate.exhibits.conventions import settle
from replicate.exhibits.matching import match


@pytest.mark.parametrize(
    ("computed", "convention", "kind"),
    [
        ((3.07, 9.99, 9.99), "rounded", "near"),  # one cell by truncation only says nothing of the author
        ((3.07, 2.38, 9.99), "truncated", "equal"),  # two do
        ((3.07, 2.38, 4.46), "rounded", "near"),  # two against one are no clear majority
    ],
)
def test_one_cell_makes_no_convention(computed: tuple[float, ...], convention: str, kind: str) -> None:
    table = Table("table-1", "table", "T", rows=("A", "B", "C"), columns=("x",))
    prints = ("3.0", "2.3", "4.5")
    matches = {(row, "x"): match(text, number) for row, text, number in zip(table.rows, prints, computed, strict=True)}
    found, decided = settle(table, matches)["A", "x"]
    assert (decided, found.kind) == (convention, kind)

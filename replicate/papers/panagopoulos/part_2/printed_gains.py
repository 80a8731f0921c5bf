"""The controllers as the tables print them, read from the printed numbers."""

from __future__ import annotations

import math

from replicate.exhibits.printed import PrintedValue
from replicate.loops import PID
from replicate.papers.panagopoulos import paper


def printed_number(table: str, row: str, column: str) -> float:
    """Return a printed number; ``nan`` where the cell is blank."""
    cell = paper.printed_cells(table).get((row, column))
    return math.nan if cell is None else float(PrintedValue(cell).value)


def printed_pid(table: str, row: str) -> PID:
    """Return the controller of a row of Table 1 or of its replacement.

    The derivative time of G3, Ms = 2.0 is lost in the scan of Table 1. There the set-point weight is at its limit (15),
    b = sqrt(Td/Ti), which gives Td back.
    """
    k, ti, td = (printed_number(table, row, column) for column in ("k", "Ti", "Td"))
    b = printed_number(table, row, "b")
    if td != td:  # noqa: PLR0124  -- NaN
        td = b**2 * ti
    return PID.ideal(k, ti, td, b=b)

"""The printed numbers of a table, for exhibits that weigh them as evidence."""

from __future__ import annotations

import csv
from importlib.resources import files


def printed_cells(exhibit: str) -> dict[tuple[str, str], str]:
    """Return the printed strings of a table by row and column key."""
    text = (files(__package__) / "printed" / f"{exhibit}.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines())
    return {(row["row"], column): cell for row in rows for column, cell in row.items() if column != "row"}


def meets(printed: str, value: float) -> bool:
    """Return whether a value, not negative, rounds or truncates to a printed number.

    Examples
    --------
    >>> meets("3.84", 3.8361), meets("3.84", 3.8499), meets("3.84", 3.8501), meets("3.84", 3.834)
    (True, True, False, False)
    """
    unit = 10.0 ** -len(printed.partition(".")[2])
    return -0.5 * unit <= value - float(printed) < unit

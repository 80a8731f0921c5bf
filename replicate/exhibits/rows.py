"""Put the rows that a reading computes together into the data frame of the whole table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import date
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError
from replicate.exhibits.definitions import as_mapping

if TYPE_CHECKING:
    import pandas as pd

Cell = float | str | date | tuple[float, float] | None
Row = Mapping[str, Cell] | Sequence[Cell] | Cell


def frame_of_rows(
    table: str, row_keys: Sequence[str], column_keys: Sequence[str], rows: Mapping[str, Row]
) -> pd.DataFrame:
    """Return the data frame of a table; `replicate.exhibits.Table.frame` describes it.

    Parameters
    ----------
    table
        The table's id, for messages.
    row_keys, column_keys
        In the table's order; empty where the table takes what it is given.
    rows
        The cells of each row.

    Raises
    ------
    PaperDefinitionError
        If rows or columns are not those of the table, or a row has too few or too many cells.
    """
    import pandas as pd

    keyed = as_mapping(table, "what holds the rows", rows)
    keys = list(row_keys or keyed)
    _expect_all(table, keyed, keys)
    cells = {key: _cells(keyed[key]) for key in keys}
    given = dict.fromkeys(column for row in cells.values() if isinstance(row, Mapping) for column in row)
    columns = list(column_keys or given)
    for key, row in cells.items():
        if not isinstance(row, Mapping) and len(row) != len(columns):
            msg = f"{table}: row '{key}' has {len(row)} cells for {len(columns)} columns"
            raise PaperDefinitionError(msg)
    _refuse_unknown(table, "column", given, columns)
    by_name = {
        key: dict(row) if isinstance(row, Mapping) else dict(zip(columns, row, strict=True))
        for key, row in cells.items()
    }
    return pd.DataFrame.from_dict(by_name, orient="index", columns=columns)


def _cells(row: Row) -> Mapping[str, Cell] | Sequence[Cell]:
    if isinstance(row, Mapping) or (isinstance(row, Sequence) and not isinstance(row, str)):
        return row
    return [row]


def _expect_all(table: str, given: Mapping[str, object], expected: Iterable[str]) -> None:
    expected = list(expected)
    _refuse_unknown(table, "row", given, expected)
    for key in expected:
        if key not in given:
            msg = f"{table}: row '{key}' is missing"
            raise PaperDefinitionError(msg)


def _refuse_unknown(table: str, kind: str, given: Iterable[str], expected: Iterable[str]) -> None:
    expected = dict.fromkeys(expected)
    for key in given:
        if key not in expected:
            msg = f"{table}: {kind} '{key}' is not one of the table's; allowed: {', '.join(expected)}"
            raise PaperDefinitionError(msg)

"""Take single numbers out of the data frame that a reading returns, and say what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Real
from typing import TYPE_CHECKING

from replicate.exhibits.printed import Key

if TYPE_CHECKING:
    import pandas as pd


class CellError(Exception):
    """A cell that should hold a number does not."""


def cell(frame: pd.DataFrame, row: str, column: str) -> float | None:
    """Return one number of a frame; ``None`` where the reading computed nothing (``None``, NaN, ``pd.NA``).

    Parameters
    ----------
    frame
        Indexed by row key, with column keys as columns.

    Raises
    ------
    CellError
        If the row or column is missing or there twice, or the cell holds something else than a real number.
    """
    import numpy as np
    import pandas as pd

    places = []
    for kind, key, keys in (("row", row, frame.index), ("column", column, frame.columns)):
        found = np.flatnonzero(keys == key)
        if len(found) != 1:
            msg = f"{kind} '{key}' is {'there twice' if len(found) else 'missing'}"
            raise CellError(msg)
        places.append(int(found[0]))
    value: object = frame.iloc[places[0], places[1]]
    if value is None or value is pd.NA or value is pd.NaT:
        return None
    if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        kind = "text" if isinstance(value, str) else type(value).__name__
        msg = f"row '{row}', column '{column}' holds {kind} ({value!r}), needed: a number"
        raise CellError(msg)
    number = float(value)
    return None if number != number else number  # noqa: PLR0124  -- NaN


def cells(frame: pd.DataFrame, keys: Iterable[Key]) -> tuple[dict[Key, float], list[str]]:
    """Return the numbers of the given cells, and one line for each thing that is wrong.

    A missing row or column is named once, not once per cell.
    """
    numbers: dict[Key, float] = {}
    problems: dict[str, None] = {}
    for row, column in keys:
        try:
            number = cell(frame, row, column)
        except CellError as error:
            problems[str(error)] = None
        else:
            if number is not None:
                numbers[row, column] = number
    return numbers, list(problems)

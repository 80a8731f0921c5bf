"""What a reading returns must be its table: the same rows and columns, and in each cell what can be compared there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError, listed
from replicate.exhibits.frames import FrameCells, read_frame
from replicate.exhibits.notation import Notation, Statement, is_date
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.statements import numbers_in, takes_pair

if TYPE_CHECKING:
    import pandas as pd

    from replicate.exhibits.vocabulary import Table

_SHOWN = 12


def checked_frame(table: Table, made: object, printed: Mapping[Key, PrintedValue]) -> pd.DataFrame:
    """Return what a reading of a table has made, if it is the table.

    Parameters
    ----------
    made
        Whatever the reading returned.
    printed
        What the paper prints, by (row, column).

    Raises
    ------
    PaperDefinitionError
        If it is not a data frame, has other rows or columns than the table, one of them twice, or something in a cell
        that cannot be compared with what the paper prints there, such as a text or an infinite number.

    Examples
    --------
    >>> import pandas as pd
    >>> from replicate.exhibits import Table
    >>> table = Table("table-1", "table", "Squares", rows=("two", "three"), columns=("square",))
    >>> checked_frame(table, pd.DataFrame({"square": [4, 9]}), {})
    Traceback (most recent call last):
    replicate.errors.PaperDefinitionError: the reading returns the row '0'; allowed: 'two', 'three'
    """
    import pandas as pd

    if not isinstance(made, pd.DataFrame):
        msg = f"the reading returns {type(made).__name__}; expected: a pandas DataFrame"
        raise PaperDefinitionError(msg)
    cells = read_frame(made)
    for kind, found, declared in (("row", cells.rows, table.rows), ("column", cells.columns, table.columns)):
        _check_keys(kind, found, declared)
    _check_cells(table, cells, printed)
    return made


def _check_keys(kind: str, found: Sequence[str], declared: Sequence[str]) -> None:
    allowed = listed(declared, _SHOWN)
    seen = set[str]()
    for key in found:
        if declared and key not in declared:
            msg = f"the reading returns the {kind} '{key}'; allowed: {allowed}"
            raise PaperDefinitionError(msg)
        if key in seen:
            msg = f"the reading returns the {kind} '{key}' twice"
            raise PaperDefinitionError(msg)
        seen.add(key)
    for key in declared:
        if key not in seen:
            msg = f"the reading does not return the {kind} '{key}'; it returns: {listed(found, _SHOWN)}"
            raise PaperDefinitionError(msg)


def _check_cells(table: Table, cells: FrameCells, printed: Mapping[Key, PrintedValue]) -> None:
    for key, value in printed.items():
        for row, column in (key, *table.spans.get(key, ())):
            wrong = _wrong(cells, (row, column), value)
            if wrong:
                msg = f"the reading returns a wrong cell: row '{row}', column '{column}' holds {wrong}"
                raise PaperDefinitionError(msg)


def _wrong(cells: FrameCells, key: Key, printed: PrintedValue) -> str:
    """Return what a cell holds and what is expected, if it cannot be compared with the print; nothing if it can."""
    notation, statement = printed.notation, printed.statement
    number, held = cells.numbers.get(key), cells.wrong.get(key, "")
    if held:
        fits = _fits(cells.words[key], notation, statement)
    elif number is None:  # nothing is computed
        fits = True
    else:
        held = f"the number {number:g}"
        fits = not notation.date and statement.kind != "interval" and (notation.bounds or math.isfinite(number))
    return "" if fits else f"{held}; expected: {_expected(notation, statement)}"


def _fits(word: str, notation: Notation, statement: Statement) -> bool:
    """Say whether something else than a number can be compared: a word from the list, a date, a pair of numbers."""
    if word in notation.words:
        return True
    if notation.date:
        return is_date(word)
    return takes_pair(statement) and len(numbers_in(word)) == 2


def _expected(notation: Notation, statement: Statement) -> str:
    """Return in words what a reading may give."""
    kind = "a date" if notation.date else "a pair of ends" if statement.kind == "interval" else "a number"
    kinds = [kind, "a pair of value and uncertainty"] if statement.uncertainty else [kind]
    return " or ".join([*kinds, *(f"'{word}'" for word in notation.words)])

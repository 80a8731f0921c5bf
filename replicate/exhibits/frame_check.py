"""What a reading returns must be its table: the same rows and columns, a number in every cell that prints one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from replicate.errors import PaperDefinitionError
from replicate.exhibits.frames import FrameCells, read_frame
from replicate.exhibits.printed import Key

if TYPE_CHECKING:
    import pandas as pd

    from replicate.exhibits.vocabulary import Table

_SHOWN = 12


def checked_frame(table: Table, made: object, printed: Collection[Key]) -> pd.DataFrame:
    """Return what a reading of a table has made, if it is the table.

    Parameters
    ----------
    made
        Whatever the reading returned.
    printed
        The cells in which the paper prints something.

    Raises
    ------
    PaperDefinitionError
        If it is not a data frame, has other rows or columns than the table, one of them twice, or something other than
        a number where the paper prints one.

    Examples
    --------
    >>> import pandas as pd
    >>> from replicate.exhibits import Table
    >>> table = Table("table-1", "table", "Squares", rows=("two", "three"), columns=("square",))
    >>> checked_frame(table, pd.DataFrame({"square": [4, 9]}), ())
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
    allowed = _listed(declared)
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
            msg = f"the reading does not return the {kind} '{key}'; it returns: {_listed(found)}"
            raise PaperDefinitionError(msg)


def _check_cells(table: Table, cells: FrameCells, printed: Collection[Key]) -> None:
    for key, wrong in cells.wrong.items():
        if key in printed and table.notation_of(key[1]).plain:
            msg = f"the reading returns a wrong cell: {wrong}"
            raise PaperDefinitionError(msg)


def _listed(keys: Sequence[str]) -> str:
    shown = ", ".join(f"'{key}'" for key in keys[:_SHOWN])
    return f"{shown}, ..." if len(keys) > _SHOWN else shown or "none"

"""A data frame that a reading returns, as a dictionary of its cells; and what is wrong with one of them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.statements import as_float, given_text

if TYPE_CHECKING:
    import pandas as pd


class CellError(Exception):
    """A cell that should hold a number does not."""


@dataclass(frozen=True)
class FrameCells:
    """The cells of one reading, read once.

    Attributes
    ----------
    numbers
        By (row, column); ``None`` where the reading computed nothing (``None``, NaN, ``pd.NA``).
    words
        What is held by a cell that holds something else than a real number, as its text: a word, a date, a pair.
    wrong
        What such a cell holds, in words for a message, by (row, column).
    twice
        Keys that occur more than once, each with its kind: ``("row", key)``.
    """

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    numbers: dict[Key, float | None] = field(default_factory=dict)
    words: dict[Key, str] = field(default_factory=dict)
    wrong: dict[Key, str] = field(default_factory=dict)
    twice: frozenset[tuple[str, str]] = frozenset()

    def number(self, row: str, column: str) -> float | None:
        """Return one number; ``None`` where the reading computed nothing.

        Raises
        ------
        CellError
            If the row or column is missing or appears twice, or the cell does not hold a real number.
        """
        for kind, key, keys in (("row", row, self.rows), ("column", column, self.columns)):
            if (kind, key) in self.twice:
                msg = f"{kind} '{key}' appears twice"
                raise CellError(msg)
            if key not in keys:
                msg = f"{kind} '{key}' is missing"
                raise CellError(msg)
        if (row, column) in self.wrong:
            msg = f"row '{row}', column '{column}' holds {self.wrong[row, column]}; expected: a number"
            raise CellError(msg)
        return self.numbers[row, column]

    def pick(self, printed: Mapping[Key, PrintedValue]) -> tuple[dict[Key, float], dict[Key, str], list[str]]:
        """Return numbers and words of the cells in which something is printed, and one line for each thing wrong.

        A missing row or column is named once, not once per cell. A word is wrong where the print cannot be one.
        """
        numbers, words = dict[Key, float](), dict[Key, str]()
        problems: dict[str, None] = {}
        for key, value in printed.items():
            if key in self.words and not value.notation.plain:
                words[key] = self.words[key]
                continue
            try:
                number = self.number(*key)
            except CellError as error:
                problems[str(error)] = None
            else:
                if number is not None:
                    numbers[key] = number
        return numbers, words, list(problems)


def read_frame(frame: pd.DataFrame) -> FrameCells:
    """Return the cells of a frame that is indexed by row key, with column keys as columns.

    Examples
    --------
    >>> import pandas as pd
    >>> cells = read_frame(pd.DataFrame({"Mp": [0.25, None]}, index=["ZN", "PA"]))
    >>> cells.number("ZN", "Mp"), cells.number("PA", "Mp")
    (0.25, None)
    """
    rows, columns = (tuple(map(str, keys)) for keys in (frame.index, frame.columns))
    cells = FrameCells(rows, columns, twice=_twice("row", rows) | _twice("column", columns))
    for row, values in zip(rows, frame.itertuples(index=False, name=None), strict=True):
        for column, value in zip(columns, values, strict=True):
            _read(cells, (row, column), value)
    return cells


def _read(cells: FrameCells, key: Key, value: object) -> None:
    import pandas as pd

    if value is None or value is pd.NA or value is pd.NaT:
        cells.numbers[key] = None
    elif (number := as_float(value)) is not None:
        cells.numbers[key] = None if math.isnan(number) else number
    else:
        beyond = isinstance(value, int) and not isinstance(value, bool)
        kind = "text" if isinstance(value, str) else type(value).__name__
        cells.words[key] = given_text(value) or str(value)
        cells.wrong[key] = "an integer beyond the largest number" if beyond else f"{kind} ({value!r})"


def _twice(kind: str, keys: Iterable[str]) -> frozenset[tuple[str, str]]:
    return frozenset((kind, key) for key, count in Counter(keys).items() if count > 1)

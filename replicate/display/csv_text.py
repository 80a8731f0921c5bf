"""Numbers, readings and curves as CSV text: the same digits and line ends wherever a table is written."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from numbers import Real
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

#: Digits of every computed number in the tables; twelve are far more than any paper prints.
DIGITS = 12


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    r"""Return a CSV with ``\n`` line ends; ``None`` and NaN become blank cells.

    Examples
    --------
    >>> print(csv_text(["row", "Mp"], [["PA", 0.1 + 0.2], ["ZN", None]]), end="")
    row,Mp
    PA,0.3
    ZN,
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([number_text(cell) for cell in row] for row in rows)
    return buffer.getvalue()


def number_text(value: object, digits: int = DIGITS) -> str:
    """Return a cell as text: numbers with the given significant digits, nothing for ``None`` and NaN."""
    if value is None:
        return ""
    # whether a number is real is a slow question, which the many cells of curves need not be asked
    if not isinstance(value, float) and (isinstance(value, str | bool) or not isinstance(value, Real)):
        return "" if (text := str(value)) in {"<NA>", "NaT"} else text
    number = float(value) + 0.0  # no negative zero
    return "" if number != number else f"{number:.{digits}g}"  # noqa: PLR0124  -- NaN


def table_text(frame: pd.DataFrame) -> str:
    """Return a reading as CSV in the paper's own layout: row keys in the first column, then the columns."""
    header = ["row" if frame.index.name is None else str(frame.index.name), *map(str, frame.columns)]
    return csv_text(header, frame.itertuples(index=True, name=None))


def curves_text(curves: pd.DataFrame) -> str:
    """Return the curves of a figure as CSV; they come rounded to nine significant digits."""
    # lists of Python's own: pandas makes an object of each text when it is asked for rows
    return csv_text(list(curves.columns), zip(*(curves[name].tolist() for name in curves), strict=True))

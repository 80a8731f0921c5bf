"""Read the files of the accepted state; a damaged file is reported with its line and with what is allowed.

They are written by `replicate.diff.accepted` and compared by hand in reviews, so a merge or an editor may damage
them. Nothing is guessed then: half a file would look like a change of the results.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np

from replicate.errors import AcceptedStateError, FigureRecordError
from replicate.figures.polylines import Points
from replicate.figures.record import Record

CURVE_COLUMNS = ("panel", "curve", "x", "y")

_KEYS = {"row", "column", "reading"}


def read_cells(path: Path, columns: Sequence[str]) -> dict[tuple[str, ...], dict[str, str]]:
    """Return a table, or claims: the other columns by (row, column, reading), or by (row,).

    Raises
    ------
    AcceptedStateError
        If the file is not such a table, or contains a cell twice.
    """
    cells: dict[tuple[str, ...], dict[str, str]] = {}
    lines: dict[tuple[str, ...], int] = {}
    for line, row in _rows(path, columns):
        key, others = keyed(columns, row)
        if key in lines:
            _damaged(path, line, f"'{' '.join(key)}' already appears in line {lines[key]}; allowed: each cell once")
        lines[key] = line
        cells[key] = others
    return cells


def keyed(columns: Sequence[str], row: Sequence[str]) -> tuple[tuple[str, ...], dict[str, str]]:
    """Split a row of a table, or of claims, into what names the cell and what is said of it."""
    named = list(zip(columns, row, strict=True))
    key = tuple(value for name, value in named if name in _KEYS)
    return key, {name: value for name, value in named if name not in _KEYS}


def read_curves(path: Path) -> dict[tuple[str, str], Points]:
    """Return the points of every curve by (panel, curve), shape (n, 2); a row of ``nan`` is a break.

    Raises
    ------
    AcceptedStateError
        If x and y of a row are neither two numbers nor, at a break, both blank.
    """
    points: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for line, (panel, curve, *place) in _rows(path, CURVE_COLUMNS):
        x, y = (_number(text) for text in place)
        if not (place == ["", ""] or (math.isfinite(x) and math.isfinite(y))):
            _damaged(path, line, f"x and y are {','.join(place)}; expected: two numbers, or nothing at a break")
        points.setdefault((panel, curve), []).append((x, y))
    return {key: np.array(value) for key, value in points.items()}


def read_record(path: Path) -> Record:
    """Return the record of a figure, without its curves: they lie beside it.

    Raises
    ------
    AcceptedStateError
        If the file is not a record, or a newer version wrote it.
    """
    try:
        return Record.from_json(_text(path))
    except FigureRecordError as error:
        _damaged(path, error.line, error.why)


def _rows(path: Path, columns: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield line numbers and rows of a CSV that must have exactly these columns."""
    text = _text(path)
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        header = next(reader, [])
        if header != list(columns):
            _damaged(path, 1, f"the columns are {','.join(header) or 'missing'}; expected: {','.join(columns)}")
        for row in reader:
            if len(row) != len(columns):
                _damaged(path, reader.line_num, f"has {len(row)} cells; expected: {len(columns)}")
            yield reader.line_num, row
    except csv.Error as error:
        _damaged(path, reader.line_num, f"is not valid CSV: {error}")
    if not text.endswith("\n"):
        _damaged(path, reader.line_num, "ends in the middle of a line; expected: a newline at the end")


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        _damaged(path, None, f"cannot be read: {error.strerror or error}")
    except UnicodeDecodeError as error:
        _damaged(path, error.object[: error.start].count(b"\n") + 1, "is not UTF-8 text")


def _damaged(path: Path, line: int | None, why: str) -> NoReturn:
    where = f"{path.parent.name}/{path.name}"
    msg = f"{where}: {why}" if line is None else f"{where}:{line}: {why}"
    raise AcceptedStateError(msg) from None


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan

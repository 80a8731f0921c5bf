"""Read the files of the accepted state; a damaged one is named with its line and with what is allowed.

They are written by `replicate.diff.accepted` and compared by hand in reviews, so a merge or an editor may damage
them. Nothing is guessed then: half a file would look like a change of the results.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from replicate.errors import AcceptedStateError
from replicate.figures.polylines import Points

CURVE_COLUMNS = ("panel", "curve", "x", "y")

_KEYS = {"row", "column", "reading"}
_NEEDED = {"panel", "xlim", "ylim"}


def read_cells(path: Path, columns: Sequence[str]) -> dict[tuple[str, ...], dict[str, str]]:
    """Return a table, or claims: the other columns by (row, column, reading), or by (row,).

    Raises
    ------
    AcceptedStateError
        If the file is no such table, or a cell stands in it twice.
    """
    cells: dict[tuple[str, ...], dict[str, str]] = {}
    lines: dict[tuple[str, ...], int] = {}
    for line, row in _rows(path, columns):
        key, others = keyed(columns, row)
        if key in lines:
            _damaged(path, line, f"'{' '.join(key)}' stands in line {lines[key]} already, needed: every cell once")
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
            _damaged(path, line, f"x and y are {','.join(place)}, needed: two numbers, or nothing at a break")
        points.setdefault((panel, curve), []).append((x, y))
    return {key: np.array(value) for key, value in points.items()}


def read_axes(path: Path) -> list[Mapping[str, Any]]:
    """Return the descriptions of the panels of a figure, as in `replicate.figures.readback.read_panel`.

    Raises
    ------
    AcceptedStateError
        If the file is no list of descriptions, or one of them holds what none can.
    """
    try:
        axes = json.loads(_text(path), parse_constant=_no_number)
    except json.JSONDecodeError as error:
        _damaged(path, error.lineno, f"is no JSON: {error.msg}")
    except (ValueError, RecursionError) as error:
        _damaged(path, None, f"is no JSON: {error}")
    if not isinstance(axes, list) or not all(isinstance(entry, dict) and entry.keys() >= _NEEDED for entry in axes):
        _damaged(path, None, f"needed: a list of objects, each with {', '.join(sorted(_NEEDED))}")
    seen: set[str] = set()
    for entry in axes:
        for name, value in entry.items():
            holds, needed = _FIELDS.get(name, (_anything, ""))
            if not holds(value):
                _damaged(path, None, f"{name} of panel '{entry['panel']}' is {json.dumps(value)}, needed: {needed}")
        for axis in "xy":
            if entry.get(f"{axis}scale") == "log" and min(entry[f"{axis}lim"]) <= 0.0:
                _damaged(path, None, f"{axis}lim of panel '{entry['panel']}' is not positive on a logarithmic axis")
        if entry["panel"] in seen:
            _damaged(path, None, f"describes panel '{entry['panel']}' twice, needed: every panel once")
        seen.add(entry["panel"])
    return axes


def _rows(path: Path, columns: Sequence[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield line numbers and rows of a CSV that must have exactly these columns."""
    text = _text(path)
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        header = next(reader, [])
        if header != list(columns):
            _damaged(path, 1, f"the columns are {','.join(header) or 'missing'}, needed: {','.join(columns)}")
        for row in reader:
            if len(row) != len(columns):
                _damaged(path, reader.line_num, f"has {len(row)} cells, needed: {len(columns)}")
            yield reader.line_num, row
    except csv.Error as error:
        _damaged(path, reader.line_num, f"is no CSV: {error}")
    if not text.endswith("\n"):
        _damaged(path, reader.line_num, "ends in the middle of a line, needed: a line end")


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        _damaged(path, None, f"cannot be read: {error.strerror or error}")
    except UnicodeDecodeError as error:
        _damaged(path, error.object[: error.start].count(b"\n") + 1, "is no text in UTF-8")


def _damaged(path: Path, line: int | None, why: str) -> NoReturn:
    where = f"{path.parent.name}/{path.name}"
    msg = f"{where}: {why}" if line is None else f"{where}:{line}: {why}"
    raise AcceptedStateError(msg) from None


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _no_number(name: str) -> NoReturn:
    msg = f"{name} is no number"
    raise ValueError(msg)


# ------------------------------------------------------------------ what the description of a panel may hold


def _anything(_: object) -> bool:
    return True


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _are_texts(value: object) -> bool:
    return isinstance(value, list) and all(map(_is_text, value))


def _are_limits(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value)) and value[0] != value[1]


def _are_placed(value: object) -> bool:
    return isinstance(value, list) and all(
        isinstance(text, dict)
        and _is_text(text.get("text"))
        and all(_is_number(text.get(axis)) or _is_text(text.get(axis)) for axis in "xy")
        for text in value
    )


def _are_numbers_by_name(value: object) -> bool:
    return isinstance(value, dict) and all(map(_is_number, value.values()))


_Field = tuple[Callable[[object], bool], str]

_TEXT: _Field = (_is_text, "a text")
_TEXTS: _Field = (_are_texts, "a list of texts")
_LIMITS: _Field = (_are_limits, "two different numbers")

_FIELDS: dict[str, _Field] = {
    **dict.fromkeys(("panel", "title", "xlabel", "ylabel", "xscale", "yscale", "aspect", "figure_title"), _TEXT),
    **dict.fromkeys(("legend", "figure_legend", "figure_texts", "points", "areas"), _TEXTS),
    **dict.fromkeys(("xlim", "ylim"), _LIMITS),
    "hidden": (_is_flag, "true or false"),
    "texts": (_are_placed, "a list of objects, each with text, x and y"),
    "thinned": (_are_numbers_by_name, "numbers by name"),
}

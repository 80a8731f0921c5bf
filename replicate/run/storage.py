"""A result as text that is data and nothing else: JSON, with every number as it was computed.

A worker sends its result in this form and the cache keeps it so; both are read without running anything, which
pickled objects would do. A float is written with the digits that give the same float back. What is read is checked
field by field: a text that is not exactly a result of its kind is refused.
"""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable, Iterable
from numbers import Integral
from typing import TYPE_CHECKING, Any, TypeVar, get_args

from replicate.exhibits import ClaimVerdict, Finding
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.exhibits.statements import as_float, given_text
from replicate.exhibits.trials import TableTrials, Trial
from replicate.run.stored_ranges import ranges_from_data, ranges_to_data

if TYPE_CHECKING:
    import pandas as pd

#: Changes with the form of what is written here.
SCHEMA = 5

_POINT = ("panel", "curve", "x", "y")
_MOST_SHOWN = 60
_LARGEST_EXACT = 2**53  # larger integers lose digits in a column of floats
_ADDRESS = re.compile(r" at 0x[0-9a-f]+")  # differs from run to run

T = TypeVar("T")


def to_text(result: Result) -> str:
    """Return a result as one line of JSON.

    Raises
    ------
    TypeError
        If a cell of a table, or the value of a claim, is nothing that JSON can hold; the message names the cell.
    """
    if isinstance(result, TableResult):
        fields = {
            "frames": {id: _frame(frame) for id, frame in result.frames.items()},
            "errors": result.errors,
            "ranges": {id: ranges_to_data(ranges) for id, ranges in result.ranges.items()},
            "trials": [result.trials.declared, result.trials.computed, result.trials.error],
        }
    elif isinstance(result, FigureResult):
        fields = {
            "svg": result.svg,
            "png": base64.b64encode(result.png).decode("ascii"),
            "curves": _curves(result.curves),
            "axes": result.axes,
            "error": result.error,
            "figure": result.figure,
        }
    else:
        findings = {
            id: [found.verdict, number(found.value, f"the value of claim '{id}' is"), found.evidence]
            for id, found in result.findings.items()
        }
        fields = {"findings": findings, "errors": result.errors}
    named = {"kind": type(result).__name__, "paper": result.paper, "exhibit": result.exhibit, **fields}
    return json.dumps(named, ensure_ascii=False, separators=(",", ":"))


def from_text(text: str | bytes) -> Result:
    """Return the result that `to_text` wrote.

    Raises
    ------
    ValueError
        If the text is not a result: not JSON, a field missing or one too many, a value of another type.

    Examples
    --------
    >>> from_text(to_text(ClaimsResult("lab", "claims", {"root": Finding("holds", 0.1, "It is 0.1.")})))
    ClaimsResult(paper='lab', exhibit='claims', findings={'root': Finding(verdict='holds', value=0.1, evidence='It is 0.1.')}, errors={})
    """  # noqa: E501  -- the record is one line
    given = _as(dict, json.loads(text))
    kind = given.pop("kind", None)
    if kind not in _READERS:
        msg = f"no kind of result: {kind!r}"
        raise ValueError(msg)
    needed, read = _READERS[kind]
    if set(given) != {"paper", "exhibit", *needed}:
        msg = f"a {kind} has the fields {', '.join(needed)}, not {', '.join(sorted(given))}"
        raise ValueError(msg)
    return read(_as(str, given["paper"]), _as(str, given["exhibit"]), given)


def _read_table(paper: str, exhibit: str, given: dict[str, Any]) -> TableResult:
    frames = {id: _to_frame(frame) for id, frame in _as(dict, given["frames"]).items()}
    ranges = {id: ranges_from_data(data) for id, data in _as(dict, given["ranges"]).items()}
    declared, computed, error = _as(list, given["trials"])
    trials = TableTrials(_trials(declared), _trials(computed), _as(str, error))
    return TableResult(paper, exhibit, frames, _texts(given["errors"]), ranges, trials)


def _read_figure(paper: str, exhibit: str, given: dict[str, Any]) -> FigureResult:
    return FigureResult(
        paper,
        exhibit,
        svg=_as(str, given["svg"]),
        png=base64.b64decode(_as(str, given["png"]), validate=True),
        curves=_to_curves(given["curves"]),
        axes=[_as(dict, axes) for axes in _as(list, given["axes"])],
        error=_as(str, given["error"]),
        figure=_as(dict, given["figure"]),
    )


def _read_claims(paper: str, exhibit: str, given: dict[str, Any]) -> ClaimsResult:
    findings = {}
    for id, found in _as(dict, given["findings"]).items():
        verdict, value, evidence = _as(list, found)
        if verdict not in get_args(ClaimVerdict) or isinstance(value, bool) or not isinstance(value, int | float):
            msg = f"claim '{id}' has no verdict and number"
            raise ValueError(msg)
        findings[id] = Finding(verdict, value, _as(str, evidence))
    return ClaimsResult(paper, exhibit, findings, _texts(given["errors"]))


_READERS: dict[str, tuple[tuple[str, ...], Callable[[str, str, dict[str, Any]], Result]]] = {
    "TableResult": (("frames", "errors", "ranges", "trials"), _read_table),
    "FigureResult": (("svg", "png", "curves", "axes", "error", "figure"), _read_figure),
    "ClaimsResult": (("findings", "errors"), _read_claims),
}


def _as(kind: type[T], value: object) -> T:
    if not isinstance(value, kind):
        msg = f"expected: {kind.__name__}, found: {type(value).__name__}"
        raise ValueError(msg)  # noqa: TRY004  -- whatever is wrong with a text is a ValueError, as in `json`
    return value


def _trials(value: object) -> tuple[Trial, ...]:
    found = []
    for texts in _as(list, value):
        row, case, plant, controller = (_as(str, text) for text in _as(list, texts))
        found.append(Trial(row, case, plant, controller))
    return tuple(found)


def _texts(value: object) -> dict[str, str]:
    return {id: _as(str, text) for id, text in _as(dict, value).items()}


def number(value: Any, head: str) -> int | float:
    """Return a real number as an int or float of Python, which JSON writes in full.

    Parameters
    ----------
    head
        Begins the message if it is none: "the value is", "row 'A', column 'x' holds".

    Raises
    ------
    TypeError
        If it is something else than a real number, or beyond the largest one.

    Examples
    --------
    >>> import numpy as np
    >>> number(np.float64(0.1), "the value is"), number(np.int64(3), "the value is")
    (0.1, 3)
    """
    found = as_float(value)
    if found is None and isinstance(value, int) and not isinstance(value, bool):
        msg = f"{head} an integer beyond the largest floating-point number, 1.8e308"
        raise TypeError(msg)
    if found is None:
        kind = "text" if isinstance(value, str) else type(value).__name__
        shown = _ADDRESS.sub("", repr(value))[:_MOST_SHOWN]
        msg = f"{head} {kind} ({shown}); expected: a number"
        raise TypeError(msg)
    return int(value) if isinstance(value, Integral) else found


def _frame(frame: pd.DataFrame) -> dict[str, Any]:
    rows, columns = ([str(key) for key in keys] for keys in (frame.index, frame.columns))
    cells = []
    for row, values in zip(rows, frame.itertuples(index=False, name=None), strict=True):
        cells.append([_cell(value, row, column) for column, value in zip(columns, values, strict=True)])
    return {"rows": rows, "columns": columns, "cells": cells}


def _cell(value: Any, row: str, column: str) -> int | float | str | bool | None:
    import numpy as np
    import pandas as pd

    if value is None or value is pd.NA or value is pd.NaT:
        return None
    text = given_text(value)  # which is wrong in a column of numbers; what is said about it is said there
    if text is not None:
        return text
    if isinstance(value, bool | np.bool_):
        return bool(value)
    return number(value, f"row '{row}', column '{column}' holds")


def _to_frame(value: object) -> pd.DataFrame:
    import pandas as pd

    given = _as(dict, value)
    rows, columns, cells = (_as(list, given.get(name)) for name in ("rows", "columns", "cells"))
    allowed = (int, float, str, bool, type(None))
    if len(cells) != len(rows) or any(
        len(_as(list, line)) != len(columns) or not all(isinstance(cell, allowed) for cell in line) for line in cells
    ):
        msg = "the cells of a frame do not fit its rows and columns"
        raise ValueError(msg)
    keys = pd.Index([_as(str, row) for row in rows]), pd.Index([_as(str, column) for column in columns])
    frame = pd.DataFrame(cells, index=keys[0], columns=keys[1], dtype=object)
    exact = all(abs(cell) <= _LARGEST_EXACT for line in cells for cell in line if isinstance(cell, int))
    return frame.infer_objects() if exact else frame


def _curves(curves: pd.DataFrame) -> list[list[Any]]:
    """Return one list ``[panel, curve, x, y]`` for each run of points of one curve."""
    runs: list[list[Any]] = []
    for panel, curve, x, y in zip(*(curves[name].tolist() for name in _POINT), strict=True):
        if not runs or runs[-1][:2] != [panel, curve]:
            runs.append([panel, curve, [], []])
        runs[-1][2].append(x)
        runs[-1][3].append(y)
    return runs


def _to_curves(value: object) -> pd.DataFrame:
    import numpy as np
    import pandas as pd

    names: dict[str, list[str]] = {"panel": [], "curve": []}
    points: dict[str, list[Any]] = {"x": [], "y": []}
    for run in _as(list, value):
        panel, curve, x, y = _as(list, run)
        if len(_as(list, x)) != len(_as(list, y)):
            msg = f"curve '{curve}' has {len(x)} x and {len(y)} y"
            raise ValueError(msg)
        names["panel"] += [_as(str, panel)] * len(x)
        names["curve"] += [_as(str, curve)] * len(x)
        points["x"] += x
        points["y"] += y
    columns = {name: pd.Series(texts, dtype=object) for name, texts in names.items()}
    return pd.DataFrame({**columns, **{name: np.array(_floats(given)) for name, given in points.items()}})


def _floats(values: Iterable[object]) -> list[float]:
    return [_as(float, value) for value in values]

"""The record of a figure: what it shows, as plain data with a version number, written as JSON and read back.

``schemas/figure-record.schema.json`` is its JSON Schema. Version 1, which only papers used, was the bare list of panels
with the curves in a CSV beside it; version 2 adds everything that is drawn. What a later
revision of a version adds is in `replicate.figures.older_records`.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np

from replicate.figures.checking import check_record, refuse
from replicate.figures.json_text import parse_json
from replicate.figures.polylines import Points

VERSION = 2
#: Within the version: a later revision says more, and only that.
REVISION = 2
FORMAT = "figure record"


@dataclass(frozen=True)
class Record:
    """What a figure shows.

    Attributes
    ----------
    figure
        Of the figure as a whole: ``size`` in inches, ``parts``, the ``revision`` of what is said.
    panels
        One description for each axes, as in `replicate.figures.describe`, with its ``position`` and ``parts``.
    curves
        Points by (panel, curve), shape (n, 2), in data coordinates; a row of ``nan`` is a break.
    version
        Of the file it was read from.
    """

    figure: Mapping[str, Any] = field(default_factory=dict)
    panels: Sequence[Mapping[str, Any]] = ()
    curves: Mapping[tuple[str, str], Points] = field(default_factory=dict)
    version: int = VERSION

    @property
    def revision(self) -> int:
        """Of its version; records had none at first."""
        return int(self.figure.get("revision", 1))

    @property
    def outdated(self) -> bool:
        """Whether the present version says more of a figure than this record can."""
        return (self.version, self.revision) < (VERSION, REVISION)

    def to_json(self) -> str:
        """Return the record as JSON, the same bytes for the same record.

        Examples
        --------
        >>> from replicate.figures import Record
        >>> Record.from_json(Record({"size": [4.0, 3.0]}).to_json()).figure
        {'size': [4.0, 3.0]}
        """
        panels = []
        for panel in self.panels:
            own = {name: points for (owner, name), points in self.curves.items() if owner == panel["panel"]}
            panels.append({**panel, "curves": {name: _rows(points) for name, points in own.items()}})
        return record_text(self.figure, panels)

    @classmethod
    def from_json(cls, text: str) -> Record:
        """Read a record.

        Parameters
        ----------
        text
            As `to_json` writes it.

        Raises
        ------
        FigureRecordError
            If the text is not a record, or a newer version wrote it.
        """
        content = _parsed(text)
        version = 1 if isinstance(content, list) else content.get("version") if isinstance(content, dict) else None
        if isinstance(version, int) and version > VERSION:
            refuse(f"was written by a newer version: its format is {version}, this one reads up to {VERSION}")
        if version == 1 and isinstance(content, list):
            content = {"figure": {}, "panels": content}
        elif version != VERSION or content.get("format") != FORMAT:
            refuse(f"is not a record of a figure: 'format' must be '{FORMAT}' and 'version' at most {VERSION}")
        figure = content.get("figure")
        check_record(figure, content.get("panels"))
        panels, curves = [], {}
        for panel in content["panels"]:
            own = panel.get("curves", {})
            if not isinstance(own, dict):
                refuse(f"'curves' of panel '{panel['panel']}' must be an object")
            for name, rows in own.items():
                curves[panel["panel"], name] = _points(rows, panel["panel"], name)
            panels.append({key: value for key, value in panel.items() if key != "curves"})
        return cls(figure, panels, curves, version)


def record_text(figure: Mapping[str, Any], panels: Sequence[Mapping[str, Any]]) -> str:
    """Return a record as JSON that a review can read: one line for each part and for each curve."""
    return _block({"format": FORMAT, "version": VERSION, "figure": figure, "panels": panels}, 0) + "\n"


def _block(value: Any, depth: int) -> str:
    """Break objects and lists of objects over lines down to where a part or a curve begins."""
    space = " " * (depth + 1)
    if isinstance(value, Mapping) and depth < 3 and value and "marks" not in value:
        inner = (
            f"{space}{json.dumps(key, ensure_ascii=False)}: {_block(part, depth + 1)}" for key, part in value.items()
        )
        return "{\n" + ",\n".join(inner) + "\n" + " " * depth + "}"
    if isinstance(value, Sequence) and not isinstance(value, str) and value and isinstance(value[0], Mapping):
        return "[\n" + ",\n".join(f"{space}{_block(part, depth + 1)}" for part in value) + "\n" + " " * depth + "]"
    if isinstance(value, Mapping) and value and depth == 3 and all(isinstance(part, list) for part in value.values()):
        inner = (f"{space}{json.dumps(key, ensure_ascii=False)}: {_plain(part)}" for key, part in value.items())
        return "{\n" + ",\n".join(inner) + "\n" + " " * depth + "}"
    return _plain(value)


def _plain(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))


def _rows(points: Points) -> list[list[float] | None]:
    return [[float(x), float(y)] if math.isfinite(x) and math.isfinite(y) else None for x, y in points]


def _points(rows: Any, panel: str, name: str) -> Points:
    if not isinstance(rows, list) or not all(
        row is None or (isinstance(row, list) and len(row) == 2 and all(isinstance(part, int | float) for part in row))
        for row in rows
    ):
        refuse(f"curve '{name}' of panel '{panel}' must be a list of pairs of numbers, or null at a break")
    return np.array([[math.nan, math.nan] if row is None else row for row in rows], dtype=float).reshape(-1, 2)


def _parsed(text: str) -> Any:
    try:
        return parse_json(text, parse_constant=_no_number, parse_int=_integer, parse_float=_float)
    except json.JSONDecodeError as error:
        refuse(f"is not valid JSON: {error.msg}", error.lineno)
    except ValueError as error:
        refuse(f"is not valid JSON: {error}")


def _integer(digits: str) -> int | float:
    return int(digits) if len(digits) <= sys.float_info.dig else _float(digits)


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        msg = f"{digits[:20]} is beyond the largest number"
        raise ValueError(msg)
    return value


def _no_number(name: str) -> NoReturn:
    msg = f"{name} is not a number"
    raise ValueError(msg)

"""What differs between two states of an exhibit, in words."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from replicate.curve_distance import curve_distance
from replicate.simplify import Points

#: Computed values are the same up to this, relative: well above the rounding of another processor ...
RELATIVE = 1e-7
#: ... and up to this, absolute, where a value is zero but for rounding.
ABSOLUTE = 1e-10
#: Curves are the same up to this fraction of the size of their axes: a multiple of the error of thinning.
CURVE = 2e-4

Kind = Literal["value", "verdict", "printed", "curve", "axes", "new", "removed", "failed"]


@dataclass(frozen=True)
class Change:
    """One difference from the accepted state.

    Attributes
    ----------
    text
        What changed, in words.
    where
        The cell (``row column (reading)``), curve (``panel / curve``) or property it is about; empty for the
        whole exhibit.
    before, after
        The two values, as text.
    """

    paper: str
    exhibit: str
    kind: Kind
    text: str
    where: str = ""
    before: str = ""
    after: str = ""

    def __str__(self) -> str:
        """Return the whole sentence, for the terminal and the log."""
        return f"{self.paper}/{self.exhibit}: {self.text}"


def same_number(before: str, after: str) -> bool:
    """Whether two texts are equal, or numbers that differ by no more than rounding.

    Examples
    --------
    >>> same_number("6.96800001", "6.968"), same_number("6.969", "6.968"), same_number("", "0")
    (True, False, False)
    """
    if before == after:
        return True
    try:
        return math.isclose(float(before), float(after), rel_tol=RELATIVE, abs_tol=ABSOLUTE)
    except ValueError:
        return False


def compare_rows(paper: str, exhibit: str, before: str, after: str, keys: Sequence[str]) -> list[Change]:
    """Compare two CSVs line by line, matched by their key columns.

    Parameters
    ----------
    before, after
        The texts. The column ``computed`` is compared as numbers, all others exactly.
    keys
        Names of the columns that identify a line.
    """
    old, new = _by_key(before, keys), _by_key(after, keys)
    changes = []
    for key in dict.fromkeys((*old, *new)):
        where = _cell_name(key)
        if key not in new:
            changes.append(Change(paper, exhibit, "removed", f"{where} is gone", where))
        elif key not in old:
            changes.append(Change(paper, exhibit, "new", f"{where} is new", where))
        else:
            changes += _compare_line(paper, exhibit, where, old[key], new[key])
    return changes


def _by_key(text: str, keys: Sequence[str]) -> dict[tuple[str, ...], dict[str, str]]:
    return {
        tuple(line.get(key) or "" for key in keys): {
            name: value or "" for name, value in line.items() if name
        }
        for line in csv.DictReader(io.StringIO(text, newline=""))
    }


def _cell_name(key: tuple[str, ...]) -> str:
    *cell, reading = key if len(key) > 1 else (*key, "")
    return " ".join(cell) + (f" ({reading})" if reading else "")


def _compare_line(
    paper: str, exhibit: str, where: str, old: Mapping[str, str], new: Mapping[str, str]
) -> Iterator[Change]:
    parts = []
    worst: tuple[Kind, str, str] | None = None
    for name, kind in _FIELDS.items():
        one, other = old.get(name, ""), new.get(name, "")
        if not (same_number(one, other) if kind == "value" else one == other):
            label = "" if kind == "value" else f"{name} "
            parts.append(f"{label}{one or 'nothing'} -> {other or 'nothing'}")
            worst = (kind, one, other)
    if worst:
        kind, one, other = worst
        yield Change(paper, exhibit, kind, f"{where} {'; '.join(parts)}", where, one, other)


#: The columns that are compared and the kind of a change in them, the kind that matters most last.
_FIELDS: dict[str, Kind] = {"computed": "value", "printed": "printed", "verdict": "verdict"}


def compare_axes(
    paper: str, exhibit: str, before: Sequence[Mapping[str, Any]], after: Sequence[Mapping[str, Any]]
) -> list[Change]:
    """Compare the descriptions of axes (limits, scales, labels, legend, texts), matched by panel."""
    old = {str(axes["panel"]): axes for axes in before}
    new = {str(axes["panel"]): axes for axes in after}
    changes = []
    for panel in dict.fromkeys((*old, *new)):
        if panel not in new or panel not in old:
            what, kind = ("is gone", "removed") if panel in old else ("is new", "new")
            changes.append(Change(paper, exhibit, "axes", f"panel '{panel}' {what}", panel, kind))
            continue
        for name in dict.fromkeys((*old[panel], *new[panel])):
            one, other = old[panel].get(name), new[panel].get(name)
            if not _same(one, other):
                text = f"{name} of '{panel}' is now {_shown(other)} (was {_shown(one)})"
                where = f"{panel} / {name}"
                changes.append(Change(paper, exhibit, "axes", text, where, _shown(one), _shown(other)))
    return changes


def _same(one: object, other: object) -> bool:
    if isinstance(one, int | float) and isinstance(other, int | float):
        return same_number(repr(float(one)), repr(float(other)))
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    return one == other


def _shown(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, float):
        return f"{value:.9g}"
    return f"'{value}'" if isinstance(value, str) else str(value)


def compare_curves(
    paper: str, exhibit: str, before: str, after: str, axes: Sequence[Mapping[str, Any]]
) -> list[Change]:
    """Compare the curves of a figure, matched by panel and name.

    Parameters
    ----------
    before, after
        CSV texts with the columns ``panel, curve, x, y``; a line without x and y is a break.
    axes
        The accepted description of the axes: distances are fractions of their width and height.
    """
    scale = {str(panel["panel"]): panel for panel in axes}
    old, new = _curves(before), _curves(after)
    changes = []
    for panel, curve in dict.fromkeys((*old, *new)):
        where = f"{panel} / {curve}"
        name = f"curve '{curve}'" + (f" of '{panel}'" if len(scale) > 1 else "")
        if (panel, curve) not in new:
            changes.append(Change(paper, exhibit, "removed", f"{name} is gone", where))
        elif (panel, curve) not in old:
            changes.append(Change(paper, exhibit, "new", f"{name} is new", where))
        else:
            one, other = old[panel, curve], new[panel, curve]
            distance, place = curve_distance(
                *(_in_units(points, scale.get(panel, {})) for points in (one, other))
            )
            if distance > CURVE:
                at = f"({one[place, 0]:.4g}, {one[place, 1]:.4g})" if len(one) else "nowhere"
                text = f"{name} moved: at most {100 * distance:.2g} % of the axes at {at}"
                changes.append(Change(paper, exhibit, "curve", text, where, "", f"{distance:.3g}"))
    return changes


def _curves(text: str) -> dict[tuple[str, str], Points]:
    points: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for line in csv.DictReader(io.StringIO(text, newline="")):
        x, y = (float(line[name]) if line[name] else math.nan for name in ("x", "y"))
        points.setdefault((line["panel"], line["curve"]), []).append((x, y))
    return {key: np.array(value) for key, value in points.items()}


def _in_units(points: Points, axes: Mapping[str, Any]) -> Points:
    """Return points as fractions of the axes; a logarithmic axis is measured in its logarithm."""
    columns = []
    for values, name in zip(points.T, ("x", "y"), strict=True):
        limits = np.asarray(axes.get(f"{name}lim", (0.0, 1.0)), dtype=float)
        if axes.get(f"{name}scale") == "log":
            with np.errstate(all="ignore"):
                values, limits = np.log(values), np.log(limits)  # noqa: PLW2901
        columns.append((values - limits[0]) / (limits[1] - limits[0]))
    return np.column_stack(columns)

"""Whether two states of axes have the same properties, but for what nobody could see."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from replicate.figures.differences import same_number
from replicate.figures.scaling import TOLERANCE, in_units

Axes = Mapping[str, Any]

# Panels are where they were up to this fraction of the figure, or this if their layout follows the size of texts.
_MOVED, _FITTED = 3e-3, 0.09


def same(one: Axes, other: Axes, name: str) -> bool:
    """Whether a property of two axes is the same, but for what nobody could see."""
    return same_value(one.get(name), other.get(name)) or _as_drawn(name, one, other)


def _as_drawn(name: str, one: Axes, other: Axes) -> bool:
    """Whether limits that follow the data differ by less than one could see."""
    if name == "position":
        apart = max(abs(a - b) for a, b in zip(one[name], other[name], strict=True))
        return bool(apart <= (_FITTED if one.get("fitted") or other.get("fitted") else _MOVED))
    if name in {"xtable", "ytable"}:
        return _same_scale(name[0], one, other)
    if name not in {"xlim", "ylim"}:
        return False
    if one.get("units") == "box" or "polar" in one:
        return close(one[name], other[name])
    ends = [np.column_stack([axes["xlim"], axes["ylim"]]) for axes in (one, other)]
    return bool(np.all(np.abs(in_units(ends[1], one) - in_units(ends[0], one))[:, "xy".index(name[0])] <= TOLERANCE))


def close(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether numbers are the same up to what can be seen of the largest of them."""
    size = max((abs(value) for value in one), default=1.0) or 1.0
    return len(one) == len(other) and all(abs(a - b) <= TOLERANCE * size for a, b in zip(one, other, strict=True))


def _same_scale(axis: str, one: Axes, other: Axes) -> bool:
    """Whether values lie where they lay; other limits are said on their own."""
    if not same_value(one[f"{axis}lim"], other[f"{axis}lim"]) or one.get(f"{axis}scale") != other.get(f"{axis}scale"):
        return True
    if f"{axis}table" not in one or f"{axis}table" not in other:
        return False
    tables = [axes[f"{axis}table"] for axes in (one, other)]
    low, high = sorted(one[f"{axis}lim"])
    values = [value for value in tables[0]["data"] if low <= value <= high]
    places = [np.interp(values, table["data"], table["at"]) for table in tables]
    return bool(np.abs(places[1] - places[0]).max(initial=0.0) <= 5.0 * TOLERANCE)


def same_value(one: Any, other: Any) -> bool:
    """Whether two values of a description are equal, numbers up to their last digits."""
    if isinstance(one, int | float) and isinstance(other, int | float):
        return same_number(repr(float(one)), repr(float(other)))
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same_value, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same_value(one[key], other[key]) for key in one)
    return bool(one == other)

"""One side of a sweep file, its plants or its controllers: texts, or columns of numbers of which all are combined.

A side is never written out: the members of a block are made when the block is computed, so that a billion loops take
no more memory than a thousand, and a worker is sent the ends of a range.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

SCALES = ("linear", "log")
MOST_POINTS = 100_000_000  # of one range
MOST_MEMBERS = 10**12
RANGE = "{ from = 0.1, to = 10, points = 50, scale = 'linear' or 'log' }"

#: Called with a key and what is wrong there; raises.
Refuse = Callable[[str, str], NoReturn]


@dataclass(frozen=True)
class Range:
    """Values from ``first`` to ``last``, equally far apart, or those with equally distant logarithms.

    Examples
    --------
    >>> Range(0.1, 10.0, 3, "log")[np.arange(3)]
    array([ 0.1,  1. , 10. ])
    """

    first: float
    last: float
    points: int
    scale: str = SCALES[0]

    def __len__(self) -> int:
        return self.points

    def __getitem__(self, places: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the values at some places, as `numpy.linspace` or `numpy.geomspace` has them."""
        log = self.scale != SCALES[0]
        first, last = np.log10([self.first, self.last]) if log else (self.first, self.last)
        inner = places * ((last - first) / max(self.points - 1, 1)) + first
        values = 10.0**inner if log else inner
        return np.where(places == 0, self.first, np.where(places == self.points - 1, self.last, values))


@dataclass(frozen=True)
class Side:
    """Plants or controllers.

    Attributes
    ----------
    name
        ``plant`` or ``controller``.
    texts
        In the notation of `replicate.loops.notation`; empty if the side is a table.
    columns
        Values by parameter; every combination is a member, the last column running fastest.
    """

    name: str
    texts: tuple[str, ...] = ()
    columns: Mapping[str, NDArray[np.float64] | Range] | None = None

    def __len__(self) -> int:
        if self.columns is None:
            return len(self.texts)
        return math.prod(len(values) for values in self.columns.values())

    def members(self, first: int, last: int) -> dict[str, list[Any]]:
        """Return members ``first`` up to, not including, ``last``: their texts, or their values by parameter."""
        if self.columns is None:
            return {self.name: list(self.texts[first:last])}
        shape = tuple(len(values) for values in self.columns.values())
        places = np.unravel_index(np.arange(first, last), shape)
        return {
            name: [float(value) for value in values[place]]
            for (name, values), place in zip(self.columns.items(), places, strict=True)
        }


def side_of(name: str, given: object, allowed: tuple[str, ...], refuse: Refuse) -> Side:
    """Return a side as a sweep file gives it: a text, a list of texts, or a table of parameters.

    Parameters
    ----------
    allowed
        The parameters of a table.
    """
    key = f"{name}s"
    if isinstance(given, str):
        given = [given]
    if isinstance(given, list) and given and all(isinstance(text, str) for text in given):
        return Side(name, tuple(given))
    if not isinstance(given, dict) or not given:
        refuse(key, f"{key} must be a text, a list of texts, or a table of {', '.join(allowed)}")
    for column in given:
        if column not in allowed:
            refuse(column, f"{key}: '{column}' is unknown; allowed: {', '.join(allowed)}")
    columns = {column: _values(column, value, refuse) for column, value in given.items()}
    members = math.prod(map(len, columns.values()))
    if members > MOST_MEMBERS:
        refuse(key, f"{key}: {members:,} combinations are too many; at most {MOST_MEMBERS:,}")
    return Side(name, columns=columns)


def _values(column: str, given: object, refuse: Refuse) -> NDArray[np.float64] | Range:
    if isinstance(given, dict):
        return _range(column, given, refuse)
    values = given if isinstance(given, list) else [given]
    if not values or not all(_is_number(value) for value in values):
        refuse(column, f"{column} must be a number, a list of numbers, or a range {RANGE}")
    return np.array(values, dtype=float)


def _range(column: str, given: dict[str, Any], refuse: Refuse) -> Range:
    first: Any = given.get("from")
    last: Any = given.get("to")
    points: Any = given.get("points")
    scale = given.get("scale", SCALES[0])
    unknown = set(given) - {"from", "to", "points", "scale"}
    whole = isinstance(points, int) and not isinstance(points, bool) and points >= 1
    if unknown or not _is_number(first) or not _is_number(last) or not whole or scale not in SCALES:
        refuse(column, f"{column} is not a range; expected {RANGE}")
    if points > MOST_POINTS:
        refuse(column, f"{column}: a range has at most {MOST_POINTS} points, not {points}")
    if scale == SCALES[0]:
        if not _is_number(last - first):
            refuse(column, f"{column}: the difference of 'from' and 'to' is too large")
    elif not (first > 0 and last > 0):
        refuse(column, f"{column}: a logarithmic range needs 'from' and 'to' above 0")
    return Range(float(first), float(last), points, scale)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max

"""The ranges of a reading with printed inputs as data that JSON can hold, and back."""

from __future__ import annotations

from typing import Any, get_args

from replicate.exhibits.printed import Key
from replicate.exhibits.results import Proof, Ranges

_NUMBERS = 3  # of a cell: lower, upper, joint
_PROOFS = get_args(Proof)


def ranges_to_data(ranges: Ranges) -> dict[str, Any]:
    """Return ranges as lists and dictionaries."""
    cells = [[*key, ranges.lower[key], ranges.upper[key], ranges.joint[key]] for key in ranges.lower]
    return {"cells": cells, "points": ranges.points, "proofs": [[*key, proof] for key, proof in ranges.proofs.items()]}


def ranges_from_data(data: object) -> Ranges:
    """Return the ranges that `ranges_to_data` wrote.

    Raises
    ------
    ValueError
        If the data are not such ranges.

    Examples
    --------
    >>> x = ("A", "x")
    >>> given = Ranges({x: 1.0}, {x: 2.0}, {x: 1.5}, {"A": {"k": 0.5}}, {x: "alone"})
    >>> ranges_from_data(ranges_to_data(given)) == given
    True
    """
    if not isinstance(data, dict) or set(data) != {"cells", "points", "proofs"} or not isinstance(data["cells"], list):
        msg = "ranges have the fields cells, points and proofs"
        raise ValueError(msg)
    ranges = Ranges(points=_points(data["points"]), proofs=_proofs(data["proofs"]))
    for cell in data["cells"]:
        if (
            not isinstance(cell, list)
            or len(cell) != 2 + _NUMBERS
            or not all(isinstance(key, str) for key in cell[:2])
            or not all(isinstance(value, float) for value in cell[2:])
        ):
            msg = "the range of a cell is not row, column and three numbers"
            raise ValueError(msg)
        key = (cell[0], cell[1])
        ranges.lower[key], ranges.upper[key], ranges.joint[key] = cell[2:]
    return ranges


def _points(data: object) -> dict[str, dict[str, float]]:
    if not isinstance(data, dict) or not all(
        isinstance(point, dict) and all(isinstance(value, float) for value in point.values()) for point in data.values()
    ):
        msg = "the points of ranges are not numbers by case and input"
        raise ValueError(msg)
    return data


def _proofs(data: object) -> dict[Key, Proof]:
    if not isinstance(data, list) or not all(
        isinstance(one, list) and len(one) == 3 and all(isinstance(text, str) for text in one) and one[2] in _PROOFS
        for one in data
    ):
        msg = f"the proofs of ranges are not row, column and one of {', '.join(_PROOFS)}"
        raise ValueError(msg)
    return {(row, column): proof for row, column, proof in data}

"""How far outlines and points that are kept as marks lie apart, in fractions of their box."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from replicate.figures.digests import Array, line_waves, point_waves
from replicate.figures.scaling import finite

#: Marks are where they were up to this fraction of the axes ...
TOLERANCE = 1e-3
#: ... or this, if their place follows the size of texts.
LOOSE = 0.03

# Sums over very many lines or points: what rounding may do to them, absolute and for each unit of length or point.
_NOISE, _SHARE = 0.02, 2e-7
# The same, where one of two states was short enough to be kept, with the error that thinning makes.
_THINNED = 2e-3


def outlines_apart(one: Mapping[str, Any], other: Mapping[str, Any], tolerance: float) -> float:
    """Return how far two outlines lie apart; zero if within the tolerance, infinite if nobody can say."""
    if "points" in one and "points" in other:
        first, second = _array(one["points"]), _array(other["points"])
        if first.shape == second.shape and np.allclose(first, second, rtol=0.0, atol=tolerance / 4.0, equal_nan=True):
            return 0.0
        from replicate.figures.distance import distances

        reach = np.array([[-4.0, 5.0], [-4.0, 5.0]])
        parts = [
            part.largest
            for part in (distances(first, second, tolerance, reach), distances(second, first, tolerance, reach))
            if len(part.points)
        ]
        apart = max(parts, default=0.0)
        return apart if apart > tolerance else 0.0
    return _digests_apart(one, other, tolerance, _line_digest)


def points_apart(one: Mapping[str, Any], other: Mapping[str, Any], tolerance: float) -> float:
    """Return how far two sets of points lie apart; zero if not further than the tolerance."""
    if "points" in one and "points" in other:
        first, second = _array(one["points"]), _array(other["points"])
        if len(first) != len(second):
            return np.inf
        if not len(first) or np.allclose(first, second, rtol=0.0, atol=tolerance):
            return 0.0
        from replicate.figures.distance import point_distances

        reach = np.array([[-4.0, 5.0], [-4.0, 5.0]])
        apart = max(point_distances(first, second, reach).largest, point_distances(second, first, reach).largest)
        return apart if apart > tolerance else 0.0
    return _digests_apart(one, other, tolerance, lambda points: [float(len(points)), *point_waves(points)[1:]])


def _digests_apart(one: Mapping[str, Any], other: Mapping[str, Any], tolerance: float, digest: Any) -> float:
    kept = "points" in one or "points" in other
    waves = [
        np.asarray(digest(_array(side["points"])) if "points" in side else side["waves"], dtype=float)
        for side in (one, other)
    ]
    size = max(abs(waves[0][0]), abs(waves[1][0]), 1.0)
    allowed = _NOISE + (_THINNED if kept else _SHARE) * size
    if tolerance > TOLERANCE:
        allowed = max(allowed, tolerance * size)
    if np.abs(waves[1] - waves[0]).max() <= allowed:
        return 0.0
    if kept:
        return np.inf
    boxes = [np.asarray(side["box"], dtype=float) for side in (one, other)]
    # Sums tell that something moved, and the boxes by how much the whole did.
    return max(float(np.abs(boxes[1] - boxes[0]).max()), float(np.abs(waves[1] - waves[0]).max() / size))


def busiest(one: Mapping[str, Any], other: Mapping[str, Any]) -> tuple[float, float] | None:
    """Return where on the axes the number of lines or points changed most, if that is known."""
    if "cells" not in one or "cells" not in other:
        return None
    change = np.abs(np.asarray(other["cells"]) - np.asarray(one["cells"]))
    if change.max() < 1e-3:
        return None
    row, column = np.unravel_index(int(np.argmax(change)), change.shape)
    return (float(column) + 0.5) / change.shape[1], (float(row) + 0.5) / change.shape[0]


def _line_digest(points: Array) -> list[float]:
    there = finite(points)
    both = there[:-1] & there[1:]
    return [float(value) for value in line_waves(points[:-1][both], points[1:][both])]


def _array(points: Sequence[Sequence[float] | None]) -> Array:
    return np.array([[np.nan, np.nan] if point is None else point for point in points], dtype=float).reshape(-1, 2)

"""How far two curves in the plane lie apart, however their points are chosen.

The distance of a curve from another is the largest distance of any of its points, vertex or not, from the
other's polyline (the directed Hausdorff distance, taken in both directions). It does not change when points
are added or left out along a straight piece, so re-sampled or re-thinned curves do not differ. A break (a
point that is not finite) ends a polyline. Scattered points are compared as sets.

Everything is in fractions of the axes; only what is in view is measured, with everything to measure it by.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.figures.contours import uncovered
from replicate.figures.polylines import Points, distance_to_segments
from replicate.figures.scaling import TOLERANCE, finite

Array = NDArray[np.float64]

# Points on long segments that are measured as well; what happens between two of them is smaller than this.
_STEP = 2e-3
_CHUNK = 64
# So far out of view a marker may still reach into it.
_REACH = 0.1


def nearest(points: Points, targets: Points) -> tuple[Array, NDArray[np.intp]]:
    """Return the distance of each point from the nearest of others, and which that is."""
    from scipy.spatial import KDTree  # as slow to import as everything else together, and most figures do not differ

    distance, index = KDTree(targets).query(points)
    return np.asarray(distance, dtype=float), np.asarray(index)


@dataclass(frozen=True)
class Distances:
    """Distances of points along one curve from another curve: where, and how far."""

    points: Points
    distance: Array

    @property
    def largest(self) -> float:
        """The largest distance; infinite if there is nothing to measure by."""
        return float(self.distance.max(initial=0.0))

    @property
    def place(self) -> Points:
        """Where the distance is largest, shape (2,)."""
        return np.asarray(self.points[int(np.argmax(self.distance))])


def distances(
    one: Points,
    other: Points,
    exact_above: float,
    view: Array | None = None,
    covered: Sequence[Sequence[float]] = (),
) -> Distances:
    """Return the distances of the points of one polyline from another one.

    Parameters
    ----------
    one, other
        Shape (n, 2) and (m, 2).
    exact_above
        The largest distance is exact if it is above this. All others may be given a little too large.
    view
        ``[[left, right], [bottom, top]]``: only points inside are measured; by default the axes.
    covered
        Ellipses inside which points are not measured, as in `replicate.figures.contours.uncovered`.

    Examples
    --------
    >>> import numpy as np
    >>> line = np.array([[0.0, 0.0], [1.0, 1.0]])
    >>> finer = np.array([[0.0, 0.0], [0.3, 0.3], [1.0, 1.0]])
    >>> distances(line, finer, 1e-4).largest < 1e-4
    True
    >>> gap = np.array([[0.0, 0.0], [0.3, 0.3], [np.nan, np.nan], [0.7, 0.7], [1.0, 1.0]])
    >>> round(distances(line, gap, 1e-4).largest, 3)  # half of the gap, away from its ends
    0.283
    """
    points = uncovered(_in_view(_dense(one)[0], view), covered)
    starts, ends = _segments(other)
    if not len(points) or not len(starts):
        return Distances(points, np.full(len(points), np.inf))
    # The nearest of the points along the other curve names a segment, and its distance bounds the true one.
    along, segment = _dense(other)
    near = segment[nearest(points, along)[1]]
    distance = to_own_segment(points, starts[near], ends[near])
    # Of those that matter the furthest first, until no bound is left that exceeds the largest true distance.
    order = np.argsort(-distance, kind="stable")
    largest = exact_above
    for first in range(0, len(order), _CHUNK):
        chunk = order[first : first + _CHUNK]
        if distance[chunk[0]] <= largest:
            break
        distance[chunk] = distance_to_segments(points[chunk], starts, ends).min(axis=1)
        largest = max(largest, float(distance[chunk].max()))
    return Distances(points, distance)


def exact_distances(found: Distances, other: Points) -> Array:
    """Return the exact distance of every one of the points that were measured, for a picture of them."""
    starts, ends = _segments(other)
    if not len(starts):
        return found.distance
    chunks = [found.points[first : first + _CHUNK] for first in range(0, len(found.points), _CHUNK)]
    return np.concatenate([distance_to_segments(chunk, starts, ends).min(axis=1) for chunk in chunks])


def point_distances(one: Points, other: Points, view: Array | None = None) -> Distances:
    """Return the distance of every point of one set from the nearest of another."""
    points, targets = _in_view(one[finite(one)], view), other[finite(other)]
    if not len(points) or not len(targets):
        return Distances(points, np.full(len(points), np.inf))
    return Distances(points, nearest(points, targets)[0])


def point_counts(one: Points, other: Points, view: Array) -> tuple[int, int]:
    """Return how many points of two sets can be seen; the same number where rounding decides of which they can.

    Examples
    --------
    >>> import numpy as np
    >>> view = np.array([[0.0, 1.0], [0.0, 1.0]])
    >>> points = np.array([[0.5, 0.5], [0.2, 0.9], [7.0, 0.5]])
    >>> point_counts(points, points[:1], view), point_counts(points, points[:2], view)
    ((2, 1), (2, 2))
    """
    margins = (_REACH, _REACH + TOLERANCE)
    first, second = (
        [len(_in_view(side, view + margin * np.array([-1.0, 1.0]))) for margin in margins] for side in (one, other)
    )
    same = first[0] <= second[1] and second[0] <= first[1]
    return first[0], first[0] if same else second[0]


def _in_view(points: Points, view: Array | None) -> Points:
    low, high = (np.zeros(2), np.ones(2)) if view is None else np.asarray(view).T
    return points[np.logical_and.reduce((points >= low) & (points <= high), axis=1)]


def _segments(points: Points) -> tuple[Points, Points]:
    """Return start and end of every segment; a lone point between breaks is one of length zero."""
    there = finite(points)
    joined = there[:-1] & there[1:]
    alone = there & ~np.r_[False, joined] & ~np.r_[joined, False]
    return np.vstack([points[:-1][joined], points[alone]]), np.vstack([points[1:][joined], points[alone]])


def _dense(points: Points) -> tuple[Points, NDArray[np.intp]]:
    """Return points along every segment, ends included, and the number of the segment each lies on."""
    starts, ends = _segments(points)
    length = np.linalg.norm(ends - starts, axis=1)
    # What is far out of view is not worth many points.
    count = np.clip(np.ceil(length / _STEP), 1, int(3.0 / _STEP)).astype(int) + 1
    segment = np.repeat(np.arange(len(starts)), count)
    place = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    share = place / np.repeat(count - 1, count)
    return starts[segment] + share[:, None] * (ends - starts)[segment], segment


def to_own_segment(points: Points, starts: Points, ends: Points) -> Array:
    """Return the distance of each point to a segment of its own."""
    along = ends - starts
    squared = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", points - starts, along) / np.where(squared > 0.0, squared, 1.0)
    nearest = starts + np.clip(share, 0.0, 1.0)[:, None] * along
    return np.asarray(np.linalg.norm(points - nearest, axis=1))

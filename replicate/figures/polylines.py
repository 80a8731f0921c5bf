"""Thinning of a polyline with a bounded error.

The algorithm is that of Ramer (1972) and Douglas and Peucker (1973): keep the end points, and as long as some
point lies too far from the chord that replaces it, keep that point as well. Splitting the worst chord first
spends a limited number of points where they matter most.

References
----------
Ramer, "An iterative procedure for the polygonal approximation of plane curves", Computer Graphics and Image
Processing 1(3), 1972. Douglas and Peucker, Cartographica 10(2), 1973.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
_Chord = tuple[float, int, int, int]  # minus the largest distance, start, index of the point that far off, end

#: Of the curves that are stored, a dropped point lies within this fraction of the axes from the thinned curve.
THINNING = 5e-5


def simplify(points: Points, tolerance: float, most: int) -> tuple[NDArray[np.intp], float]:
    """Return the indices of the points to keep, and how far the others lie from what is left.

    Parameters
    ----------
    points
        Shape (n, 2), finite, in units in which a distance of 1 means the same in both directions.
    tolerance
        No dropped point is further than this from the polyline through the kept ones, unless `most` is
        reached.
    most
        Upper limit on the number of points kept, at least 2.

    Returns
    -------
    kept
        Increasing indices; the first and the last point are always among them.
    error
        The largest distance of a dropped point from its chord.

    Examples
    --------
    >>> import numpy as np
    >>> corner = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0]])
    >>> kept, error = simplify(corner, 1e-6, 100)
    >>> kept.tolist(), error
    ([0, 2, 4], 0.0)
    """
    last = len(points) - 1
    if last < 2:
        return np.arange(last + 1), 0.0
    kept = {0, last}
    # Ties are broken by position, so the choice does not depend on the order in which chords were split.
    heap = _worst(points, [(0, last)])
    halves: dict[_Chord, list[_Chord]] = {}
    while heap and len(kept) < most and -heap[0][0] > tolerance:
        chord = heapq.heappop(heap)
        kept.add(chord[2])
        if chord not in halves:  # with those that will probably follow: many at once cost hardly more than one
            halves |= _halves(points, [chord, *(one for one in heap if -one[0] > tolerance and one not in halves)])
        for half in halves.pop(chord):
            heapq.heappush(heap, half)
    return np.array(sorted(kept)), -heap[0][0] if heap else 0.0


def _halves(points: Points, chords: Sequence[_Chord]) -> dict[_Chord, list[_Chord]]:
    """Return the two parts into which the worst point cuts each chord, without those that replace no point."""
    parts = [
        [(low, high) for low, high in ((start, split), (split, end)) if high - low > 1]
        for _, start, split, end in chords
    ]
    worst = iter(_worst(points, [part for both in parts for part in both]))
    return {chord: [next(worst) for _ in both] for chord, both in zip(chords, parts, strict=True)}


def _worst(points: Points, chords: Sequence[tuple[int, int]]) -> list[_Chord]:
    """Return (minus the largest distance from the chord, start, index of that point, end) of every chord."""
    if not chords:
        return []
    starts, ends = np.array(chords).T
    inner = ends - starts - 1
    first = np.cumsum(inner) - inner
    whose = np.repeat(np.arange(len(chords)), inner)
    index = np.arange(len(whose)) + (starts + 1 - first)[whose]
    along = points[ends] - points[starts]
    squared = np.einsum("ij,ij->i", along, along)
    squared[squared == 0.0] = 1.0
    x, y = (points[index] - points[starts[whose]]).T
    across, up = along[whose].T
    fraction = ((x * across + y * up) / squared[whose]).clip(0.0, 1.0)
    distance = np.sqrt((x - fraction * across) ** 2 + (y - fraction * up) ** 2)
    largest = np.maximum.reduceat(distance, first)
    at = np.flatnonzero(distance == largest[whose])
    split = index[at[np.searchsorted(at, first)]]
    return list(zip((-largest).tolist(), starts.tolist(), split.tolist(), ends.tolist(), strict=True))


def distance_to_segments(points: Points, starts: Points, ends: Points) -> Points:
    """Return the Euclidean distance of every point to every segment.

    Parameters
    ----------
    points
        Shape (n, 2). starts, ends: shape (m, 2); a segment of length zero is a point.

    Returns
    -------
    ndarray
        Shape (n, m).
    """
    along = ends - starts
    squared = np.einsum("ij,ij->i", along, along)
    offset = points[:, None, :] - starts[None, :, :]
    projection = np.einsum("nmj,mj->nm", offset, along)
    fraction = np.clip(projection / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(offset - fraction[..., None] * along, axis=-1))

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

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

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
    heap = [_worst(points, 0, last)]
    while heap and len(kept) < most and -heap[0][0] > tolerance:
        _, start, split, end = heapq.heappop(heap)
        kept.add(split)
        for low, high in ((start, split), (split, end)):
            if high - low > 1:
                heapq.heappush(heap, _worst(points, low, high))
    return np.array(sorted(kept)), -heap[0][0] if heap else 0.0


def _worst(points: Points, start: int, end: int) -> tuple[float, int, int, int]:
    """Return (minus the largest distance from the chord, start, index of that point, end)."""
    inner = points[start + 1 : end]
    distance = distance_to_segments(inner, points[start : start + 1], points[end : end + 1])[:, 0]
    worst = int(np.argmax(distance))
    return -float(distance[worst]), start, start + 1 + worst, end


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

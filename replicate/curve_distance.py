"""How far two curves lie apart, however their points are chosen.

The distance of a curve from another is the largest distance of any of its points from the other's polyline
(the directed Hausdorff distance, taken in both directions). It does not change when points are added or left
out along a straight piece, so re-sampled or re-thinned curves do not differ. A break (a point that is not
finite) ends a polyline.
"""

from __future__ import annotations

import numpy as np

from replicate.simplify import Points, distance_to_segments


def curve_distance(one: Points, other: Points) -> tuple[float, int]:
    """Return the distance of two curves, and where on the first it occurs.

    Parameters
    ----------
    one, other
        Shape (n, 2) and (m, 2), in units in which a distance of 1 means the same in both directions.

    Returns
    -------
    distance
        Infinite if just one of the curves has no points.
    index
        Of the point of `one` that is furthest away (or nearest to the point of `other` that is).

    Examples
    --------
    >>> import numpy as np
    >>> line = np.array([[0.0, 0.0], [1.0, 1.0]])
    >>> finer = np.array([[0.0, 0.0], [0.3, 0.3], [1.0, 1.0]])
    >>> curve_distance(line, finer)[0] < 1e-15
    True
    >>> curve_distance(line, finer + [0.0, 0.1])[0] < 0.1
    False
    """
    one_points = np.isfinite(one).all(axis=1)
    other_points = np.isfinite(other).all(axis=1)
    if not one_points.any() or not other_points.any():
        return (0.0 if one_points.any() == other_points.any() else np.inf), 0
    forward = _to_polyline(one[one_points], other)
    backward = _to_polyline(other[other_points], one)
    if forward.max() >= backward.max():
        return float(forward.max()), int(np.flatnonzero(one_points)[forward.argmax()])
    furthest = other[other_points][backward.argmax()]
    nearest = int(np.nanargmin(np.linalg.norm(one - furthest, axis=1)))
    return float(backward.max()), nearest


def _to_polyline(points: Points, line: Points) -> Points:
    """Return the distance of every point to a polyline that may have breaks."""
    finite = np.logical_and.reduce(np.isfinite(line), axis=1)
    joined = finite[:-1] & finite[1:]
    # Every point also as a segment of length zero: a lone point between breaks is part of the curve.
    starts = np.vstack([line[:-1][joined], line[finite]])
    ends = np.vstack([line[1:][joined], line[finite]])
    return np.asarray(distance_to_segments(points, starts, ends).min(axis=1))

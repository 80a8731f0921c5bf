"""What is drawn, as outlines in fractions of a box: kept point by point if short, as a digest if long."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from replicate.figures.digests import line_waves, point_waves, rounded
from replicate.figures.polylines import Points, simplify
from replicate.figures.scaling import finite

#: More points than this, all of a mark together, become a digest.
MOST_POINTS = 120

#: Far less than a pixel.
OUTLINE_TOLERANCE = 2e-4
_DECIMALS = 5
_CELLS = 8
_CHORDS = 16
_BREAK = np.array([[np.nan, np.nan]])
_ALONG = np.linspace(0.0, 1.0, _CHORDS + 1)[1:]
_END = np.array([1.0])
_FAR = 3.0


def flattened(path: Path) -> Points:
    """Return the vertices of a path, curves as chords, with a break between its pieces."""
    if path.codes is None:
        return np.asarray(path.vertices, dtype=float)
    if not np.isin(path.codes, (Path.CURVE3, Path.CURVE4)).any():
        return _straight(path)
    pieces: list[list[Points]] = []
    segments: Any = path.iter_bezier(simplify=False)
    for segment, code in segments:
        if code == Path.MOVETO:
            pieces.append([segment.control_points[:1]])
        else:
            pieces[-1].append(segment(_ALONG if code in {Path.CURVE3, Path.CURVE4} else _END))
    return joined([np.vstack(piece) for piece in pieces])


def _straight(path: Path) -> Points:
    vertices: Points = np.array(path.vertices, dtype=float)
    codes: NDArray[np.int_] = np.asarray(path.codes, dtype=int)
    starts = np.flatnonzero(codes == Path.MOVETO)
    firsts = starts[np.maximum(np.cumsum(codes == Path.MOVETO) - 1, 0)]
    closing = codes == Path.CLOSEPOLY
    vertices[closing] = vertices[firsts[closing]]
    vertices = vertices[codes != Path.STOP]
    breaks = starts[(starts > 0) & (starts < len(vertices))]
    return np.asarray(np.insert(vertices, breaks, np.nan, axis=0))


def joined(pieces: Sequence[Points]) -> Points:
    """Put pieces one after the other, with a break between them."""
    separated = [part for piece in pieces if len(piece) for part in (_BREAK, piece)]
    return np.vstack(separated[1:]) if separated else np.empty((0, 2))


def outline(points: Points, most: int = MOST_POINTS, tolerance: float = OUTLINE_TOLERANCE) -> dict[str, Any]:
    """Describe lines or the edges of areas.

    Parameters
    ----------
    points
        Shape (n, 2) in box units; a row that is not finite is a break. What lies further than a few boxes away is
        moved to where it is just as invisible.
    """
    points = _within_reach(points)
    there = finite(points)
    edges = np.flatnonzero(np.diff(np.r_[False, there, False].astype(int)))
    runs = [points[start:end] for start, end in zip(edges[::2], edges[1::2], strict=True)]
    if not runs:
        return {"points": []}
    if len(runs) <= most // 2:
        thin, error = [], 0.0
        for run in runs:
            kept, distance = simplify(run, tolerance, most) if len(run) > 2 else (np.arange(len(run)), 0.0)
            thin.append(run[kept])
            error = max(error, distance)
        if error <= tolerance and sum(map(len, thin)) <= most:
            return {"points": _written(joined(thin))}
    both = there[:-1] & there[1:]
    waves = line_waves(points[:-1][both], points[1:][both])
    return {"pieces": len(runs), **_place(points[there]), "waves": rounded(waves, 10)}


def _within_reach(points: Points) -> Points:
    """Move what lies far outside to an edge; lines that lead there keep their direction up to that edge."""
    low, high = -_FAR, 1.0 + _FAR
    reached = np.clip(points, low, high)
    if np.array_equal(reached, points, equal_nan=True):
        return reached
    starts, steps = points[:-1], np.diff(points, axis=0)
    with np.errstate(all="ignore"):
        shares = np.hstack([(edge - starts) / steps for edge in (low, high)])
        shares = np.sort(np.where((shares > 0.0) & (shares < 1.0), shares, np.nan), axis=1)
        crossings = starts[:, None] + shares[..., None] * steps[:, None]
    kept = np.hstack([np.ones((len(starts), 1), dtype=bool), np.isfinite(shares)])
    along = np.concatenate([starts[:, None], crossings], axis=1)[kept]
    return np.asarray(np.clip(np.vstack([along, points[-1:]]), low, high))


def scattered(points: Points, most: int = MOST_POINTS) -> dict[str, Any]:
    """Describe single points; those that have no place are left out."""
    points = points[finite(points)]
    points = points[(np.abs(points - 0.5) <= _FAR).all(axis=1)]
    if len(points) <= most:
        return {"points": _written(points)}
    return {"pieces": len(points), **_place(points), "waves": rounded(point_waves(points), 10)}


def _place(points: Points) -> dict[str, Any]:
    """Say where many points are: their box, and how many lie in each cell of a coarse grid over the axes."""
    seen = np.clip(points, 0.0, 1.0)
    counts, _, _ = np.histogram2d(seen[:, 1], seen[:, 0], bins=_CELLS, range=((0.0, 1.0), (0.0, 1.0)))
    share = counts / max(len(points), 1)
    box = np.concatenate([points.min(axis=0), points.max(axis=0)])
    return {"box": rounded(box), "cells": [[round(float(value), 4) for value in row] for row in share]}


def _written(points: NDArray[np.float64]) -> list[list[float] | None]:
    plain = finite(points)
    return [
        [round(float(x), _DECIMALS) + 0.0, round(float(y), _DECIMALS) + 0.0] if there else None
        for (x, y), there in zip(points, plain, strict=True)
    ]

"""How far integrals of piecewise polynomials move: sums of differences between the zeros of their slopes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev, series_roots
from replicate.loops.time_domain.piecewise import MARGIN, SAMPLES

Array = NDArray[np.float64]
Pieces = NDArray[np.intp]

NEGLIGIBLE = 1e-14  # share of all that moves which pieces together may have whose zeros are not looked for


def ups_and_downs(slopes: Array, integrals: Array, scales: Array | float = 1.0) -> float:
    """Return how far integrals move up and down on all pieces together.

    Parameters
    ----------
    slopes
        Chebyshev series, one row per piece, with the signs of the integrals' slopes.
    integrals
        Chebyshev series, one row per piece.
    scales
        How far the integral of a piece moves at most where its row of `slopes` is 1.
    """
    samples = slopes @ chebyshev.evaluation(slopes.shape[1] - 1, SAMPLES)
    low, high, slack = samples.min(axis=1), samples.max(axis=1), MARGIN * np.ptp(samples, axis=1)
    sizes = np.maximum(high, -low) * scales
    # what all small pieces together add is below rounding
    counts = sizes * sizes.size > NEGLIGIBLE * np.sum(sizes)
    signed = (low - slack < 0.0) & (high + slack > 0.0) & counts
    pieces = np.nonzero(signed)[0]
    owners, roots = _zeros(slopes, samples, pieces)
    # between neighbouring zeros an antiderivative moves one way
    starts, ends = integrals @ (-1.0) ** np.arange(integrals.shape[1]), integrals.sum(axis=1)
    moves = np.abs(ends - starts)
    if owners.size:
        values = series_roots.evaluate(integrals[owners].T, roots)
        last = np.append(owners[1:] != owners[:-1], True)
        first = np.append(True, last[:-1])
        moves[owners[first]] = np.abs(values[first] - starts[owners[first]])
        moves[owners[last]] += np.abs(ends[owners[last]] - values[last])
        return float(np.sum(moves) + np.sum(np.abs(np.diff(values))[~last[:-1]]))
    return float(np.sum(moves))


def _zeros(slopes: Array, samples: Array, pieces: Pieces) -> tuple[Pieces, Array]:
    """Return the zeros in some pieces, as piece numbers and local coordinates, each between points of opposite sign.

    The points are the samples, and the extrema so close to zero that they may hide two zeros between samples.
    """
    part, nodes = samples[pieces], chebyshev.nodes(SAMPLES - 1)
    moves = np.diff(part, axis=1)
    turns = moves[:, 1:] * moves[:, :-1] <= 0.0
    row, column = np.nonzero(turns & (np.abs(part[:, 1:-1]) < MARGIN * np.ptp(part, axis=1)[:, None]))
    owners, points, values = np.repeat(pieces, SAMPLES), np.tile(nodes, pieces.size), part.ravel()
    if row.size:
        series = slopes[pieces[row]].T
        extreme = series_roots.maxima(np.sign(moves[row, column]) * series, nodes[column], nodes[column + 2])
        owners, points = np.concatenate([owners, pieces[row]]), np.concatenate([points, extreme])
        values = np.concatenate([values, series_roots.evaluate(series, extreme)])
        order = np.lexsort((points, owners))
        owners, points, values = owners[order], points[order], values[order]
    left = np.nonzero(((values[:-1] < 0.0) != (values[1:] < 0.0)) & (owners[:-1] == owners[1:]))[0]
    right, owners = left + 1, owners[left]
    return owners, series_roots.roots(slopes[owners].T, points[left], points[right], values[left], values[right])

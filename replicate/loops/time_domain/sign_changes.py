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
    rest = np.arange(sizes.size)
    owners = np.concatenate([rest, owners, rest])
    points = np.concatenate([np.full(rest.size, -1.0), roots, np.full(rest.size, 1.0)])
    order = np.lexsort((points, owners))
    owners, points = owners[order], points[order]
    values = series_roots.evaluate(integrals[owners].T, points)
    same = owners[1:] == owners[:-1]
    return float(np.sum(np.abs(np.diff(values))[same]))


def _zeros(slopes: Array, samples: Array, pieces: Pieces) -> tuple[Pieces, Array]:
    """Return the zeros in some pieces, as piece numbers and local coordinates.

    Zeros between samples of opposite sign are found all at once; pieces with an extremum so close to zero that it may
    hide two zeros between samples go through the companion matrix.
    """
    part = samples[pieces]
    differences = np.diff(part, axis=1)
    turns = differences[:, 1:] * differences[:, :-1] <= 0.0
    hidden = np.any(turns & (np.abs(part[:, 1:-1]) < MARGIN * np.ptp(part, axis=1)[:, None]), axis=1)
    rows, columns = np.nonzero((part[:, :-1] < 0.0) != (part[:, 1:] < 0.0))
    clear = ~hidden[rows]
    rows, columns = rows[clear], columns[clear]
    nodes = chebyshev.nodes(SAMPLES - 1)
    owners = pieces[rows]
    found = series_roots.roots(
        slopes[owners].T, nodes[columns], nodes[columns + 1], part[rows, columns], part[rows, columns + 1]
    )
    slow = [(piece, chebyshev.real_roots(slopes[piece])) for piece in pieces[hidden]]
    owners = np.concatenate([owners, *(np.full(roots.size, piece, dtype=np.intp) for piece, roots in slow)])
    return owners, np.concatenate([found, *(roots for _, roots in slow)])

"""The pieces of a block as Chebyshev series in columns, their samples, and extrema next to samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev, series_roots

Array = NDArray[np.float64]
Places = NDArray[np.intp]

DEGREE = 14  # of a piece: lower than for single loops, because most of the work grows with its square
DENSE = 32  # samples of a piece, Lobatto points too


def dense_nodes() -> Array:
    """Return the coordinates of the samples, ascending from -1 to 1."""
    return chebyshev.nodes(DENSE - 1)


def samples(coefficients: Array) -> Array:
    """Return the values of series, in columns, at the dense nodes."""
    return np.asarray(chebyshev.evaluation(DEGREE, DENSE).T @ coefficients)


def series(values: Array) -> Array:
    """Return Chebyshev coefficients in columns."""
    return np.asarray(chebyshev.values_to_coefficients(DEGREE) @ values)


def sharpened(
    coefficients: Array, nodes: Array, values: Array, chosen: NDArray[np.bool_], sign: Array
) -> tuple[Array, Array]:
    """Return coordinates and values of samples, those chosen moved to the extremum next to them.

    ``sign`` is +1 where a maximum is meant and -1 where a minimum is; all have the shape of the samples.
    """
    at, column = np.nonzero(chosen)
    if at.size == 0:
        return nodes, values
    x, values = nodes.copy(), values.copy()
    series, last = coefficients[:, column], values.shape[0] - 1
    found = series_roots.maxima(
        series * sign[at, column], nodes[np.maximum(at - 1, 0), column], nodes[np.minimum(at + 1, last), column]
    )
    x[at, column], values[at, column] = found, series_roots.evaluate(series, found)
    return x, values

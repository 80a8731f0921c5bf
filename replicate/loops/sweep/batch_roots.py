"""Roots and extrema of many Chebyshev series at once, one in each column, each in a bracket of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops import chebyshev

Array = NDArray[np.float64]
Places = NDArray[np.intp]

DEGREE = 14  # of a piece: lower than for single loops, because most of the work grows with its square
DENSE = 32  # samples of a piece, Lobatto points too
STEPS = 4
CONVERGED = 1e-6  # last step of Newton's method, after which the next would be rounding


def dense_nodes() -> Array:
    """Return the coordinates of the samples, ascending from -1 to 1."""
    return chebyshev.nodes(DENSE - 1)


def samples(coefficients: Array) -> Array:
    """Return the values of series, in columns, at the dense nodes."""
    return np.asarray(chebyshev.evaluation(DEGREE, DENSE).T @ coefficients)


def series(values: Array) -> Array:
    """Return Chebyshev coefficients in columns."""
    return np.asarray(chebyshev.values_to_coefficients(DEGREE) @ values)


def slopes(coefficients: Array) -> Array:
    """Return the coefficients of the derivatives."""
    return np.asarray(chebyshev.differentiation(coefficients.shape[0] - 1).T @ coefficients)


def evaluate(coefficients: Array, x: Array) -> Array:
    """Evaluate the series in each column at its own point, by Clenshaw's recurrence."""
    twice = x + x
    ahead, after = np.zeros_like(x), np.zeros_like(x)
    for row in coefficients[:0:-1]:
        following = twice * ahead
        following -= after
        following += row
        ahead, after = following, ahead
    return np.asarray(coefficients[0] + x * ahead - after)


def roots(coefficients: Array, left: Array, right: Array, at_left: Array, at_right: Array) -> Array:
    """Return the root of each series between two points at which it has the given values of opposite sign.

    Newton's method from the secant's root, kept inside a bracket that shrinks; where it has not converged, bisection.
    """
    low, high, sign = left.copy(), right.copy(), np.sign(at_left)
    with np.errstate(all="ignore"):
        x = left - at_left * (right - left) / (at_right - at_left)
    x = np.where(np.isfinite(x), x, 0.5 * (left + right))
    slope = slopes(coefficients)
    moving = np.arange(x.size)
    part, part_slope = coefficients, slope
    for _ in range(60):
        at = x[moving]
        value, steepness = evaluate(part, at), evaluate(part_slope, at)
        below = np.sign(value) == sign[moving]
        low[moving], high[moving] = np.where(below, at, low[moving]), np.where(below, high[moving], at)
        with np.errstate(all="ignore"):
            following = at - value / steepness
        inside = (following >= low[moving]) & (following <= high[moving])
        following = np.where(inside, following, 0.5 * (low[moving] + high[moving]))
        x[moving] = following
        on = np.abs(following - at) > CONVERGED
        if not on.any():
            break
        if on.sum() < 0.7 * on.size:
            moving = moving[on]
            part, part_slope = coefficients[:, moving], slope[:, moving]
    return x


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
    found = maxima(
        series * sign[at, column], nodes[np.maximum(at - 1, 0), column], nodes[np.minimum(at + 1, last), column]
    )
    x[at, column], values[at, column] = found, evaluate(series, found)
    return x, values


def maxima(coefficients: Array, left: Array, right: Array) -> Array:
    """Return where each series is stationary between two points; an end where its slope does not change sign."""
    slope = slopes(coefficients)
    at_left, at_right = evaluate(slope, left), evaluate(slope, right)
    x = np.where(at_left <= 0.0, left, right)
    inside = np.nonzero((at_left > 0.0) & (at_right < 0.0))[0]
    if inside.size:
        x[inside] = roots(slope[:, inside], left[inside], right[inside], at_left[inside], at_right[inside])
    return x

"""Roots and extrema of many Chebyshev series at once, one in each column, each in a bracket of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev

Array = NDArray[np.float64]

STEPS = 60  # most steps of Newton's method; bisection alone needs no more
CONVERGED = 1e-9  # last step of Newton's method, after which the next would be far below rounding
MOST = 0.7  # share of the points that still move above which it does not pay to leave the others out
FEW = 64  # series whose polynomials are evaluated as cosines; for more, a recurrence is quicker


def slopes(series: Array) -> Array:
    """Return the coefficients of the derivatives."""
    return np.asarray(chebyshev.differentiation(series.shape[0] - 1).T @ series)


def evaluate(series: Array, x: Array) -> Array:
    """Evaluate the series in each column at its own point, as cosines or by Clenshaw's recurrence."""
    if x.size <= FEW:
        return _sum(series, chebyshev.cosines(x, series.shape[0] - 1))
    twice = x + x
    ahead, after = np.zeros_like(x), np.zeros_like(x)
    for row in series[:0:-1]:
        following = twice * ahead
        following -= after
        following += row
        ahead, after = following, ahead
    return np.asarray(series[0] + x * ahead - after)


def _sum(series: Array, polynomials: Array) -> Array:
    return np.asarray(np.einsum("kp,kp->p", series, polynomials))


def _with_slopes(series: Array, slope: Array, x: Array) -> tuple[Array, Array]:
    if x.size > FEW:
        return evaluate(series, x), evaluate(slope, x)
    polynomials = chebyshev.cosines(x, series.shape[0] - 1)
    return _sum(series, polynomials), _sum(slope, polynomials[:-1])


def roots(
    series: Array, left: Array, right: Array, at_left: Array, at_right: Array, *, converged: float = CONVERGED
) -> Array:
    """Return the root of each series between two points at which it has the given values of opposite sign.

    Newton's method from the secant's root, kept inside a bracket that shrinks; where it has not converged, bisection.
    ``converged`` is the last step of Newton's method.
    """
    x = np.empty_like(left)
    with np.errstate(all="ignore"):
        at = left - at_left * (right - left) / (at_right - at_left)
        at = np.where(np.isfinite(at), at, 0.5 * (left + right))
        slope, sign, places = slopes(series), np.sign(at_left), np.arange(x.size)
        low, high = left, right
        for _ in range(STEPS):
            value, steepness = _with_slopes(series, slope, at)
            below = np.sign(value) == sign
            low, high = np.where(below, at, low), np.where(below, high, at)
            following = at - value / steepness
            following = np.where((following >= low) & (following <= high), following, 0.5 * (low + high))
            on = np.abs(following - at) > converged
            at = following
            moving = int(np.count_nonzero(on))
            if moving == 0:
                break
            if moving < MOST * on.size:
                x[places] = at
                places, at, low, high, sign = places[on], at[on], low[on], high[on], sign[on]
                series, slope = series[:, on], slope[:, on]
    x[places] = at
    return x


def maxima(series: Array, left: Array, right: Array, *, converged: float = CONVERGED) -> Array:
    """Return where each series is stationary between two points; an end where its slope does not change sign."""
    slope = slopes(series)
    at_left, at_right = evaluate(slope, left), evaluate(slope, right)
    x = np.where(at_left <= 0.0, left, right)
    inside = np.nonzero((at_left > 0.0) & (at_right < 0.0))[0]
    if inside.size:
        x[inside] = roots(
            slope[:, inside], left[inside], right[inside], at_left[inside], at_right[inside], converged=converged
        )
    return x

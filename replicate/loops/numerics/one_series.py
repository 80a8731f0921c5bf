"""One Chebyshev series at one point after the other: for a few of them quicker than arrays of all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev

Array = NDArray[np.float64]

STEPS = 60  # most steps of Newton's method; bisection alone needs no more
CONVERGED = 1e-9  # last step of Newton's method, after which the next would be far below rounding


def value(series: list[float], x: float) -> float:
    """Evaluate a series by Clenshaw's recurrence."""
    twice, ahead, after = x + x, 0.0, 0.0
    for coefficient in series[:0:-1]:
        ahead, after = twice * ahead - after + coefficient, ahead
    return series[0] + x * ahead - after


def slope(series: list[float]) -> list[float]:
    """Return the coefficients of the derivative, as many as those of the series; the last is zero."""
    found = [0.0] * (len(series) + 1)
    for k in range(len(series) - 1, 0, -1):
        found[k - 1] = found[k + 1] + 2.0 * k * series[k]
    found[0] *= 0.5
    return found[:-1]


def root(series: list[float], left: float, right: float) -> float:
    """Return the root of a series between two points at which it has opposite signs, to rounding.

    Newton's method from the secant's root, kept inside a bracket that shrinks; where it has not converged, bisection.
    """
    steepness, at_left, at_right = slope(series), value(series, left), value(series, right)
    if at_left == at_right:
        return 0.5 * (left + right)
    at = min(max(left - at_left * (right - left) / (at_right - at_left), left), right)
    for _ in range(STEPS):
        here, steep = value(series, at), value(steepness, at)
        if (here < 0.0) == (at_left < 0.0):
            left = at
        else:
            right = at
        following = at - here / steep if steep else left - 1.0
        if not left <= following <= right:
            following = 0.5 * (left + right)
        step, at = abs(following - at), following
        if step <= CONVERGED:
            break
    return at


def roots(series: Array, samples: Array, margin: float) -> Array:
    """Return the roots of a series in [-1, 1], ascending.

    Parameters
    ----------
    series
        Its coefficients.
    samples
        Its values at Lobatto nodes, ascending.
    margin
        How far an extremum may exceed the samples beside it, as a share of the range of all.
    """
    small, moves = np.abs(samples) <= margin * np.ptp(samples), np.diff(samples)
    # an extremum so close to zero may hide two roots between samples
    if small[0] or small[-1] or (small[1:-1] & (moves[1:] * moves[:-1] <= 0.0)).any():
        return chebyshev.real_roots(series)
    nodes, coefficients = chebyshev.nodes(samples.size - 1).tolist(), series.tolist()
    left = np.nonzero((samples[:-1] < 0.0) != (samples[1:] < 0.0))[0].tolist()
    return np.array([root(coefficients, nodes[i], nodes[i + 1]) for i in left])


def maximum(series: list[float], left: float, right: float) -> float:
    """Return where a series is stationary between two points; an end where its slope does not change sign."""
    steepness = slope(series)
    if value(steepness, left) <= 0.0:
        return left
    return root(steepness, left, right) if value(steepness, right) < 0.0 else right

r"""Stability of many loops at once, by the argument principle over their gain crossovers.

The same count as `replicate.loops.stability`: between two gain crossovers the change of the argument of
:math:`f = D (1 + L) = N e^{-sL} (1 + 1/L)` is known in closed form. What cannot be decided here with certainty, because
crossovers nearly touch or the curve nearly passes through -1, is left to the single loop.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.sweep.loop_columns import LoopColumns

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Flags = NDArray[np.bool_]

REAL = 1e-8  # imaginary part, relative to the modulus, of a root in w^2 that is real
DOUBTFUL = 1e-3  # and below which it may be one of a double root
CLEAR = 1e-4  # distance of L from -1 at a crossover that leaves no doubt; of |L| at rest from one
UNSTABLE, STABLE, UNDECIDED = 0, 1, 2


def stability(loops: LoopColumns) -> tuple[NDArray[np.int8], Array]:
    """Return for each loop UNSTABLE, STABLE or UNDECIDED, and the gain crossovers.

    The crossovers have shape (most, n), ascending; ``inf`` where a loop has fewer.
    """
    crossovers, doubtful = gain_crossovers(loops)
    poles, shared = loops.poles, loops.zeros
    own, lost = _controller_roots(loops.controller_zeros)
    doubtful |= lost
    most = crossovers.shape[0]
    finite = np.isfinite(crossovers)
    w = np.where(finite, crossovers, 1.0)
    value = loops.value(1j * w)
    doubtful |= np.any(finite & (np.abs(1.0 + value) < CLEAR), axis=0)
    principal = np.angle(1.0 + value)  # where |L| = 1 the argument of 1 + 1/L is the opposite
    small_side = _argument(poles, w) + principal
    right = np.where(own.real > 0.0, 1.0, 0.0)
    large_side = _argument(shared, w) - w - principal
    for zero, is_right in zip(own, right, strict=True):
        large_side += _own_argument(zero, is_right, w)
    # at rest
    at_rest = loops.num[-1] / loops.den[-1] if loops.den[-1] else np.full(len(loops), np.inf)
    small = np.abs(at_rest) < 1.0
    doubtful |= np.abs(np.abs(at_rest) - 1.0) < CLEAR
    doubtful |= np.abs(1.0 + at_rest) < CLEAR
    rest = np.zeros(len(loops))
    before_small, before_large = _argument(poles, rest), _argument(shared, rest)
    for root, is_right in zip(own, right, strict=True):
        before_large = before_large + _own_argument(root, is_right, rest)
    change = np.zeros(len(loops))
    for i in range(most):
        here = finite[i]
        step = np.where(small, small_side[i] - before_small, large_side[i] - before_large)
        change += np.where(here, step, 0.0)
        before_small, before_large = (
            np.where(here, small_side[i], before_small),
            np.where(here, large_side[i], before_large),
        )
        small = np.where(here, ~small, small)
    doubtful |= ~small  # |L| ends below one
    change += 0.5 * np.pi * poles.size - before_small
    zeros = 0.5 * poles.size - change / np.pi
    count = np.round(zeros)
    doubtful |= np.abs(zeros - count) > 0.1
    decided = np.where(count <= 0.0, STABLE, UNSTABLE)
    # without bound at high frequency: infinitely many unstable poles
    decided = np.where(loops.feedthrough >= 1.0, UNSTABLE, np.where(doubtful, UNDECIDED, decided))
    return decided.astype(np.int8), crossovers


def gain_crossovers(loops: LoopColumns) -> tuple[Array, Flags]:
    """Return the frequencies with |L| = 1, ascending and ``inf`` at the end, and whether some may be missing."""
    n, d = squared_magnitude(loops.num), squared_magnitude(loops.den[:, None])
    difference = np.repeat(d, len(loops), axis=1)
    difference[-n.shape[0] :] -= n
    roots, lost = polynomial_roots(difference)
    with np.errstate(all="ignore"):
        off = np.abs(roots.imag) / np.abs(roots.real)
    real = (roots.real > 0.0) & (off <= REAL)
    doubtful = lost | np.any((roots.real > 0.0) & (off > REAL) & (off < DOUBTFUL), axis=0)
    w = np.sort(np.where(real, np.sqrt(np.maximum(roots.real, 0.0)), np.inf), axis=0)
    with np.errstate(invalid="ignore"):
        doubtful |= np.any(w[1:] - w[:-1] < DOUBTFUL * w[:-1], axis=0)
    most = int(np.max(np.sum(np.isfinite(w), axis=0), initial=0))
    return w[:most], doubtful


def squared_magnitude(rows: Array) -> Array:
    """Return the coefficients in x = w^2 of |p(i w)|^2 for polynomials in columns, descending powers."""
    degree = rows.shape[0] - 1
    mirrored = rows * ((-1.0) ** np.arange(degree, -1, -1))[:, None]
    product = np.zeros((2 * degree + 1, rows.shape[1]))
    for i in range(degree + 1):
        product[i : i + degree + 1] += rows[i] * mirrored
    even = product[::2]
    return np.asarray(even * ((-1.0) ** np.arange(degree, -1, -1))[:, None])


def polynomial_roots(rows: Array) -> tuple[ComplexArray, Flags]:
    """Return the roots of polynomials in columns, shape (degree, n), and where the leading coefficient vanishes."""
    lost = rows[0] == 0.0
    monic = rows[1:] / np.where(lost, 1.0, rows[0])
    degree, count = monic.shape
    if degree <= 1:
        return -monic.astype(complex), lost
    if degree == 2:
        half, product = -0.5 * monic[0], monic[1]
        root = np.sqrt((half**2 - product).astype(complex))
        large = half + np.where(half >= 0.0, root, -root)
        with np.errstate(all="ignore"):
            small = np.where(large != 0.0, product / large, 0.0)
        return np.stack([large, small]), lost
    companion = np.zeros((count, degree, degree))
    companion[:, 0] = -monic.T
    companion[:, 1:, :-1] = np.eye(degree - 1)
    return np.asarray(np.linalg.eigvals(companion), dtype=complex).T, lost


def _controller_roots(rows: Array) -> tuple[ComplexArray, Flags]:
    if rows.shape[0] < 2:
        return np.zeros((0, rows.shape[1]), dtype=complex), rows[0] == 0.0
    return polynomial_roots(rows)


def _argument(roots: ComplexArray, w: Array) -> Array:
    """Return the argument of the product of i w - root, continuous in w >= 0."""
    total = np.zeros(w.shape)
    for root in roots:
        if root.real > 0.0:
            total += np.pi + np.arctan2(root.imag - w, root.real)
        elif root == 0.0:
            total += 0.5 * np.pi
        else:
            total += np.arctan2(w - root.imag, -root.real)
    return total


def _own_argument(root: ComplexArray, right: Array, w: Array) -> Array:
    left = np.arctan2(w - root.imag, -root.real)
    return np.where(right > 0.0, np.pi + np.arctan2(root.imag - w, root.real), left)

"""Chebyshev-Lobatto collocation: nodes, transforms and integration on [-1, 1].

Trefethen, "Spectral Methods in MATLAB" (2000), chapters 6 and 12; Clenshaw and Curtis (1960) for the integrals.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUNDING = 1e-15  # of the largest coefficient of a series: one of its last that is rounding
OFF_AXIS = 1e-8  # a double root splits into a pair off the real axis by the square root of the rounding error
NEAR = 1e-4  # last step of Newton's method at a root; what it would lead to from farther off is another one


@cache
def nodes(degree: int) -> Array:
    """Return the ``degree + 1`` Chebyshev-Lobatto nodes, ascending from -1 to 1."""
    # The sine form is exactly antisymmetric, which the cosine form is not in floating point.
    return _frozen(np.sin(np.pi * np.arange(-degree, degree + 1, 2) / (2 * degree)))


@cache
def values_to_coefficients(degree: int) -> Array:
    """Return the matrix that maps values at the nodes to Chebyshev coefficients (discrete cosine transform)."""
    order = np.arange(degree + 1)
    angles = np.arccos(nodes(degree))
    weights = np.full(degree + 1, 2.0 / degree)
    weights[[0, -1]] /= 2.0
    transform = np.cos(np.outer(order, angles)) * weights
    transform[[0, -1]] /= 2.0
    return _frozen(transform)


@cache
def integration(degree: int) -> Array:
    """Return the matrix that maps values at the nodes to the integral from -1 to each node.

    The interpolant is integrated exactly, so the operator is of the second kind and well conditioned.
    """
    antiderivative = cheb.chebint(np.eye(degree + 1), lbnd=-1.0, axis=0)
    vandermonde = cheb.chebvander(nodes(degree), degree + 1)
    matrix = vandermonde @ antiderivative @ values_to_coefficients(degree)
    matrix[0] = 0.0
    return _frozen(matrix)


@cache
def evaluation(degree: int, points: int) -> Array:
    """Return the matrix, shape (degree + 1, points), that maps coefficients to values at ``points`` Lobatto nodes."""
    return _frozen(cheb.chebvander(nodes(points - 1), degree).T.copy())


@cache
def differentiation(degree: int) -> Array:
    """Return the matrix, shape (degree + 1, degree), that maps coefficients (as rows) to those of the derivative."""
    return _frozen(cheb.chebder(np.eye(degree + 1), axis=0).T.copy())


@cache
def antidifferentiation(degree: int) -> Array:
    """Return the matrix, shape (degree + 1, degree + 2), that maps coefficients (rows) to those of an integral."""
    return _frozen(cheb.chebint(np.eye(degree + 1), axis=0).T.copy())


@cache
def gauss_legendre(count: int) -> tuple[Array, Array]:
    """Return Gauss-Legendre nodes and weights on [-1, 1], exact for polynomials of degree ``2 count - 1``."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return _frozen(points), _frozen(weights)


def basis(x: Array, degree: int) -> Array:
    """Return the Chebyshev polynomials of degree 0..``degree`` at ``x``; shape (degree + 1, len(x))."""
    table = np.empty((degree + 1, x.size))
    table[0] = 1.0
    if degree:
        table[1] = x
        twice = x + x
        for k in range(2, degree + 1):
            np.multiply(twice, table[k - 1], out=table[k])
            table[k] -= table[k - 2]
    return table


def cosines(x: Array, degree: int) -> Array:
    """Return what `basis` does, from the polynomials' other definition: quicker where there are few points."""
    return np.asarray(np.cos(np.arange(degree + 1)[:, None] * np.arccos(np.minimum(np.maximum(x, -1.0), 1.0))))


def valued(series: Array, x: Array) -> Array:
    """Evaluate one series at a few points."""
    return np.asarray(series @ cosines(x, series.size - 1))


def real_roots(coefficients: Array) -> Array:
    """Return the sorted roots of a Chebyshev series in [-1, 1], from the colleague matrix, polished by Newton.

    Trailing coefficients at rounding level are dropped first: they would only add spurious far-away eigenvalues.
    """
    scale = np.max(np.abs(coefficients))
    if scale == 0.0:
        return np.empty(0)
    significant = np.nonzero(np.abs(coefficients) > ROUNDING * scale)[0]
    series = coefficients[: significant[-1] + 1]
    if series.size < 2:
        return np.empty(0)
    roots = cheb.chebroots(series)
    inside = (np.abs(roots.imag) < OFF_AXIS) & (np.abs(roots.real) <= 1.0 + OFF_AXIS)
    real = np.clip(roots[inside].real, -1.0, 1.0)
    derivative = series @ differentiation(series.size - 1)
    for _ in range(2 if real.size else 0):
        polynomials = cosines(real, series.size - 1)
        slope = derivative @ polynomials[:-1]
        step = np.divide(series @ polynomials, slope, out=np.zeros_like(real), where=slope != 0.0)
        real = np.where(np.abs(step) < NEAR, np.minimum(np.maximum(real - step, -1.0), 1.0), real)
    return np.sort(real)


def cut(length: float, pieces: int, until: float) -> tuple[Array, float]:
    """Return the breaks of equal pieces, the last one cut at ``until``, and the share of it that is left."""
    breaks = length * np.arange(pieces + 1)
    share = min(1.0, (until - breaks[-2]) / length)
    if share < 1.0:
        breaks[-1] = until
    return np.asarray(breaks, dtype=float), float(share)


def cut_last(coefficients: Array, share: float) -> Array:
    """Return piecewise series, the pieces along the last axis but one, with the last restricted to a share of it."""
    if share < 1.0:
        coefficients = np.array(coefficients)
        coefficients[..., -1, :] = restricted(coefficients[..., -1, :], -1.0, 2.0 * share - 1.0)
    return coefficients


def restricted(series: Array, left: float, right: float) -> Array:
    """Return the Chebyshev series of the same functions on a part [left, right] of [-1, 1]."""
    degree = series.shape[-1] - 1
    x = left + 0.5 * (right - left) * (nodes(degree) + 1.0)
    return np.asarray(series @ cosines(x, degree) @ values_to_coefficients(degree).T)


def _frozen(array: NDArray[np.floating[Any]]) -> Array:
    array.setflags(write=False)  # cached arrays are shared
    return np.asarray(array, dtype=np.float64)

"""Polynomials as coefficients in descending powers: their values, roots and products."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

TINY, HUGE = 1e-280, 1e280  # between which the discriminant of a quadratic keeps all its digits


def trimmed(polynomial: Array) -> Array:
    """Return a polynomial without leading zeros; the zero polynomial has no coefficient."""
    if polynomial.size and polynomial[0]:
        return polynomial
    nonzero = np.nonzero(polynomial)[0]
    return polynomial[nonzero[0] :] if nonzero.size else polynomial[:0]


def product(left: Array, right: Array) -> Array:
    """Return the product of two polynomials that are not empty."""
    return np.asarray(np.convolve(left, right), dtype=float)


def roots_of(polynomial: Array) -> ComplexArray:
    """Return the roots of a polynomial; up to the second degree in closed form."""
    degree = polynomial.size - 1
    if degree <= 0:
        return np.zeros(0, dtype=complex)
    if degree == 1:
        return np.array([-polynomial[1] / polynomial[0]], dtype=complex)
    if degree == 2:
        a, b, c = polynomial.tolist()
        if TINY < b * b + abs(a * c) < HUGE:
            root = cmath.sqrt(b * b - 4.0 * a * c)
            large = -0.5 * (b + root if b >= 0.0 else b - root)
            return np.array([large / a, c / large], dtype=complex)
    return np.asarray(np.roots(polynomial), dtype=complex)


def roots_of_difference(left: Array, right: Array) -> ComplexArray:
    """Return the roots of the difference of two polynomials."""
    size = max(left.size, right.size)
    difference = np.zeros(size)
    difference[size - left.size :] += left
    difference[size - right.size :] -= right
    difference = trimmed(difference)
    return roots_of(difference) if difference.size else np.zeros(0, dtype=complex)


def horner(coefficients: Sequence[float], s: Any) -> Any:
    """Evaluate a polynomial at a number or an array; zero without coefficients."""
    if not coefficients:
        return 0.0 * s
    value = coefficients[0] + 0.0 * s
    for c in coefficients[1:]:
        value = value * s + c
    return value


def horner_with_slope(coefficients: Sequence[float], s: Any) -> tuple[Any, Any]:
    """Evaluate a polynomial and its derivative."""
    slope = 0.0 * s
    if not coefficients:
        return slope, slope
    value = coefficients[0] + slope
    for c in coefficients[1:]:
        slope = slope * s + value
        value = value * s + c
    return value, slope


def taylor(coefficients: Sequence[float], s: ComplexArray, order: int) -> ComplexArray:
    """Return the Taylor coefficients of a polynomial at points, shape (order + 1, len(s))."""
    rows = np.zeros((order + 1, *np.shape(s)), dtype=complex)
    for c in coefficients:
        for n in range(order, 0, -1):
            rows[n] *= s
            rows[n] += rows[n - 1]
        rows[0] *= s
        rows[0] += c
    return rows


def shifted(polynomial: Array, by: float) -> Array:
    """Return the polynomial p(s + by), by repeated synthetic division."""
    c = polynomial.tolist()
    for last in range(len(c) - 1, 0, -1):
        for i in range(1, last + 1):
            c[i] += by * c[i - 1]
    return np.array(c)


def derivative(polynomial: Array) -> Array:
    """Return the derivative; of a constant, zero."""
    return np.asarray(polynomial[:-1] * np.arange(polynomial.size - 1, 0, -1)) if polynomial.size > 1 else np.zeros(1)


def squared_magnitude(polynomial: Array) -> Array:
    """Return the coefficients in x = w^2 of |p(i w)|^2."""
    if polynomial.size == 0:
        return np.zeros(1)
    signs = _signs(polynomial.size)
    return product(polynomial, polynomial * signs)[::2] * signs  # p(s) p(-s), even in s


@cache
def _signs(size: int) -> Array:
    """Return the signs of the powers of s, descending, at s = -1."""
    return np.asarray(1.0 - 2.0 * (np.arange(size - 1, -1, -1) % 2))

"""Derivatives of a plant's frequency response with respect to frequency, exact.

For rational plants the Taylor coefficients of numerator, denominator and dead time are divided and multiplied
as series.
For plants given by a function they come from Cauchy's integral on a circle around i w, which converges geometrically.
"""

from __future__ import annotations

from math import factorial

import numpy as np
from numpy.typing import NDArray

from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

CIRCLE_POINTS = 48
CIRCLE_RADIUS = 0.35  # of |w|; a cut or poles on the negative real axis stay well outside


def plant_jet(plant: Plant, w: Array, order: int) -> ComplexArray:
    """Return the Taylor coefficients of G(i w) in w, shape (order + 1, len(w)); row n is n-th derivative / n!."""
    s = 1j * np.asarray(w, dtype=float)
    if plant.is_rational:
        series = series_quotient(_polynomial_jet(plant.num, s, order), _polynomial_jet(plant.den, s, order))
    else:
        turn = np.exp(2j * np.pi * np.arange(CIRCLE_POINTS) / CIRCLE_POINTS)
        radius = CIRCLE_RADIUS * np.abs(s)
        around = plant.delay_free(s[:, None] + radius[:, None] * turn)
        powers = np.exp(-2j * np.pi * np.outer(np.arange(CIRCLE_POINTS), np.arange(order + 1)) / CIRCLE_POINTS)
        series = (around @ powers / CIRCLE_POINTS).T / radius ** np.arange(order + 1)[:, None]
    if plant.dead_time:
        delay = np.exp(-s * plant.dead_time)
        delays = np.array([delay * (-plant.dead_time) ** n / factorial(n) for n in range(order + 1)])
        series = series_product(series, delays)
    return np.asarray(series * (1j ** np.arange(order + 1))[:, None])


def controller_basis_jets(w: Array, order: int) -> ComplexArray:
    """Return the Taylor coefficients in w of 1, 1/(i w) and i w; shape (3, order + 1, len(w))."""
    w = np.asarray(w, dtype=float)
    basis = np.zeros((3, order + 1, w.size), dtype=complex)
    basis[0, 0] = 1.0
    for n in range(order + 1):
        basis[1, n] = -1j * (-1.0) ** n / w ** (n + 1)
    basis[2, 0] = 1j * w
    if order:
        basis[2, 1] = 1j
    return basis


def series_product(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return the truncated product of two Taylor series, coefficients along the first axis."""
    return np.array([sum(a[i] * b[n - i] for i in range(n + 1)) for n in range(a.shape[0])])


def series_quotient(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return the truncated quotient of two Taylor series, coefficients along the first axis."""
    quotient = np.zeros_like(a)
    for n in range(a.shape[0]):
        quotient[n] = (a[n] - sum(quotient[i] * b[n - i] for i in range(n))) / b[0]
    return quotient


def _polynomial_jet(polynomial: Array, s: ComplexArray, order: int) -> ComplexArray:
    rows = [np.polyval(np.polyder(polynomial, n), s) / factorial(n) for n in range(order + 1)]
    return np.array(rows, dtype=complex)

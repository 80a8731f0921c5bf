"""Derivatives of a plant's frequency response with respect to frequency, exact.

The Taylor coefficients of the plant's part without dead time (`Plant.taylor`) and of the dead time are multiplied as
series.
"""

from __future__ import annotations

import cmath
from math import factorial

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics.polynomials import horner_with_slope
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def plant_jet(plant: Plant, w: Array, order: int) -> ComplexArray:
    """Return the Taylor coefficients of G(i w) in w, shape (order + 1, len(w)); row n is n-th derivative / n!."""
    s = 1j * np.asarray(w, dtype=float)
    series = plant.taylor(s, order)
    if plant.dead_time:
        series = series_product(series, delay_series(s, plant.dead_time, order))
    return np.asarray(series * (1j ** np.arange(order + 1))[:, None])


def value_and_slope(plant: Plant, w: float) -> tuple[complex, complex]:
    """Return G(i w) and d log G(i w) / dw at one frequency: what a solver asks for point by point."""
    s = complex(0.0, w)
    if plant.is_rational:
        (n, n_slope), (d, d_slope) = (horner_with_slope(part.tolist(), s) for part in (plant.num, plant.den))
        if n and d:
            slope = n_slope / n - d_slope / d - plant.dead_time
            return n / d * cmath.exp(-s * plant.dead_time), 1j * slope
    return complex(plant(s)), 1j * complex(plant.log_derivative(s))


def delay_series(s: ComplexArray, dead_time: float, order: int) -> ComplexArray:
    """Return the Taylor coefficients of exp(-s dead_time) at ``s``, shape (order + 1, len(s))."""
    delay = np.exp(-s * dead_time)
    return np.array([delay * (-dead_time) ** n / factorial(n) for n in range(order + 1)])


def series_product(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return the truncated product of two Taylor series, coefficients along the first axis."""
    return np.array([sum(a[i] * b[n - i] for i in range(n + 1)) for n in range(a.shape[0])])


def series_quotient(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return the truncated quotient of two Taylor series, coefficients along the first axis."""
    quotient = np.zeros_like(a)
    for n in range(a.shape[0]):
        quotient[n] = (a[n] - sum(quotient[i] * b[n - i] for i in range(n))) / b[0]
    return quotient

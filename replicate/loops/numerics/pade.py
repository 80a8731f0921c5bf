"""Padé approximations of a dead time: a first guess, and what the tools of the time put in its place."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def dead_time_polynomials(dead_time: float, order: int) -> tuple[Array, Array]:
    """Return numerator and denominator of the Padé approximation of exp(-s dead_time), descending powers of s.

    Examples
    --------
    >>> dead_time_polynomials(1.0, 1)
    (array([-0.5,  1. ]), array([0.5, 1. ]))
    """
    coefficients = _coefficients(order) * dead_time ** np.arange(order, -1, -1.0)
    return coefficients * (1.0 - 2.0 * (np.arange(order, -1, -1) % 2)), coefficients


@cache
def _coefficients(order: int) -> Array:
    c = [1.0]
    for j in range(1, order + 1):
        c.append(c[-1] * (order - j + 1) / (j * (2 * order - j + 1)))
    return np.array(c[::-1])

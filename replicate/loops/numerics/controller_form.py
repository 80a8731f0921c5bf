"""The controller canonical form: a transfer function as a differential equation of the first order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def controller_form(num: Array, den: Array) -> tuple[Array, Array, Array, float]:
    """Return (A, B, C, D) of a proper ``num/den``, shapes (n, n), (n,), (n,) and scalar.

    Parameters
    ----------
    num, den
        Polynomials in descending powers; the denominator has no leading zeros.

    References
    ----------
    T. Kailath, Linear Systems (1980), section 2.1.1.

    Examples
    --------
    >>> controller_form(np.array([3.0]), np.array([2.0, 4.0]))
    (array([[-2.]]), array([1.]), array([1.5]), 0.0)
    """
    order = den.size - 1
    num, den = num / den[0], den / den[0]
    padded = np.concatenate([np.zeros(den.size - num.size), num])
    a, b = np.eye(order, k=-1), np.zeros(order)
    if order:
        a[0], b[0] = -den[1:], 1.0
    return a, b, padded[1:] - padded[0] * den[1:], float(padded[0])

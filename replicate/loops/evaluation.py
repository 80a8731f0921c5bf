"""Values of transfer functions everywhere: infinite at a pole, nan where s is not finite, and never a warning."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks

ComplexArray = NDArray[np.complex128]

INFINITE = complex(np.inf, 0.0)


def values(function: Callable[[ComplexArray], ComplexArray], s: ArrayLike) -> ComplexArray:
    """Return the values of a transfer function at complex numbers of any shape.

    Parameters
    ----------
    function
        Takes and returns complex arrays; a quotient in it is that of `quotient`.
    s
        Where; LoopError unless these are numbers.
    """
    s = checks.points("s", s)
    with np.errstate(all="ignore"):
        found = np.asarray(function(s), dtype=complex)
    if np.isfinite(found).all():
        return found
    infinite = np.isinf(found.real) | np.isinf(found.imag)
    return np.asarray(np.where(np.isfinite(s), np.where(infinite, INFINITE, found), complex(np.nan, np.nan)))


def quotient(top: NDArray[Any], below: NDArray[Any]) -> ComplexArray:
    """Return a quotient that is infinite, without a direction, where only the denominator is zero."""
    with np.errstate(all="ignore"):
        found = np.asarray(top / below)
    if np.isfinite(found).all():
        return found
    return np.asarray(np.where((below == 0.0) & (top != 0.0), INFINITE, found))

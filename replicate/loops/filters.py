"""Filters of a controller: given by a time constant, or by the two polynomials of a transfer function."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError

Array = NDArray[np.float64]
Filter = float | tuple[tuple[float, ...], tuple[float, ...]]  # a time constant, or (num, den)


def filter_polynomials(given: Filter) -> tuple[Array, Array]:
    """Return numerator and denominator of a filter, descending powers of s.

    Parameters
    ----------
    given
        As `checked_filter` returns it.
    """
    if isinstance(given, tuple):
        return np.array(given[0]), np.array(given[1])
    return np.array([1.0]), np.array([given, 1.0]) if given else np.array([1.0])


def checked_filter(name: str, given: object) -> Filter:
    """Return a filter's time constant, or its polynomials without leading zeros.

    Parameters
    ----------
    name
        What the filter is called in a message.
    given
        A time constant, or a pair (num, den).

    Raises
    ------
    LoopError
        If it is neither, or the polynomials are not proper and stable.
    """
    if not isinstance(given, tuple | list):
        allowed = "a time constant >= 0 or a pair (num, den) of polynomials"
        return checks.non_negative(f"the controller's {name}", given, allowed=allowed)
    try:
        num, den = (checks.coefficients(name, part) for part in given)
    except (LoopError, ValueError):
        shown = checks.shown(given)
        msg = f"the controller's {name} must be two non-zero polynomials (num, den) of finite numbers, not {shown}"
        raise LoopError(msg) from None
    if num.size > den.size:
        msg = f"the controller's {name} must be proper: degree {num.size - 1} over degree {den.size - 1}"
    elif np.any(np.roots(den).real >= 0.0):
        msg = f"the controller's {name} must be stable: {den.tolist()} has a root with Re s >= 0"
    else:
        return tuple(num.tolist()), tuple(den.tolist())
    raise LoopError(msg)

"""A root between two points at which a function was seen to change its sign."""

from __future__ import annotations

from collections.abc import Callable

from scipy.optimize import brentq

TINY, CLOSEST = 1e-300, 8.9e-16  # what no root is below, and the relative error that brentq allows to ask for


def bracketed_root(f: Callable[[float], float], left: float, right: float) -> float:
    """Return a root of ``f`` between two points, to rounding, whatever their unit.

    Where the change of sign was seen in values that were computed together, the same values one by one may differ by
    rounding: if they do not change sign, the end nearer to zero is the root.

    Parameters
    ----------
    f
        Real, continuous.
    left, right
        The two points, both positive.

    Examples
    --------
    >>> round(bracketed_root(lambda x: x * x - 2.0, 1.0, 2.0), 12)
    1.414213562373
    """
    at_left, at_right = f(left), f(right)
    if not at_left * at_right < 0.0:
        return left if abs(at_left) <= abs(at_right) else right
    return float(brentq(f, left, right, xtol=TINY, rtol=CLOSEST, maxiter=200))

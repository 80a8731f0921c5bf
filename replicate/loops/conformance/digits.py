"""How many digits of a value are right."""

from __future__ import annotations

import math
from dataclasses import dataclass

ATTAINABLE = 15.0  # digits of an IEEE double


@dataclass(frozen=True)
class Quantity:
    """One exact value of a loop.

    Attributes
    ----------
    group, name
        For example ``poles`` and ``pole 2``, ``responses`` and ``step(1.5)``.
    value
        The exact value; None if it is infinite or does not exist.
    scale
        What the error is relative to.
    attainable
        How many digits a double-precision computation can give: 15, and 15/m for a pole of multiplicity m, which
        rounding of the coefficients moves by the m-th root of the rounding error.
    """

    group: str
    name: str
    value: float | complex | None
    scale: float
    attainable: float = ATTAINABLE


def digits(quantity: Quantity, found: float | complex | None) -> float:
    """Return the number of correct digits, 0 to 15; the missing ones of a multiple pole are not held against it.

    Examples
    --------
    >>> round(digits(Quantity("margins", "gain_margin", 2.0, 2.0), 2.002), 9)
    3.0
    >>> digits(Quantity("margins", "gain_margin", None, 1.0), float("inf"))
    15.0
    """
    missing = found is None or not (math.isfinite(abs(found)))
    if quantity.value is None or found is None or missing:
        return ATTAINABLE if quantity.value is None and missing else 0.0
    error = abs(found - quantity.value) / quantity.scale
    right = ATTAINABLE if error == 0.0 else min(ATTAINABLE, max(0.0, -math.log10(error)))
    return min(ATTAINABLE, right * ATTAINABLE / quantity.attainable)

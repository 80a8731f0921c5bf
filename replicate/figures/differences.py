"""One difference between two figures, and when two numbers are the same but for rounding."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

#: Computed values are the same up to this, relative: well above the rounding of another processor ...
RELATIVE = 1e-7
#: ... and up to this, absolute, where a value is zero but for rounding.
ABSOLUTE = 1e-10

FigureChange = Literal["curve", "axes", "new", "removed"]


@dataclass(frozen=True)
class Difference:
    """One difference between two states of a figure.

    Attributes
    ----------
    kind
        Whether a curve or a property of the axes differs, or something is new or gone.
    text
        What changed, in words.
    where
        The curve (``panel / curve``), panel or property it is about.
    before, after
        The two values, as text.
    size
        How much a curve moved, as a fraction of its axes.
    """

    kind: FigureChange
    text: str
    where: str = ""
    before: str = ""
    after: str = ""
    size: float | None = None


def same_number(before: str, after: str) -> bool:
    """Whether two texts are equal, or numbers that differ by no more than rounding.

    Examples
    --------
    >>> same_number("6.96800001", "6.968"), same_number("6.969", "6.968"), same_number("", "0")
    (True, False, False)
    """
    if before == after:
        return True
    try:
        return math.isclose(float(before), float(after), rel_tol=RELATIVE, abs_tol=ABSOLUTE)
    except ValueError:
        return False

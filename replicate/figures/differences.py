"""One difference between two figures, and when two numbers are the same but for rounding."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

#: Computed values are the same up to this, relative: well above the rounding of another processor ...
RELATIVE = 1e-7
#: ... and up to this, absolute, where a value is zero but for rounding.
ABSOLUTE = 1e-10

FigureChange = Literal["curve", "axes", "look", "new", "removed"]
#: Who noticed: a reader that knows what it sees, or the safety net, which compares whatever is drawn.
Layer = Literal["named", "net"]


@dataclass(frozen=True)
class Difference:
    """One difference between two states of a figure.

    Attributes
    ----------
    kind
        Whether a curve, a property of the axes or the look of a part differs, or something is new or gone.
    text
        What changed, in words.
    where
        The curve (``panel / curve``), panel or property it is about.
    before, after
        The two values, as text.
    size
        How much a curve moved, as a fraction of its axes.
    layer
        Who noticed.
    """

    kind: FigureChange
    text: str
    where: str = ""
    before: str = ""
    after: str = ""
    size: float | None = None
    layer: Layer = "named"


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


def percent(size: float) -> str:
    """Return a fraction in per cent, to two digits.

    Examples
    --------
    >>> percent(0.0012), percent(0.5), percent(3.21)
    ('0.12 %', '50 %', '321 %')
    """
    return f"{100.0 * size:.0f} %" if size >= 0.995 else f"{100.0 * size:.2g} %"

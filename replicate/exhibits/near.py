"""What is near a printed value, though not equal to it: a tolerance that a table may declare."""

from __future__ import annotations

import math
from dataclasses import dataclass

from replicate.exhibits.definitions import refuse, shown


@dataclass(frozen=True)
class Near:
    """What is near a printed value: within some units of its last digit or a fraction of it, whichever is more.

    Attributes
    ----------
    units
        Units of the last printed digit.
    fraction
        Fraction of the printed value.

    Raises
    ------
    PaperDefinitionError
        If one of them is no number, negative or infinite.

    Examples
    --------
    Only a unit of the last digit is near:

    >>> Near(units=1, fraction=0.0)
    Near(units=1, fraction=0.0)
    """

    units: float = 2.0
    fraction: float = 0.01

    def __post_init__(self) -> None:
        """Check what would make no sense as a distance."""
        for name, value in vars(self).items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
                refuse(f"near: {name} is {shown(value)}; expected: a number, 0 or more")


USUAL = Near()

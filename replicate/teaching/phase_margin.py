"""The phase margin as an answer that is read off a figure."""

from __future__ import annotations

import math

from replicate.exhibits.variants import Answer


def phase_margin(degrees: float, tolerance: float) -> Answer:
    """Return the answer.

    Parameters
    ----------
    tolerance
        In degrees: how exactly the figure can be read.
    """
    return Answer(
        degrees,
        unit="degrees",
        tolerance=tolerance,
        mistakes={
            "angle from the positive axis": 180.0 - degrees,
            "angle from the imaginary axis": 90.0 - degrees,
            "radians": math.radians(degrees),
        },
        asked="phase margin",
    )

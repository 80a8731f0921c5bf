r"""Paper IV: the reference model 2 te s / ((1 + 2 te s)(1 + 2 tg s)) that hides shrink and swell from the controller.

The paper gives no values for the two time constants, so everything is in units of te and of the ratio tg/te.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class StepResponse(NamedTuple):
    """What the unit step response of the reference model looks like; times in units of te."""

    peak: float
    peak_time: float
    area: float
    settling_time: float


def step(ratio: float, time: ArrayLike) -> Array:
    """Return the unit step response at ``time`` (in units of te) for ``ratio`` = tg/te > 0.

    It is (e^{-t/(2 te)} - e^{-t/(2 tg)}) / (1 - ratio), the double-pole limit included.
    """
    t = np.asarray(time, dtype=float)
    if math.isclose(ratio, 1.0, rel_tol=1e-9):
        return np.asarray(0.5 * t * np.exp(-0.5 * t))
    return np.asarray((np.exp(-0.5 * t) - np.exp(-0.5 * t / ratio)) / (1.0 - ratio))


def characteristics(ratio: float, band: float = 0.02) -> StepResponse:
    """Return peak, its time, the area and the time after which the response stays below ``band``.

    The peak is ratio^(ratio/(1 - ratio)), reached at 2 te ratio log(ratio)/(ratio - 1); the area is 2 te.
    """
    if math.isclose(ratio, 1.0, rel_tol=1e-9):
        peak, peak_time = math.exp(-1.0), 2.0
    else:
        peak = ratio ** (ratio / (1.0 - ratio))
        peak_time = 2.0 * ratio * math.log(ratio) / (ratio - 1.0)
    low, high = peak_time, peak_time + 60.0 * max(1.0, ratio)
    while high - low > 1e-13 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(step(ratio, middle)) > band else (low, middle)
    return StepResponse(peak, peak_time, 2.0, 0.5 * (low + high))

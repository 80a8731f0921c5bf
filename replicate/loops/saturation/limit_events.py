"""When a mode of a limited loop ends: the first point of a piece beyond which its conditions do not hold."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.saturation.anti_windup import FREE, LimitedController, Mode
from replicate.loops.time_domain.piece_flow import DEGREE
from replicate.loops.time_domain.piecewise import MARGIN, SAMPLES

Array = NDArray[np.float64]

TOLERANCE = 1e-13  # of the largest command: a transgression that is rounding
RATE_TOLERANCE = 1e-11  # of the largest rate, which is a derivative of a polynomial
# of the largest command in half a piece: the rate that its rounding becomes in the derivative (Markov's inequality)
RATE_ROUNDING = 4.0 * float(np.finfo(float).eps) * DEGREE**2
WITHIN = np.array([0.1, 0.3, 0.5, 0.7, 0.9])  # of an interval without a sign change, where its sign is looked at


@dataclass(frozen=True)
class Condition:
    """A polynomial on [-1, 1] that must not exceed zero by more than rounding, and the mode that follows if it does."""

    series: Array
    tolerance: float
    following: Mode

    def end(self) -> float | None:
        """Return the point from which on the polynomial exceeds zero; -1 if from the start; None if it does not."""
        samples = self.series @ chebyshev.evaluation(self.series.size - 1, SAMPLES)
        if np.max(samples) + MARGIN * np.ptp(samples) <= self.tolerance:
            return None
        for left, right in pairwise([-1.0, *chebyshev.real_roots(self.series), 1.0]):
            inside = cheb.chebval(left + (right - left) * WITHIN, self.series)
            if np.max(inside) > self.tolerance:
                before = cheb.chebval(-1.0 + (left + 1.0) * WITHIN, self.series)
                # a root next to the start, with nothing but rounding before it, is the start
                at_start = left + 1.0 < MARGIN and float(np.max(np.abs(before))) <= self.tolerance
                return -1.0 if at_start else float(left)
        return None


@dataclass(frozen=True)
class Piece:
    """What the conditions look at: coefficients of the command, and of the integral part's rate."""

    command: Array
    integral_rate: Array
    length: float


def first_end(controller: LimitedController, mode: Mode, piece: Piece, size: float) -> tuple[float, Mode] | None:
    """Return where on [-1, 1] a mode ends first, and the mode that follows; None if it lasts.

    Parameters
    ----------
    size
        The largest command so far, for what counts as rounding.
    """
    ends = [(end, c.following) for c in _conditions(controller, mode, piece, size) if (end := c.end()) is not None]
    return min(ends, key=lambda found: found[0]) if ends else None


def _conditions(controller: LimitedController, mode: Mode, piece: Piece, size: float) -> list[Condition]:
    low, high = controller.limits
    tolerance = TOLERANCE * max(size, *(abs(limit) for limit in (low, high) if np.isfinite(limit)), 0.0)
    clamps = controller.anti_windup == "clamping" and controller.integrator is not None

    def beyond(side: int) -> Mode:
        return Mode("held" if clamps else "limited", side)

    if mode == FREE:
        found = [Condition(_less(piece.command, high), tolerance, beyond(1))] if np.isfinite(high) else []
        return [*found, Condition(-_less(piece.command, low), tolerance, beyond(-1))] if np.isfinite(low) else found
    outside = mode.side * _less(piece.command, controller.limit(mode))
    running = mode.side * piece.integral_rate
    if mode.kind == "sliding":
        slope = np.asarray(cheb.chebder(piece.command), dtype=float) * (2.0 * mode.side / piece.length)
        moving: Array = np.append(slope, 0.0)
        tolerance = RATE_TOLERANCE * float(np.max(np.abs(moving)) + np.max(np.abs(running)))
        tolerance += RATE_ROUNDING * size * 2.0 / piece.length
        return [
            Condition(moving, tolerance, Mode("held", mode.side)),
            Condition(-(moving + running), tolerance, FREE),
        ]
    back = Condition(-outside, tolerance, FREE)
    if not clamps:
        return [back]
    rounding = RATE_TOLERANCE * float(np.max(np.abs(running)))
    if mode.kind == "held":
        return [back, Condition(-running, rounding, Mode("limited", mode.side))]
    return [back, Condition(running, rounding, Mode("held", mode.side))]


def _less(series: Array, level: float) -> Array:
    shifted = np.array(series)
    shifted[0] -= level
    return shifted

"""Whether a piece of a march is resolved: its last Chebyshev coefficients are at rounding level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import LoopError
from replicate.loops.numerics import chebyshev
from replicate.loops.time_domain.piece_flow import DEGREE

Array = NDArray[np.float64]

RESOLVED = 2e-14  # size of the last coefficients relative to the largest, at which a piece counts as resolved
NEARLY = 1e-9  # size up to which coefficients that no longer fall are the rounding error of the problem
SMOOTH = 1e-14  # size of the upper third of the coefficients at which the next piece may be twice as long
START = 1e-4  # of the set-point step: an output below this is resolved as if it were this large
LONG = 100.0  # length, in units of what the fastest mode needs, of a piece in which that mode has long decayed:
STIFF = 1e-13  # relative size of the rounding errors that its equations leave in coefficients that are zero
CLOCK = 4.0 * float(np.finfo(float).eps)
SQUARES = np.arange(DEGREE + 1) ** 2  # of the orders: they bound the slopes of the polynomials
LARGEST = 1e100  # size of a diverging response at which its metrics could overflow


@dataclass
class Resolution:
    """The sizes that output and control signal have reached, and the judgement of the next piece by them."""

    size_y: float
    size_u: float = 0.0
    fastest: float = float("inf")  # length of a piece that suits the fastest mode
    unit: float = 1.0  # of time, in the user's: for messages

    def check(self, start: float, h: float, signals: Array) -> tuple[float, bool]:
        """Return the size of what is not resolved, and whether a longer piece would be resolved, too.

        Parameters
        ----------
        start, h
            Start and length of the piece.
        signals
            Chebyshev coefficients of the output, the control signal and the delayed inputs, one row each.
        """
        rows = np.abs(signals)
        largest = rows.max(axis=1)
        size_y, size_u = max(self.size_y, float(largest[0])), max(self.size_u, float(largest[1]))
        sizes = np.full(largest.size, max(size_u, float(largest[2:].max())))
        sizes[:2] = size_y, size_u
        if not (size_y < LARGEST and size_u < LARGEST):
            msg = f"the response grows beyond {LARGEST:g} by t = {start * self.unit:g}: choose a shorter horizon"
            raise LoopError(msg)
        # times are known to rounding only: what changes fast carries that error
        blur = CLOCK * start * 2.0 / h
        stiff = STIFF if h > LONG * self.fastest else 0.0
        floors = blur * (rows * SQUARES).max(axis=1) + stiff * sizes
        sizes[sizes == 0.0] = 1.0  # of a row of zeros
        remaining = max(0.0, float(((rows[:, -2:].max(axis=1) - floors) / sizes).max()))
        upper = max(0.0, float(((rows[:, 2 * DEGREE // 3 :].max(axis=1) - floors) / sizes).max()))
        if remaining <= RESOLVED:
            self.size_y, self.size_u = size_y, size_u
        return remaining, upper <= SMOOTH


def as_good_as_it_gets(remaining: float, previous: float) -> bool:
    """Return whether a piece is resolved, or halving it no longer helps because its tail is rounding error."""
    return remaining <= RESOLVED or (remaining < NEARLY and remaining > 0.25 * previous)


def coefficients(node_values: Array) -> Array:
    """Return the Chebyshev coefficients of node values, which run along the last axis."""
    return np.asarray(node_values @ chebyshev.values_to_coefficients(DEGREE).T)

"""The rightmost poles of many loops at once, guessed, polished and proven as `proven_pole` does one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.closed_loop_poles.proven_pole import (
    APART,
    CONVERGED,
    CROWDED,
    FARTHEST,
    ORDER,
    REACH,
    REAL,
    STARTS,
    STEPS,
    TIE,
)  # fmt: skip
from replicate.loops.numerics.pade import dead_time_polynomials
from replicate.loops.sweep.loop_columns import LoopColumns, column_products
from replicate.loops.sweep.stability_counts import Characteristic, polynomial_roots, unstable_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Flags = NDArray[np.bool_]

MOST = 0.7  # share of the loops that still move above which it does not pay to leave the others out
SAME = 1e-8  # relative distance of points that are one pole


def rightmost_poles(loops: LoopColumns) -> tuple[ComplexArray, Flags]:
    """Return the rightmost poles, Im >= 0, in the unit of time of the columns, and which of them are proven."""
    poles = polished(loops, rational_starts(loops))
    order = np.argsort(np.where(np.isfinite(poles), -poles.real, np.inf), axis=0)
    poles = np.take_along_axis(poles, order, axis=0)
    first, rest = poles[0], np.concatenate([poles[1:], np.full_like(poles[:1], np.nan)])  # there may be no other
    with np.errstate(all="ignore"):
        other = np.abs(rest - first) > SAME * np.abs(first)
        second = np.take_along_axis(rest, np.argmax(other, axis=0)[None], axis=0)[0]
        alone = ~(other.any(axis=0) & np.isfinite(second))
        proven = np.isfinite(first)
        proven &= alone | (np.abs(second - first) > APART * np.abs(first))
        proven &= alone | (first.real - second.real > TIE * np.abs(first.real))
        line = first.real - np.maximum(np.abs(first.real), REACH)
        line = np.where(alone, line, np.maximum(line, 0.5 * (first.real + second.real)))
        proven &= np.abs(line) <= FARTHEST
        line = np.where(proven, line, 0.0)
        proven &= loops.feedthrough * np.exp(-line) < CROWDED
        count, doubtful, _ = unstable_poles(Characteristic.of(loops).shifted(line))
    return first, proven & ~doubtful & (count == np.where(first.imag > 0.0, 2.0, 1.0))


def rational_starts(loops: LoopColumns) -> ComplexArray:
    """Return the rightmost poles of the loops with a rational function in place of the dead time."""
    top, bottom = dead_time_polynomials(1.0, ORDER) if loops.delay else (np.ones(1), np.ones(1))
    fed_back = column_products(loops.num, top)
    whole = np.zeros((loops.den.size + bottom.size - 1, len(loops)))
    whole += np.convolve(loops.den, bottom)[:, None]
    whole[-fed_back.shape[0] :] += fed_back
    found, _ = polynomial_roots(whole)
    order = np.argsort(np.where(found.imag >= 0.0, -found.real, np.inf), axis=0)
    return np.take_along_axis(found, order[:STARTS], axis=0)


def polished(loops: LoopColumns, start: ComplexArray, converged: float = CONVERGED) -> ComplexArray:
    """Return where Newton's method leads, Im >= 0; ``nan`` where it does not converge to a simple pole.

    ``converged`` is its last relative step.
    """
    s, at = start.copy(), np.arange(len(loops))
    settled = np.zeros(s.shape, dtype=bool)
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            now = s[:, at]
            step = loops.newton_step(now)
            s[:, at] = np.where(settled[:, at], now, now - step)
            settled[:, at] |= np.abs(step) <= converged * np.abs(now)
            moving = np.nonzero(~settled[:, at].all(axis=0))[0]
            if moving.size == 0:
                break
            if moving.size < MOST * at.size:
                at, loops = at[moving], loops.take(moving)
        upper = s.real + 1j * np.abs(s.imag)
        upper = np.where(np.abs(s.imag) > REAL * np.abs(s), upper, s.real)
    return np.where(settled, upper, np.nan)

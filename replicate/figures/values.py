"""Compare two curves that are functions of x by value, with a band that a jump does not burst.

Where the accepted curve is flat, the new one must agree in value. Where it is steep or jumps, a change of
value says little, since the least change of x makes a large one. So the tolerance is a band: at every x, the
range of the accepted curve over a narrow window around x, widened by the tolerance. A jump that is moved by
rounding stays inside the band; one that is moved by more than the window leaves it by its whole height.

The window is what thinning may do along x. Everything is in fractions of the axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.figures.polylines import THINNING, Points
from replicate.figures.scaling import TOLERANCE, finite

Array = NDArray[np.float64]

#: Both curves were thinned; what is left is rounding.
WINDOW = 3.0 * THINNING

# What lies further outside the axes than this is not seen, and equal whatever it is.
_MARGIN = 0.02
_LEAST_WIDTH = 1e-3
_BESIDE = 1.01


@dataclass(frozen=True)
class ValueDifference:
    """Two curves on a common grid, which holds every x twice: the limits from the left and from the right.

    Attributes
    ----------
    x, before, after
        ``nan`` where a curve is not defined.
    lower, upper
        The tolerance band around the accepted curve.
    alarm
        Where the new curve leaves the band of the accepted one, or the accepted that of the new one.
    """

    x: Array
    before: Array
    after: Array
    lower: Array
    upper: Array
    alarm: NDArray[np.bool_]

    @property
    def largest(self) -> float:
        """The largest change of value outside the band; infinite where just one of the curves is defined."""
        size = np.abs(self.after - self.before)[self.alarm]
        return float(np.where(np.isnan(size), np.inf, size).max(initial=0.0))


def is_function(points: Points) -> bool:
    """Whether a curve has one value at every x (two at a jump) and goes from left to right.

    Examples
    --------
    >>> import numpy as np
    >>> jump = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 1.0]])
    >>> is_function(jump), is_function(jump[:, ::-1]), is_function(jump[::-1])
    (True, True, False)
    """
    x = points[finite(points), 0]
    return len(x) > 1 and bool(np.all(np.diff(x) >= -1e-9)) and float(x[-1] - x[0]) > _LEAST_WIDTH


def compare_values(
    old: Points, new: Points, tolerance: float = TOLERANCE, window: float = WINDOW, view: Array | None = None
) -> ValueDifference:
    """Compare two functions of x.

    Parameters
    ----------
    old, new
        Shape (n, 2); a row that is not finite is a break.
    view
        The part of the axes that both states show: ``[[left, right], [bottom, top]]``; by default all of it.
    """
    (left, right), (bottom, top) = np.array([[0.0, 1.0], [0.0, 1.0]]) if view is None else view
    pieces = [_pieces(points) for points in (old, new)]
    knots = np.concatenate([piece[:, 0] for piece in (*pieces[0], *pieces[1])])
    ends = np.concatenate([piece[[0, -1], 0] for piece in (*pieces[0], *pieces[1])])  # beside them a gap begins
    places = (knots, knots - window, knots + window, ends - _BESIDE * window, ends + _BESIDE * window)
    grid = np.unique(np.concatenate([*places, [left, right]]))
    grid = grid[(grid >= left) & (grid <= right)]
    sides = np.repeat(grid, 2)
    bounds = (bottom - _MARGIN, top + _MARGIN)
    (one, one_low, one_high), (other, other_low, other_high) = (
        [np.clip(values, *bounds) for values in (_values(part, grid), *_band(part, sides, window))] for part in pieces
    )
    seen = [(values > bounds[0]) & (values < bounds[1]) for values in (one, other)]
    with np.errstate(invalid="ignore"):
        alarm = (
            (other > one_high + tolerance)
            | (other < one_low - tolerance)
            | (one > other_high + tolerance)
            | (one < other_low - tolerance)
            # One curve is there, the other is not, not even close by; out of sight counts as not there.
            | (seen[0] & np.isnan(other_low))
            | (seen[1] & np.isnan(one_low))
        )
    return ValueDifference(sides, one, other, one_low - tolerance, one_high + tolerance, alarm)


def _pieces(points: Points) -> list[Points]:
    """Split at breaks; x never decreases within a piece, not even by rounding."""
    there = finite(points)
    starts = np.flatnonzero(there & ~np.r_[False, there[:-1]])
    ends = np.flatnonzero(there & ~np.r_[there[1:], False]) + 1
    pieces = [points[start:end].copy() for start, end in zip(starts, ends, strict=True)]
    for piece in pieces:
        piece[:, 0] = np.maximum.accumulate(piece[:, 0])
    return pieces


def _values(pieces: list[Points], grid: Array) -> Array:
    """Return the limits from the left and from the right at every x, alternating."""
    values = np.full((len(grid), 2), np.nan)
    for piece in pieces:
        x, y = piece.T
        inside = (grid >= x[0]) & (grid <= x[-1])
        at = grid[inside]
        found = np.empty((len(at), 2))
        for column, side in enumerate(("left", "right")):
            after = np.searchsorted(x, at, side=side)  # type: ignore[call-overload]
            after = np.clip(after, 1, max(len(x) - 1, 1))
            before = after - 1
            after = np.minimum(after, len(x) - 1)
            width = x[after] - x[before]
            share = np.clip((at - x[before]) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
            if side == "right":  # only a jump at the very end has no width here: take its far end
                share = np.where(width == 0.0, 1.0, share)
            found[:, column] = y[before] + share * (y[after] - y[before])
        values[inside] = found
    return values.reshape(-1)


def _band(pieces: list[Points], at: Array, window: float) -> tuple[Array, Array]:
    """Return the least and the largest value within the window around every x."""
    low, high = np.full(len(at), np.nan), np.full(len(at), np.nan)
    for piece in pieces:
        x, y = piece.T
        near = (at >= x[0] - window) & (at <= x[-1] + window)
        begin, end = np.maximum(at[near] - window, x[0]), np.minimum(at[near] + window, x[-1])
        first, last = np.searchsorted(x, begin, side="left"), np.searchsorted(x, end, side="right")
        ends = [np.interp(begin, x, y), np.interp(end, x, y)]
        for best, extreme, reduced, nothing in (
            (low, np.fmin, np.minimum, np.inf),
            (high, np.fmax, np.maximum, -np.inf),
        ):
            # Vertices first .. last-1 lie in the window; `reduceat` takes an empty range for a single element.
            padded = np.r_[y, nothing]
            inside = reduced.reduceat(padded, np.column_stack([first, last]).reshape(-1))[::2]
            inside = np.where(first < last, inside, nothing)
            best[near] = extreme(best[near], reduced(reduced(*ends), inside))
    return low, high

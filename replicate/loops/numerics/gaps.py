"""What intervals leave free: gaps between forbidden integral gains, and the highest ends of connected gaps.

At fixed other gains each frequency forbids an interval of ki. What is left over all frequencies are gaps. Seen over a
grid of the other gains, gaps of neighbours that overlap are connected, and a local maximum of ki is the upper end of
a gap that no connected one exceeds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Places = NDArray[np.intp]
Index = tuple[int, ...]

TOGETHER = 200  # ends of intervals that are compared with all intervals at once


class Gap(NamedTuple):
    """Ends of a gap, and which of the intervals bounds it from above."""

    bottom: float
    top: float
    bound: int


@dataclass(frozen=True)
class Gaps:
    """The gaps at the points of a grid, ascending at each point.

    Attributes
    ----------
    uppermost
        The end of the uppermost interval at each point of the grid.
    point
        The point of each gap, as its place in the flattened grid; ascending.
    bottom, top, bound
        Ends of each gap, and the interval that bounds it from above.
    """

    uppermost: Array
    point: Places
    bottom: Array
    top: Array
    bound: Places

    @classmethod
    def between(cls, parts: Iterable[tuple[Array, Array, Places]], *, rounding: float) -> Gaps:
        """Return the gaps above zero that the intervals (low, high) leave; intervals run along the last axis.

        The parts follow each other along the first axis of the grid: what is small stays close to the processor.
        Each says which intervals it holds; those that it lacks forbid nothing there.
        ``rounding`` is the relative width below which a gap is none. An interval that forbids nothing starts at inf.
        """
        found: list[tuple[Places, Array, Array, Places]] = []
        uppermost: list[Array] = []
        first = 0
        for low, high, names in parts:
            size = prod(low.shape[:-1])
            points, bottoms, tops, bounds = _gaps(low.reshape(size, -1), high.reshape(size, -1), rounding)
            found.append((first + points, bottoms, tops, names[bounds]))
            uppermost.append(high.max(axis=-1, initial=0.0))
            first += size
        return cls(np.concatenate(uppermost), *(np.concatenate(column) for column in zip(*found, strict=True)))

    def __iter__(self) -> Iterator[tuple[Index, Gap]]:
        """Yield the grid point and the ends of each gap."""
        return ((self._index(g), self._gap(g)) for g in range(self.top.size))

    def maxima(self) -> Iterator[tuple[Index, Gap, list[Gap]]]:
        """Yield (grid point, gap, connected gaps) for each gap whose upper end no connected gap exceeds."""
        gap, other = self._connected()
        highest = np.ones(self.top.size, dtype=bool)
        highest[gap[self.top[other] > self.top[gap]]] = False
        for g in np.nonzero(highest)[0].tolist():
            yield self._index(g), self._gap(g), [self._gap(o) for o in other[gap == g].tolist()]

    def _connected(self) -> tuple[Places, Places]:
        """Return the pairs of gaps that overlap at neighbouring points, each pair both ways round."""
        shape = self.uppermost.shape
        starts = np.searchsorted(self.point, np.arange(self.uppermost.size + 1))
        index = np.array(np.unravel_index(self.point, shape))
        pairs = []
        for step in product((-1, 0, 1), repeat=len(shape)):
            if step <= (0,) * len(shape):  # half of the directions: the others lead back
                continue
            moved = index + np.array(step)[:, None]
            gap = np.nonzero(np.all((moved >= 0) & (moved < np.array(shape)[:, None]), axis=0))[0]
            neighbour = np.ravel_multi_index(tuple(moved[:, gap]), shape)
            first, count = starts[neighbour], starts[neighbour + 1] - starts[neighbour]
            gap = np.repeat(gap, count)
            other = np.arange(gap.size) + np.repeat(first - np.cumsum(count) + count, count)
            overlap = (self.bottom[other] < self.top[gap]) & (self.top[other] > self.bottom[gap])
            pairs += [(gap[overlap], other[overlap]), (other[overlap], gap[overlap])]
        gap, other = (np.concatenate(side) for side in zip(*pairs, strict=True))
        return gap, other

    def _index(self, gap: int) -> Index:
        return tuple(int(i) for i in np.unravel_index(self.point[gap], self.uppermost.shape))

    def _gap(self, gap: int) -> Gap:
        return Gap(float(self.bottom[gap]), float(self.top[gap]), int(self.bound[gap]))


def _gaps(low: Array, high: Array, rounding: float) -> tuple[Places, Array, Array, Places]:
    """Return row, bottom, top and bounding interval of each gap that intervals, in rows, leave; ascending."""
    if low.size == 0:
        return (none := np.zeros(0, dtype=np.intp)), np.zeros(0), np.zeros(0), none
    points, bounds = np.nonzero(_may_bound_a_gap(low, high, rounding))
    tops = low[points, bounds]
    floors = np.empty(tops.size)
    for start in range(0, tops.size, TOGETHER):
        some = slice(start, start + TOGETHER)
        below = high[points[some]]
        below[low[points[some]] >= tops[some, None]] = 0.0
        floors[some] = np.max(below, axis=-1, initial=0.0)
    free = np.nonzero(tops > floors * (1.0 + rounding))[0]
    free = free[np.lexsort((tops[free], points[free]))]
    # two intervals may begin at the same place
    free = free[np.append(True, (np.diff(points[free]) > 0) | (np.diff(tops[free]) > 0.0))[: free.size]]
    return points[free], floors[free], tops[free], bounds[free]


def _may_bound_a_gap(low: Array, high: Array, rounding: float) -> NDArray[np.bool_]:
    """Return which lower ends are not covered by the next interval on either side, or by the one that reaches highest.

    Neighbours overlap as long as the frequency that forbids them changes steadily: few ends are left.
    """
    reach = high * (1.0 + rounding)
    free = np.isfinite(low) & (low > 0.0)
    free[:, 1:] &= (low[:, :-1] >= low[:, 1:]) | (reach[:, :-1] < low[:, 1:])
    free[:, :-1] &= (low[:, 1:] >= low[:, :-1]) | (reach[:, 1:] < low[:, :-1])
    highest = np.argmax(high, axis=-1)[:, None]
    free &= (np.take_along_axis(low, highest, axis=-1) >= low) | (np.take_along_axis(reach, highest, axis=-1) < low)
    return free

"""What intervals leave free: gaps between forbidden integral gains, and the highest ends of connected gaps.

At fixed other gains each frequency forbids an interval of ki. What is left over all frequencies are gaps. Seen over a
grid of the other gains, gaps of neighbours that overlap are connected, and a local maximum of ki is the upper end of
a gap that no connected one exceeds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from operator import add
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
    """The gaps at each point of a grid, ascending, and the end of the uppermost interval there."""

    at: dict[Index, list[Gap]]
    uppermost: Array

    @classmethod
    def between(cls, parts: Iterable[tuple[Array, Array, Places]], *, rounding: float) -> Gaps:
        """Return the gaps above zero that the intervals (low, high) leave; intervals run along the last axis.

        The parts follow each other along the first axis of the grid: what is small stays close to the processor.
        Each says which intervals it holds; those that it lacks forbid nothing there.
        ``rounding`` is the relative width below which a gap is none. An interval that forbids nothing starts at inf.
        """
        at: dict[Index, list[Gap]] = {}
        uppermost: list[Array] = []
        first = 0
        for low, high, names in parts:
            shape = low.shape[:-1]
            rows = low.reshape(-1, low.shape[-1]), high.reshape(-1, low.shape[-1])
            points, floors, tops, bounds = _gaps(*rows, rounding)
            ends = floors, tops, names[bounds]
            places = zip(*(index.tolist() for index in np.unravel_index(points, shape)), strict=True)
            for point, floor, top, bound in zip(places, *(part.tolist() for part in ends), strict=True):
                gaps = at.setdefault((first + point[0], *point[1:]), [])
                if not gaps or gaps[-1].top < top:
                    gaps.append(Gap(floor, top, bound))
            uppermost.append(high.max(axis=-1, initial=0.0))
            first += shape[0]
        return cls(at, np.concatenate(uppermost))

    def maxima(self) -> Iterator[tuple[Index, Gap, list[Gap]]]:
        """Yield (grid point, gap, connected gaps) for each gap whose upper end no connected gap exceeds."""
        steps = [step for step in product((-1, 0, 1), repeat=self.uppermost.ndim) if any(step)]
        for point, gaps in self.at.items():
            around = [g for step in steps for g in self.at.get(tuple(map(add, point, step)), ())]
            for gap in gaps:
                connected = [g for g in around if g.bottom < gap.top and g.top > gap.bottom]
                if all(gap.top >= g.top for g in connected):
                    yield point, gap, connected


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

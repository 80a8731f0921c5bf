"""What intervals leave free: gaps between forbidden integral gains, and the highest ends of connected gaps.

At fixed other gains each frequency forbids an interval of ki. What is left over all frequencies are gaps. Seen over a
grid of the other gains, gaps of neighbours that overlap are connected, and a local maximum of ki is the upper end of
a gap that no connected one exceeds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = tuple[int, ...]


@dataclass(frozen=True)
class Gap:
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
    def between(cls, low: Array, high: Array, *, rounding: float) -> Gaps:
        """Return the gaps above zero that the intervals (low, high) leave; intervals run along the last axis.

        ``rounding`` is the relative width below which a gap is none. An interval that forbids nothing starts at inf.
        """
        order = np.argsort(low, axis=-1)
        low = np.take_along_axis(low, order, axis=-1)
        covered = np.maximum.accumulate(np.take_along_axis(high, order, axis=-1), axis=-1)
        floor = np.maximum(np.concatenate([np.zeros_like(low[..., :1]), covered[..., :-1]], axis=-1), 0.0)
        at: dict[Index, list[Gap]] = {}
        for index in zip(*np.nonzero((low > floor * (1.0 + rounding)) & np.isfinite(low)), strict=True):
            point = tuple(int(i) for i in index[:-1])
            at.setdefault(point, []).append(Gap(float(floor[index]), float(low[index]), int(order[index])))
        return cls(at, np.maximum(covered[..., -1], 0.0))

    def maxima(self) -> Iterator[tuple[Index, Gap, list[Gap]]]:
        """Yield (grid point, gap, connected gaps) for each gap whose upper end no connected gap exceeds."""
        for point, gaps in self.at.items():
            steps = [step for step in product((-1, 0, 1), repeat=len(point)) if any(step)]
            around = [g for step in steps for g in self.at.get(tuple(np.add(point, step).tolist()), ())]
            for gap in gaps:
                connected = [g for g in around if g.bottom < gap.top and g.top > gap.bottom]
                if all(gap.top >= g.top for g in connected):
                    yield point, gap, connected

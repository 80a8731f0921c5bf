"""Jumps of derivatives of the control signal on their way around a loop: when they are back, and how smooth by then."""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from replicate.loops.time_domain.chain import Chain
from replicate.loops.time_domain.piece_flow import SAME, SMALLEST_JUMP, SMOOTHEST, Row, integrations

Array = NDArray[np.float64]
Jump = tuple[float, int, float]  # time, order of the derivative of the control signal, size


class PendingJumps:
    """The jumps that are still to come, as far as pieces of a march have to end at them.

    Parameters
    ----------
    chain, row
        The chain, and the control signal as one of its signals.
    delays
        The dead time of each of the chain's inputs.
    """

    def __init__(self, chain: Chain, row: Row, delays: Array) -> None:
        smoother = [integrations(chain, row, i, most=SMOOTHEST) for i in range(delays.size)]
        sizes = [abs(float(v)) if order == 0 else 1.0 for v, order in zip(row.v, smoother, strict=True)]
        self._ways = list(zip(delays.tolist(), smoother, sizes, strict=True))
        self._pending: list[Jump] = []

    @property
    def next(self) -> float:
        """The time of the next one; ``inf`` if there is none."""
        return self._pending[0][0] if self._pending else float("inf")

    def expect(self, time: float) -> None:
        """Note that the control signal jumps at a time."""
        heapq.heappush(self._pending, (time, 0, 1.0))

    def expect_load(self, time: float) -> None:
        """Note that a load jumps at a time, which arrives after each dead time."""
        for delay, smoother, size in self._ways:
            heapq.heappush(self._pending, (time + delay, smoother, size))

    def send(self, time: float, order: int, size: float = 1.0) -> None:
        """Note that a derivative of the control signal has jumped: it comes back after each dead time."""
        if order >= SMOOTHEST:
            return
        for delay, smoother, share in self._ways:
            if delay and size * share > SMALLEST_JUMP:
                heapq.heappush(self._pending, (time + delay, order + smoother, size * share))

    def pass_by(self, start: float) -> None:
        """Send around again what has come back by a time; of several at once, the least smooth."""
        while self.next <= start * (1.0 + SAME):
            time, order, size = heapq.heappop(self._pending)
            while self.next <= time * (1.0 + SAME):
                _, other, weight = heapq.heappop(self._pending)
                if other <= order:
                    order, size = other, max(weight, size) if other == order else weight
            self.send(time, order, size)

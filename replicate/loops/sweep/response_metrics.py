"""Metrics of many responses at once, read from their polynomials as `replicate.loops.time_domain.signal` does from one.

Samples only say which piece to look at and between which points; roots and extrema are polished on the polynomial.
A response in which an extremum nearly touches the level that counts is left to the single loop (``doubtful``).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev, series_roots
from replicate.loops.sweep import block_series
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.response_integrals import ResponseIntegrals
from replicate.loops.sweep.response_pieces import MARGIN, summits
from replicate.loops.time_domain.piecewise import FLAT
from replicate.loops.time_domain.signal import APPROACH, ARRIVAL, ROUNDING

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

TOUCHING = 5e-3  # of the range in a piece: an extremum so close to a level may cross it between samples


class ResponseMetrics(ResponseIntegrals):
    """The metrics of the responses of a block."""

    # ---- peak ------------------------------------------------------------------------------------------------------

    @cached_property
    def _summit(self) -> tuple[Array, Array]:
        """The largest deviation from the final value and its time."""
        high = np.where(self._exists, self._ranges[1], -np.inf)
        best = high.max(axis=0)
        high += self._slack
        piece, column = np.nonzero(self._exists & (high >= best))
        values = self._gathered(piece, column)
        top = np.argmax(values, axis=0)
        nodes = chebyshev.nodes(DEGREE)
        series = block_series.series(values)
        x = series_roots.maxima(series, nodes[np.maximum(top - 1, 0)], nodes[np.minimum(top + 1, DEGREE)])
        reached, at_node = series_roots.evaluate(series, x), values[top, np.arange(top.size)]
        # at rounding level, and where nothing moves, the polynomial and its node differ by nothing
        inner = (reached > at_node) & (np.ptp(values, axis=0) > 0.0)
        reached, x = np.where(inner, reached, at_node), np.where(inner, x, nodes[top])
        # a second summit in the same piece that may be the higher one
        moves = np.diff(values, axis=0)
        summit = (moves[:-1] > 0.0) & (moves[1:] <= 0.0)
        rivals = summit & (values[1:-1] + MARGIN * np.ptp(values, axis=0) >= reached)
        self.doubtful[column[np.sum(rivals, axis=0) > 1]] = True
        value, time = np.full(self.count, -np.inf), np.full(self.count, np.nan)
        order = np.lexsort((-piece, reached))  # the highest last, of equal ones the first
        value[column[order]], time[column[order]] = reached[order], self._time(piece, x)[order]
        later, its_time = self.responses.modes.summit()
        self.doubtful |= np.abs(later - value) <= self.responses.modes.error
        value, time = np.maximum(value, later), np.where(later > value, its_time, time)
        return np.where(self.responses.modes.found, np.maximum(value, 0.0), value), time

    def peak(self) -> Array:
        """Return the largest values."""
        return np.asarray(self.final + self._summit[0])

    def peak_time(self) -> Array:
        """Return when the peak is reached; ``inf`` where a response only approaches its final value from below."""
        value, time = self._summit
        low, high = self._ranges
        scale = np.where(self.final == 0.0, np.maximum(-low, high).max(axis=0), np.abs(self.final))
        level = APPROACH * scale
        approaches = value <= level if self.responses.settles else np.abs(value) <= level
        some = np.nonzero(approaches & ~self.responses.modes.found)[0]
        error = np.where(self._exists[:, some], np.maximum(-low[:, some], high[:, some]), 0.0)
        arrives = (error[:-1] > ARRIVAL * scale[some]) & (error[1:] <= level[some])
        self.doubtful[some] |= arrives.any(axis=0)
        # a peak that lasts, as where a long dead time lets the plant come to rest: when it begins is for one to say
        noise = FLAT * np.where(self.final == 0.0, scale, scale + np.maximum(-low, high).max(axis=0))
        lasts = self._exists & (high - low <= noise) & (high >= value - noise)
        self.doubtful |= lasts.any(axis=0) & ~approaches
        begins_there = np.maximum(-low[0], high[0]) <= level
        return np.where(approaches, np.where(begins_there, 0.0, np.inf), time)

    def overshoot(self) -> Array:
        """Return the largest excess over the final value, as a fraction of it."""
        with np.errstate(all="ignore"):
            excess = self._summit[0] / self.final
        return np.where(excess > ROUNDING, excess, 0.0)

    # ---- settling --------------------------------------------------------------------------------------------------

    def settling_time(self, band: float, *, one_sided: bool = False) -> tuple[Array, Flags]:
        """Return the last times outside the band, or above it, and which responses are outside at their end."""
        width = band * np.where(self.final == 0.0, 1.0, np.abs(self.final))
        low, high = self._ranges
        margin = width - self._slack
        outside = high > margin if one_sided else (high > margin) | (-low > margin)
        outside &= self._exists
        time = np.zeros(self.count)
        unsettled = np.zeros(self.count, dtype=bool)
        column = np.nonzero(outside.any(axis=0))[0]
        last = outside.shape[0] - 1
        while column.size:
            piece = last - np.argmax(outside[::-1, column], axis=0)
            dense = self._gathered(piece, column)
            series, nodes = block_series.series(dense), np.broadcast_to(chebyshev.nodes(DEGREE)[:, None], dense.shape)
            size, sign = (dense, np.ones(dense.shape)) if one_sided else (np.abs(dense), np.sign(dense))
            touching = summits(size, np.abs(size - width[column]) < MARGIN * np.ptp(dense, axis=0))
            nodes, dense = block_series.sharpened(series, nodes, dense, touching, sign)
            beyond = (dense if one_sided else np.abs(dense)) > width[column]
            some = beyond.any(axis=0)
            at = DEGREE - np.argmax(beyond[::-1], axis=0)
            at_end = some & (at == DEGREE)
            time[column[at_end]] = self._time(piece[at_end], np.ones(int(at_end.sum())))
            ended = at_end & (piece == self.responses.ends[column] - 1)
            unsettled[column[ended]] = True
            inside = np.nonzero(some & ~at_end)[0]
            if inside.size:
                before, sides = at[inside], sign[at[inside], inside]
                part = series[:, inside] * sides
                part[0] -= width[column[inside]]
                x = series_roots.roots(
                    part, nodes[before, inside], nodes[before + 1, inside],
                    sides * dense[before, inside] - width[column[inside]],
                    sides * dense[before + 1, inside] - width[column[inside]],
                )  # fmt: skip
                time[column[inside]] = self._time(piece[inside], x)
            outside[piece[~some], column[~some]] = False
            column = column[~some & outside[:, column].any(axis=0)]
        modes = self.responses.modes
        lasting = modes.last_outside(width, one_sided=one_sided)
        return np.where(np.isnan(lasting), time, lasting), unsettled & ~modes.found

    # ---- reaching a level ------------------------------------------------------------------------------------------

    def first_reach(self, fraction: float) -> tuple[Array, Flags]:
        """Return the first times at a fraction of the final value, and which responses do not reach it."""
        level = (fraction - 1.0) * self.final  # as a deviation
        reaching = self._exists & (self._ranges[1] + self._slack >= level)
        time = np.full(self.count, np.nan)
        column = np.nonzero(reaching.any(axis=0))[0]
        while column.size:
            piece = np.argmax(reaching[:, column], axis=0)
            series = block_series.series(self._gathered(piece, column))
            dense = block_series.samples(series)
            touching = summits(dense, np.abs(dense - level[column]) < TOUCHING * np.ptp(dense, axis=0))
            nodes, dense = block_series.sharpened(series, _dense(column.size), dense, touching, np.ones(dense.shape))
            beyond = dense >= level[column]
            some, at = beyond.any(axis=0), np.argmax(beyond, axis=0)
            at_start = some & (at == 0)
            time[column[at_start]] = self._time(piece[at_start], -np.ones(int(at_start.sum())))
            inside = np.nonzero(some & ~at_start)[0]
            if inside.size:
                chosen, before = column[inside], at[inside] - 1
                part = series[:, inside].copy()
                part[0] -= level[chosen]
                x = series_roots.roots(
                    part, nodes[before, inside], nodes[before + 1, inside],
                    dense[before, inside] - level[chosen], dense[before + 1, inside] - level[chosen],
                )  # fmt: skip
                time[chosen] = self._time(piece[inside], x)
            reaching[piece[~some], column[~some]] = False
            column = column[~some & reaching[:, column].any(axis=0)]
        missing = np.isnan(time)
        later = self.responses.modes.first_at(level)
        time = np.where(missing, later, time)
        # an oscillation reaches the level before it becomes the last mode, or it is left to the single loop
        self.doubtful |= missing & self.responses.modes.found & np.isnan(later)
        return time, missing & ~self.responses.modes.found


def _dense(count: int) -> Array:
    """Return the dense nodes as columns."""
    return np.broadcast_to(block_series.dense_nodes()[:, None], (block_series.DENSE, count))

"""The pieces of the responses of a block, and what each of them says by itself."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.marching import Responses

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

MARGIN = 0.04  # of the range in a piece: more than an extremum exceeds the values at the nodes


class ResponsePieces:
    """The responses of a block, in the block's unit of time.

    Attributes
    ----------
    doubtful : array, shape (n,)
        Which loops must be asked one by one; grows with the questions.
    """

    def __init__(self, responses: Responses) -> None:
        self.responses = responses
        self.pieces, self.final = responses.pieces, responses.final
        self.count = responses.final.size
        self.doubtful = responses.failed.copy()

    @property
    def end(self) -> float:
        """The end of the longest response."""
        return float(self.responses.lengths.sum())

    @cached_property
    def _ranges(self) -> tuple[Array, Array]:
        """Lowest and highest deviation at the nodes, shape (pieces, n); zero where a loop has no such piece."""
        low, high = (np.zeros((len(self.pieces), self.count)) for _ in range(2))
        for index, piece in enumerate(self.pieces):
            low[index, piece.columns], high[index, piece.columns] = piece.low, piece.high
        return low, high

    @cached_property
    def _slack(self) -> Array:
        """By how much an extremum may exceed the lowest and highest deviation at the nodes, shape (pieces, n)."""
        low, high = self._ranges
        slack = high - low
        slack *= MARGIN
        return slack

    @cached_property
    def _exists(self) -> Flags:
        pieces = len(self.pieces)
        exists = np.arange(pieces)[:, None] < self.responses.ends
        return np.asarray(exists & ~self.doubtful)

    def _gathered(self, piece: Places, column: Places) -> Array:
        """Return node values of some pieces of some loops, in the order given; shape (points, many)."""
        values = np.empty((DEGREE + 1, piece.size))
        order = np.argsort(piece, kind="stable")
        edges = np.searchsorted(piece[order], np.arange(len(self.pieces) + 1))
        for p in np.unique(piece):
            chosen = order[edges[p] : edges[p + 1]]
            place = np.searchsorted(self.pieces[p].columns, column[chosen])
            values[:, chosen] = self.pieces[p].values[:, place]
        return values

    def _time(self, piece: Places, x: Array) -> Array:
        lengths = self.responses.lengths
        starts = np.cumsum(lengths) - lengths
        return np.asarray(starts[piece] + 0.5 * (x + 1.0) * lengths[piece])


def summits(values: Array, candidates: Flags) -> Flags:
    """Return which candidates among samples are no lower than their neighbours, ends included."""
    columns = np.nonzero(candidates.any(axis=0))[0]
    part = values[:, columns]
    falls = part[1:] <= part[:-1]
    rises = part[1:] >= part[:-1]
    found = candidates[:, columns]
    found[:-1] &= falls
    found[1:] &= rises
    result = np.zeros(candidates.shape, dtype=bool)
    result[:, columns] = found
    return result

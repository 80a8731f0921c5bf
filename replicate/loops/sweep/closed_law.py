r"""A piece of many loops without dead time: each is a linear differential equation of its own, closed inside.

With e the deviation of the state from rest, :math:`\dot e = A e` with the closed loop's A. At the nodes of a piece
output and control signal are :math:`c\, e^{A t} e_0`, by the series of the exponential: pieces are short. Where all
that is quick has decayed they are made longer: the nodes of a piece twice as long lie at twice the times, and
:math:`e^{2 A t}` is a square.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.sweep.piece_law import LAST_ROWS, POINTS, WEIGHTS
from replicate.loops.time_domain.chain import Chain

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

TERMS = 48  # of the exponential's series
LARGEST = 8.0  # norm of the matrix times the piece up to which these suffice, and cancel little
RESOLVED = 1e-13  # last coefficients of a longer piece, relative to its own largest value; those that follow vary


@dataclass(frozen=True)
class ClosedLaw:
    """What a piece does to the states, column by column. States are deviations from rest.

    Attributes
    ----------
    flow : array, shape (points, states, states, n)
        States at the nodes from those at the start.
    rows : array, shape (2, states, n)
        Deviations of the output and of the plant's input from the states.
    rest : array, shape (states, n)
        States at rest.
    final : array, shape (n,)
        The plant's input at rest.
    gains : array, shape (4, n)
        Of the building blocks of the chain.
    too_long : array, shape (n,)
        Where the piece is too long for the series.
    """

    flow: Array
    rows: Array
    rest: Array
    final: Array
    gains: Array
    too_long: Flags

    @classmethod
    def of(cls, loops: LoopColumns, chain: Chain, length: float, setpoint: float, load: float) -> ClosedLaw:
        """Return the law of stable loops whose L vanishes at infinite frequency."""
        g, b = loops.gains, chain.b[:, 0]
        feedback, reference = chain.wx.T @ g, setpoint * (chain.wr @ g)  # u = feedback x + reference
        a = chain.a[:, :, None] + b[:, None, None] * feedback
        drive = b[:, None] * (reference + load) + (chain.e * setpoint)[:, None]
        rest = np.asarray(np.linalg.solve(np.moveaxis(a, 2, 0), -drive.T[:, :, None])[:, :, 0].T, dtype=float)
        rows = np.stack([chain.c[:, None] + chain.d[0] * feedback, feedback])  # output and control signal from x
        times = 0.5 * (chebyshev.nodes(DEGREE) + 1.0)
        power = np.broadcast_to(np.eye(chain.e.size)[:, :, None], a.shape)
        flow = np.repeat(power[None], POINTS, axis=0)
        for k in range(1, TERMS):
            power = _product(power, a) * (length / k)
            flow += (times**k)[:, None, None, None] * power
        resting = np.einsum("in,in->n", feedback, rest) + reference + load
        norm = length * np.abs(a).sum(axis=1).max(axis=0)
        return cls(flow, rows, rest, resting, g, ~(norm <= LARGEST))

    def take(self, columns: Places) -> ClosedLaw:
        """Return the law of some of the columns."""
        names = ("flow", "rows", "rest", "final", "gains", "too_long")
        return replace(self, **{name: getattr(self, name).take(columns, axis=-1) for name in names})

    def begun(self, state: Array) -> Array:
        """Return the states with which the first piece is entered."""
        return np.asarray(state - self.rest)

    def doubled(self) -> ClosedLaw:
        """Return the law of pieces twice as long."""
        return replace(self, flow=_product(self.flow, self.flow))

    def resolves(self, state: Array) -> Flags:
        """Return which columns have no more than rounding in the last coefficients of the piece that follows."""
        resolved = ~self.too_long
        for signal in self._signals(state):
            resolved &= np.abs(LAST_ROWS @ signal).max(axis=0) <= RESOLVED * np.abs(signal).max(axis=0)
        return resolved

    def apply(self, inputs: Array, leaving: Array, values: Array) -> tuple[Array, Array, Array]:
        """Do what `PieceLaw.apply` does; of what enters, only the state counts."""
        state = inputs[POINTS:-1]
        values[:], moved = self._signals(state)
        np.add(moved, self.final, out=leaving)
        end = np.einsum("ijn,jn->in", self.flow[-1], state)
        return end, WEIGHTS @ values, np.where(self.too_long, np.inf, LAST_ROWS @ leaving)

    def _signals(self, state: Array) -> tuple[Array, Array]:
        """Return deviations of output and plant's input at the nodes, shape (points, n) each."""
        inside = np.einsum("pijn,jn->pin", self.flow, state)
        output, control = (np.einsum("pin,in->pn", inside, row) for row in self.rows)
        return output, control


def _product(left: Array, right: Array) -> Array:
    """Return products of matrices, column by column."""
    return np.asarray(np.einsum("...ijn,...jkn->...ikn", left, right))

r"""A piece of many loops without dead time: each is a linear differential equation of its own, closed inside.

With e the deviation of the state from rest, :math:`\dot e = A e` with the closed loop's A. At the nodes of a piece
output and control signal are :math:`c\, e^{A t} e_0`, by the series of the exponential: pieces are short.
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

TERMS = 48  # of the exponential's series
LARGEST = 8.0  # norm of the matrix times the piece up to which these suffice, and cancel little


@dataclass(frozen=True)
class ClosedLaw:
    """What a piece does to the states, column by column.

    Attributes
    ----------
    signals : array, shape (2 points, states, n)
        Deviations of the output and of the plant's input at the nodes, from those of the states at the start.
    flow : array, shape (states, states, n)
        Deviations of the states at the end.
    rest : array, shape (states, n)
        States at rest.
    final : array, shape (2, n)
        Output and plant's input at rest.
    gains : array, shape (4, n)
        Of the building blocks of the chain.
    too_long : array, shape (n,)
        Where the piece is too long for the series.
    """

    signals: Array
    flow: Array
    rest: Array
    final: Array
    gains: Array
    too_long: NDArray[np.bool_]

    @classmethod
    def of(cls, loops: LoopColumns, chain: Chain, length: float, setpoint: float, load: float) -> ClosedLaw:
        """Return the law of stable loops whose L vanishes at infinite frequency."""
        g, b = loops.gains, chain.b[:, 0]
        feedback, reference = chain.wx.T @ g, setpoint * (chain.wr @ g)  # u = feedback x + reference
        a = chain.a[:, :, None] + b[:, None, None] * feedback
        drive = b[:, None] * (reference + load) + (chain.e * setpoint)[:, None]
        rest = np.asarray(np.linalg.solve(np.moveaxis(a, 2, 0), -drive.T[:, :, None])[:, :, 0].T, dtype=float)
        rows = np.stack([chain.c[:, None] + chain.d[0] * feedback, feedback])  # output and control signal from x
        power = np.broadcast_to(np.eye(chain.e.size)[:, :, None], a.shape)
        flow, terms = power.copy(), [rows]
        for k in range(1, TERMS):
            power = np.einsum("ijn,jkn->ikn", power, a) * (length / k)
            flow += power
            terms.append(np.einsum("sin,ikn->skn", rows, power))
        powers = (0.5 * (chebyshev.nodes(DEGREE)[:, None] + 1.0)) ** np.arange(TERMS)
        signals = np.tensordot(powers, np.stack(terms), 1)  # (points, 2, states, n)
        resting = np.einsum("in,in->n", feedback, rest) + reference + load
        final = np.stack([chain.c @ rest + chain.d[0] * resting, resting])
        norm = length * np.abs(a).sum(axis=1).max(axis=0)
        return cls(
            np.concatenate([signals[:, 0], signals[:, 1]]), flow, rest, final, g, ~(norm <= LARGEST)
        )  # fmt: skip

    def take(self, columns: Places) -> ClosedLaw:
        """Return the law of some of the columns."""
        names = ("signals", "flow", "rest", "final", "gains", "too_long")
        return replace(self, **{name: getattr(self, name).take(columns, axis=-1) for name in names})

    def apply(self, inputs: Array, leaving: Array) -> tuple[Array, Array, Array, Array]:
        """Return what `PieceLaw.apply` does; of what enters, only the state counts."""
        deviation = inputs[POINTS:-1] - self.rest
        moved = np.einsum("pin,in->pn", self.signals, deviation)
        output = moved[:POINTS] + self.final[0]
        leaving[:] = moved[POINTS:] + self.final[1]
        state = np.einsum("ijn,jn->in", self.flow, deviation) + self.rest
        return output, state, WEIGHTS @ output, np.where(self.too_long, np.inf, LAST_ROWS @ leaving)

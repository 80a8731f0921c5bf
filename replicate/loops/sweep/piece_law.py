"""The fixed map of a piece and the control law: what a piece of many responses at once does to what enters it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.time_domain.chain import Chain
from replicate.loops.time_domain.method_of_steps import piece_map

Array = NDArray[np.float64]

POINTS = DEGREE + 1
WEIGHTS = chebyshev.integration(DEGREE)[-1]
TAIL = 2  # coefficients that say whether a piece is resolved
LAST_ROWS = chebyshev.values_to_coefficients(DEGREE)[-TAIL:]


@dataclass
class PieceLaw:
    """The fixed map of a piece and the control law of each column.

    The map gives node values of the output and of those building blocks of the control signal that are not the output
    (`PieceMap`), of each the last coefficients, the state at the end, and the integral of the output.
    """

    blocks: Array
    used: tuple[int, ...]  # the building blocks that are not the output
    measures_output: bool  # whether the filtered output is the output itself
    gains: Array  # shape (4, n)
    constant: Array  # what set-point and load add to the plant's input by themselves
    final: Array  # output at rest
    result: Array  # the map's values for one piece

    @classmethod
    def of(cls, loops: LoopColumns, chain: Chain, length: float, setpoint: float, load: float) -> PieceLaw:
        """Return the law of loops whose chain is given, for pieces of a length and steps of given heights."""
        fixed = piece_map(chain, length, DEGREE)
        gains = loops.gains
        plain = bool(np.array_equal(chain.wx[1], chain.c) and np.array_equal(chain.wv[1], chain.d))
        direct = not chain.wx[0].any()  # no set-point filter: the filtered set-point is the set-point
        in_form = (loops.form.k, loops.form.k, loops.form.ki, loops.form.kd)
        used = [w for w in range(4) if in_form[w] and not (w == 1 and plain) and not (w == 0 and direct)]
        parts = [fixed.output, *(fixed.basis[w] for w in used)]
        blocks = np.concatenate([*parts, *(LAST_ROWS @ part for part in parts), fixed.state, [WEIGHTS @ fixed.output]])
        constant = gains[0] * (setpoint * chain.wr[0]) if direct else np.zeros(len(loops))
        final, _ = loops.final(setpoint, load)
        result = np.empty((blocks.shape[0], len(loops)))
        return cls(blocks, tuple(used), plain, gains, constant + load, final, result)

    def take(self, columns: Places) -> PieceLaw:
        """Return the law of some of the columns."""
        result = np.empty((self.blocks.shape[0], columns.size))
        constant, final = self.constant[columns], self.final[columns]
        return replace(self, gains=self.gains[:, columns], constant=constant, final=final, result=result)

    def begun(self, state: Array) -> Array:
        """Return the states with which the first piece is entered."""
        return state

    def apply(self, inputs: Array, leaving: Array, values: Array) -> tuple[Array, Array, Array]:
        """Return state at the end, integral of the output's deviation and last coefficients of the plant's input.

        ``leaving`` is filled with the plant's input, ``values`` with the output's deviation from its final value. The
        arrays returned hold until the next piece.
        """
        parts = len(self.used) + 1
        result = np.matmul(self.blocks, inputs, out=self.result)
        signals, rest = result[: parts * POINTS].reshape(parts, POINTS, -1), result[parts * POINTS :]
        tails = rest[: parts * TAIL].reshape(parts, TAIL, -1)
        tail = np.zeros_like(tails[0])
        if self.measures_output:
            np.multiply(signals[0], self.gains[1], out=leaving)
            tail += tails[0] * self.gains[1]
        else:
            leaving[:] = 0.0
        leaving += self.constant
        for place, row in enumerate(self.used, start=1):
            signals[place] *= self.gains[row]
            leaving += signals[place]
            tail += tails[place] * self.gains[row]
        np.subtract(signals[0], self.final, out=values)
        return rest[parts * TAIL : -1].copy(), rest[-1] - 2.0 * self.final, tail

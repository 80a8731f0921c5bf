"""First peaks of many responses at once, polished together on their piecewise polynomials.

The samples only say where to look; every value returned is that at a root of the polynomial's slope, by Newton's
method.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev

Array = NDArray[np.float64]
Index = NDArray[np.intp]

SAMPLES = 40  # per piece of degree 18
NEWTON_STEPS = 8
ROUNDING = 1e-13  # relative to the final value


class Responses:
    """Step responses as piecewise Chebyshev series on equally long pieces.

    Parameters
    ----------
    coefficients
        Shape (loops, pieces, degree + 1).
    length
        Duration of a piece.
    final
        Final value of every response, shape (loops,), positive.
    """

    def __init__(self, coefficients: Array, length: float, final: Array) -> None:
        self.coefficients = coefficients
        self.length = length
        self.final = final
        self.loops, self.pieces, size = coefficients.shape
        self._x = chebyshev.nodes(SAMPLES - 1)
        self._samples = (coefficients @ chebyshev.evaluation(size - 1, SAMPLES)).reshape(self.loops, -1)

    def first_maximum(self) -> Array:
        """Return the first local maximum above the final value; the final value where there is none."""
        value = self.final.copy()
        above = self._samples > (self.final * (1.0 + ROUNDING))[:, None]
        loops = np.nonzero(above.any(axis=1))[0]
        if loops.size:
            falling = np.zeros_like(above[loops])
            # by more than rounding: where two pieces meet, the samples repeat
            falling[:, :-1] = np.diff(self._samples[loops], axis=1) < -ROUNDING * self.final[loops, None]
            first = np.argmax(above[loops] & falling, axis=1)
            value[loops] = np.maximum(self._top(loops, first)[0], self.final[loops])
        return value

    def _series(self, loops: Index, piece: Index) -> Array:
        return np.ascontiguousarray(self.coefficients[loops, piece].T)

    def _top(self, loops: Index, sample: Index) -> tuple[Array, Array]:
        """Polish the local maxima next to given samples; returns values and times."""
        piece, place = np.divmod(sample, SAMPLES)
        value, x = self._polish(loops, piece, self._x[place])
        # beside an end of its piece a maximum may belong to the neighbour
        for side, step in ((-1.0, -1), (1.0, 1)):
            edge = (x == side) & (piece + step >= 0) & (piece + step < self.pieces)
            if edge.any():
                other = piece[edge] + step
                beside, there = self._polish(loops[edge], other, np.full(other.size, -side))
                better = beside > value[edge]
                chosen = np.nonzero(edge)[0][better]
                value[chosen], x[chosen], piece[chosen] = beside[better], there[better], other[better]
        return value, (piece + 0.5 * (x + 1.0)) * self.length

    def _polish(self, loops: Index, piece: Index, x: Array) -> tuple[Array, Array]:
        series = self._series(loops, piece)
        slope, bend = cheb.chebder(series), cheb.chebder(series, 2)
        for _ in range(NEWTON_STEPS):
            curvature = cheb.chebval(x, bend, tensor=False)
            step = np.divide(
                cheb.chebval(x, slope, tensor=False), curvature, out=np.zeros_like(x), where=curvature < 0.0
            )
            x = np.clip(x - step, -1.0, 1.0)
        return np.asarray(cheb.chebval(x, series, tensor=False)), x

r"""What a loop transfer function with feedthrough does at infinite frequency: it goes round a curve for ever.

.. math:: L(i\omega) \to d_0 + \sum_j d_j e^{-i\omega L_j}

Where the dead times are whole multiples of one, n_j h, that is a closed curve with the parameter :math:`\varphi =
\omega h`. Dead times without a common measure turn independently of one another (Kronecker's theorem): then L comes as
close as one likes to the circle around d_0 with the radius :math:`\sum |d_j|`, which encloses all the others. Where
only some of the dead times are multiples of one, L fills the image of a torus, with an angle for each group of them:
`replicate.loops.frequency_domain.limit_torus`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from replicate.loops.errors import LoopError
from replicate.loops.numerics.bracketed import bracketed_root

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

RATIO = 64  # largest denominator of a ratio of two dead times that counts as rational,
SAME = 1e-9  # and the relative difference from it that is rounding
PER_TURN = 64  # points on a turn of the fastest term
CLOSE = 1e-9  # of the parameter of an extremum: its square is rounding


@dataclass(frozen=True)
class LimitCurve:
    """The curve that L(i w) approaches at infinite frequency; a point where nothing is delayed.

    Attributes
    ----------
    direct
        d_0, the limit of what has no dead time.
    delayed : array, shape (n,)
        d_j, the limits of the terms with dead time.
    steps : array, shape (n,)
        Their dead times as multiples of one.
    hole
        Radius of the circle about d_0 inside of which L does not come; of terms that turn independently.
    """

    direct: float
    delayed: Array
    steps: NDArray[np.intp]
    hole: float = 0.0

    @classmethod
    def circle(cls, direct: float, delayed: Array) -> LimitCurve:
        """Return the outermost of the circles that terms reach which turn independently."""
        sizes = np.abs(delayed)
        hole = max(2.0 * float(sizes.max()) - float(sizes.sum()), 0.0)
        return cls(direct, np.array([sizes.sum()]), np.ones(1, dtype=np.intp), hole)

    def __call__(self, angle: ArrayLike) -> ComplexArray:
        """Evaluate the curve at angles of any shape."""
        turns = np.exp(-1j * np.asarray(angle, dtype=float)[..., None] * self.steps)
        return np.asarray(self.direct + turns @ self.delayed)

    @cached_property
    def _angles(self) -> Array:
        """A grid over half a turn, the other half being its mirror image; of a circle, the ends of its diameter."""
        per_turn = PER_TURN if self.delayed.size > 1 else 1
        return np.linspace(0.0, np.pi, per_turn * int(np.max(self.steps, initial=1)) + 1)

    @cached_property
    def _values(self) -> ComplexArray:
        return self(self._angles)

    @property
    def reached(self) -> bool:
        """Whether L comes close to all of the curve; else what is read from it is a bound."""
        return True

    def refuse(self, what: str) -> None:
        """Say that a quantity is not known, as the curve that decides it may be a bound only.

        Raises
        ------
        LoopError
            Always.
        """
        why = "|L| does not vanish at high frequency, and of its dead times only some belong together"
        msg = f"the {what} is not known: {why}"
        raise LoopError(msg)

    @property
    def size(self) -> float:
        """The largest modulus on the curve."""
        return self.highest(np.abs)

    @property
    def lowest(self) -> float:
        """The smallest real part on the curve."""
        return -self.highest(lambda value: -value.real)

    def highest_anywhere(self, magnitude: Callable[[ComplexArray], Array]) -> float:
        """Return the largest value of a magnitude on the curve and on the edge of its hole, also off the real axis."""
        whole = replace(self, delayed=np.append(self.delayed, 0.0), steps=np.append(self.steps, 1))
        if not self.hole:
            return whole.highest(magnitude)
        edge = replace(whole, delayed=np.array([self.hole, 0.0]))
        return max(whole.highest(magnitude), edge.highest(magnitude))

    def highest(self, magnitude: Callable[[ComplexArray], Array]) -> float:
        """Return the largest value of a magnitude on the curve; on a circle it must be reached on the real axis."""
        values = magnitude(self._values)
        best, last = float(values.max()), values.size - 1
        if not np.isfinite(best) or self.delayed.size <= 1:
            return best
        higher = (values >= np.append(values[1:], -np.inf)) & (values >= np.append(-np.inf, values[:-1]))
        for i in np.nonzero(higher)[0].tolist():
            around = self._angles[max(i - 1, 0)], self._angles[min(i + 1, last)]
            found = minimize_scalar(
                lambda angle: -float(magnitude(self(angle))), bounds=around, method="bounded", options={"xatol": CLOSE}
            )
            best = max(best, -float(found.fun))
        return best

    @cached_property
    def real_values(self) -> Array:
        """The values at which the curve meets the real axis."""
        imaginary = self._values.imag
        turned = 1 + np.nonzero(imaginary[1:-2] * imaginary[2:-1] < 0.0)[0]  # at both ends it is real by symmetry
        inside = [
            bracketed_root(lambda angle: float(self(angle).imag), self._angles[i], self._angles[i + 1]) for i in turned
        ]
        return np.asarray(self([0.0, *inside, np.pi]).real)


VANISHING = LimitCurve(0.0, np.empty(0), np.empty(0, dtype=np.intp))  # of most loops


def multiples(dead_times: Array) -> NDArray[np.intp] | None:
    """Return dead times as multiples of the longest one that all of them are multiples of; None if there is none."""
    ratios = dead_times / np.min(dead_times, initial=np.inf)
    for denominator in range(1, RATIO):
        steps = np.round(ratios * denominator)
        if np.all(np.abs(ratios * denominator - steps) < SAME * steps):
            return steps.astype(np.intp)
    return None

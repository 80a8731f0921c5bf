r"""What a loop transfer function approaches at infinite frequency, where only some dead times have a common measure.

Dead times that are whole multiples of one, n_j h, share an angle; each such group turns by itself (Kronecker):

.. math:: L(i\omega) \to d_0 + \sum_g \sum_{j \in g} d_j e^{-i n_j \varphi_g}

for all angles :math:`\varphi_g`. That holds if no whole multiples of the groups' measures add up to zero. Where they do
(dead times 1, sqrt(2) and 1 + sqrt(2)), L reaches only a part of this, and what is computed from it is a bound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from replicate.loops.frequency_domain.limit_curve import CLOSE, SAME, LimitCurve, multiples

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PER_TURN = 32  # points on a turn of the fastest term of a group
MOST_POINTS = 100_000  # of the whole torus
MOST_RELATIONS = 100_000  # whole multiples tried
LARGEST_MULTIPLE = 12  # of them; an angle that repeats itself later is as good as independent
MOST_POLISHED = 6  # of the highest local maxima on the grid
EPS = 1e-15


def limit_of(limits: Array, dead_times: Array) -> LimitCurve:
    """Return what terms with these limits at infinite frequency approach together.

    Parameters
    ----------
    limits, dead_times : array, shape (n,)
        The dead times ascending.
    """
    turning = (dead_times > 0.0) & (limits != 0.0)
    direct, delayed = float(limits[dead_times == 0.0].sum()), limits[turning]
    steps = multiples(dead_times[turning])
    if steps is not None:
        return LimitCurve(direct, delayed, steps)
    circle = LimitCurve.circle(direct, delayed)
    groups, measures = _groups(dead_times[turning])
    independent = bool(groups) and not _related(measures)
    if independent and len(groups) == delayed.size:
        return circle
    points = np.prod([float(PER_TURN * group.max()) for group in groups])
    known = tuple(groups) if independent and points <= MOST_POINTS else ()
    return LimitTorus(direct, circle.delayed, circle.steps, groups=known, terms=delayed)


@dataclass(frozen=True)
class LimitTorus(LimitCurve):
    """The values that L approaches; as a curve it is the circle around all of them.

    Attributes
    ----------
    groups : tuple of arrays, each of shape (n,)
        Of each group the multiples n_j, 0 for the terms of others; none where only the circle is known.
    terms : array, shape (n,)
        The limits d_j.
    """

    groups: tuple[NDArray[np.intp], ...] = ()
    terms: Array = field(default_factory=lambda: np.empty(0))

    @property
    def reached(self) -> bool:
        """Whether L comes close to all of it."""
        return bool(self.groups)

    @property
    def real_values(self) -> Array:
        """None: L may be real anywhere between the ends of the circle's diameter, or not at all."""
        return np.empty(0)

    def highest(self, magnitude: Callable[[ComplexArray], Array]) -> float:
        """Return the largest value of a magnitude on the torus, or a bound where only the circle is known."""
        if not self.groups:
            return super().highest(magnitude)

        def at(angles: Array) -> Array:
            turns = np.exp(-1j * angles @ np.array(self.groups))
            return magnitude(np.asarray(self.direct + turns @ self.terms))

        def below(angle: NDArray[Any]) -> float:
            return -float(at(angle))

        sides = [np.arange(PER_TURN * int(group.max())) for group in self.groups]
        angles = np.stack(np.meshgrid(*(2.0 * np.pi * side / side.size for side in sides), indexing="ij"), axis=-1)
        values = at(angles)
        best = float(values.max())
        if not np.isfinite(best):
            return best
        top = np.ones(values.shape, dtype=bool)
        for axis, step in product(range(values.ndim), (1, -1)):
            top &= values >= np.roll(values, step, axis)
        starts = angles[top][np.argsort(-values[top], kind="stable")[:MOST_POLISHED]]
        for start in starts:
            found = minimize(below, start, method="Nelder-Mead", options={"xatol": CLOSE, "fatol": EPS})
            best = max(best, -float(found.fun))
        return best

    def highest_anywhere(self, magnitude: Callable[[ComplexArray], Array]) -> float:
        """Return the same for a magnitude that need not be highest on the real axis."""
        return self.highest(magnitude) if self.groups else super().highest_anywhere(magnitude)


def _groups(dead_times: Array) -> tuple[list[NDArray[np.intp]], Array]:
    """Return for each group the multiples, 0 for dead times of other groups, and the groups' measures."""
    members: list[list[int]] = []
    for j, dead_time in enumerate(dead_times):
        for group in members:
            if multiples(np.array([dead_times[group[0]], dead_time])) is not None:
                group.append(j)
                break
        else:
            members.append([j])
    groups, measures = [], []
    for group in members:
        steps = multiples(dead_times[group])
        if steps is None:  # a measure too fine
            return [], np.empty(0)
        whole = np.zeros(dead_times.size, dtype=np.intp)
        whole[group] = steps
        groups.append(whole)
        measures.append(dead_times[group[0]] / whole[group[0]])
    return groups, np.array(measures)


def _related(measures: Array) -> bool:
    """Return whether whole multiples of three or more measures, no two of which have a common one, add up to zero."""
    if measures.size < 3:
        return False
    largest = min(LARGEST_MULTIPLE, int(0.5 * (MOST_RELATIONS ** (1.0 / measures.size) - 1.0)))
    if not largest:
        return True  # so many that it cannot be said
    span = np.arange(-largest, largest + 1)
    multiple = np.stack(np.meshgrid(*[span] * measures.size), axis=-1).reshape(-1, measures.size)
    multiple = multiple[multiple.any(axis=1)]
    return bool(np.any(np.abs(multiple @ measures) < SAME * (np.abs(multiple) @ measures)))

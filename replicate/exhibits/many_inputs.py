"""Ranges and the joint point over a box of many inputs, from derivatives at its middle.

The corners of a box of many inputs cannot all be evaluated. Where a quantity changes in one direction with each input,
its extremes are at two of them, those to which its derivatives point. These two are evaluated for every quantity; so
both ends of a range are values that the quantity takes. That it takes none beyond them is found by this search, not
proven. The point at which most quantities hold is found by linear programming on the derivatives, and evaluated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from replicate.exhibits.joint_point import Target
from replicate.exhibits.quadratic_model import Function

_MARGIN = 0.05  # of the half-width of a printed interval, left to what is not linear


@dataclass
class ManyInputs:
    """Functions over a box of many inputs.

    Attributes
    ----------
    function
        Called once for each point.
    centre, half
        Shape (d,).
    """

    function: Function
    centre: np.ndarray
    half: np.ndarray
    points: list[np.ndarray] = field(default_factory=list)
    values: list[np.ndarray] = field(default_factory=list)
    slopes: np.ndarray = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        """Evaluate the middle, the middle of the sides, and the corners to which the derivatives point."""
        self.at(self.centre)
        sides = self.half * np.eye(len(self.half))
        self.slopes = np.array([(self.at(self.centre + side) - self.at(self.centre - side)) / 2 for side in sides])
        for corner in dict.fromkeys(tuple(column) for column in np.sign(np.nan_to_num(self.slopes)).T):
            for side in (-1.0, 1.0):
                self.at(self.centre + side * np.array(corner) * self.half)

    def at(self, point: np.ndarray) -> np.ndarray:
        """Return the values of all functions at a point of the box."""
        self.points.append(point)
        self.values.append(np.asarray(self.function(point), dtype=float))
        return self.values[-1]

    def range(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest and largest value of each function; NaN where it has none somewhere."""
        found = np.array(self.values)
        return found.min(axis=0), found.max(axis=0)

    def joint_point(self, lower: np.ndarray, upper: np.ndarray, needed: np.ndarray) -> np.ndarray:
        """Return the point at which most functions lie in their intervals; as `joint_point.joint_point`."""
        target = Target((lower + upper) / 2, (upper - lower) / 2, needed)
        asked = [int(i) for i in np.nonzero(target.asked)[0]]
        order = sorted(asked, key=lambda i: (not needed[i], self._distance(i, target)))
        held, scaled = list[int](), np.zeros(len(self.centre))
        for place in order:
            found = self._within([*held, place], target)
            if found is not None:
                held, scaled = [*held, place], found
        candidates = [self.centre, self.centre + scaled * self.half, *self.points]
        ranks = [(*target.rank(self.at(point)), -i) for i, point in enumerate(candidates)]
        return np.asarray(candidates[max(range(len(candidates)), key=lambda i: ranks[i])])

    def _distance(self, place: int, target: Target) -> float:
        """Return how far from its interval a function is at the centre, as a part of what its inputs leave open."""
        reach = np.abs(self.slopes[:, place]).sum()
        return float(abs(self.values[0][place] - target.middle[place]) / reach) if reach else np.inf

    def _within(self, places: Sequence[int], target: Target) -> np.ndarray | None:
        """Return the scaled point at which linear models of some functions are deepest in their intervals, if any."""
        from scipy.optimize import linprog

        chosen = list(places)
        rows = self.slopes[:, chosen].T
        off = self.values[0][chosen] - target.middle[chosen]
        half = target.half[chosen]
        if not np.isfinite(rows).all() or not np.isfinite(off).all():
            return None
        # |off + rows x| <= (1 - depth) half, -1 <= x <= 1: as deep as possible
        system = np.vstack([np.column_stack([rows, half]), np.column_stack([-rows, half])])
        limits = np.concatenate([half - off, half + off])
        cost = np.append(np.zeros(len(self.centre)), -1.0)
        bounds = [(-1.0, 1.0)] * len(self.centre) + [(_MARGIN, 1.0)]
        found = linprog(cost, A_ub=system, b_ub=limits, bounds=bounds)
        return np.asarray(found.x)[:-1] if found.status == 0 else None

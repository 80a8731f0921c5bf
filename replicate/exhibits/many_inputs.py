"""Ranges and the joint point over a box of many inputs, from derivatives at its middle.

The corners of a box of many inputs cannot all be evaluated. Where a quantity changes in one direction with each input,
its extremes are at two of them, those to which its derivatives point. These two are evaluated for every quantity; so
both ends of a range are values that the quantity takes. That it takes none beyond them is found by this search, not
proven. The point at which most quantities hold is found by linear programming on the derivatives, and evaluated.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from replicate.exhibits.joint_point import Target
from replicate.exhibits.rounds import Asking, Sampled

_MARGIN = 0.05  # of the half-width of a printed interval, left to what is not linear


class ManyInputs(Sampled):
    """Functions over a box of many inputs.

    Parameters
    ----------
    centre, half
        Of the box, shape (d,).
    """

    def __init__(self, centre: np.ndarray, half: np.ndarray) -> None:
        super().__init__(centre, half)
        self.slopes = np.empty((0, 0))

    def explore(self) -> Asking[None]:
        """Ask for the middle, the middle of the sides, and the corners to which the derivatives point."""
        sides = self.half * np.eye(len(self.half))
        found = yield from self.ask([self.centre, *(self.centre + sides), *(self.centre - sides)])
        above, below = np.split(found[1:], 2)
        self.slopes = (above - below) / 2
        corners = dict.fromkeys(tuple(column) for column in np.sign(np.nan_to_num(self.slopes)).T)
        yield from self.ask([self.centre + s * np.array(corner) * self.half for corner in corners for s in (-1.0, 1.0)])

    def joint_point(self, target: Target) -> Asking[np.ndarray]:
        """Return the point at which most functions lie in their intervals, after `explore`; as `joint_point`."""
        asked = [int(i) for i in np.nonzero(target.asked)[0]]
        order = sorted(asked, key=lambda i: (not target.needed[i], self._distance(i, target)))
        held, scaled = list[int](), np.zeros(len(self.centre))
        for place in order:
            found = self._within([*held, place], target)
            if found is not None:
                held, scaled = [*held, place], found
        candidates = [self.centre, self.centre + scaled * self.half, *self.points]
        yield from self.ask(candidates)
        return target.best(self, candidates)

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

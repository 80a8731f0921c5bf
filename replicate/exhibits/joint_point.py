"""One point of the box of the printed inputs at which as many quantities of a case as possible round to their print.

The cells of a case share their inputs: that each of them could be right for some inputs does not mean that all of them
could be right for the same.
"""

from __future__ import annotations

import numpy as np

from replicate.exhibits.quadratic_model import Search, fine, grid_point
from replicate.exhibits.rounds import Points, Sampled

_ZOOMS = 3
_SHRINK = 0.15
_TRIED = 3  # of the points evaluated so far, the best are tried as well


def candidates(search: Search, target: Target) -> Points:
    """Return points of which one is the best: the centre first, what the models say, the best that are known.

    Parameters
    ----------
    search
        The quantities over the box, which it has divided.
    target
        What they should be.
    """
    found = [search.centre]
    asked, side = np.nonzero(target.asked)[0], fine(len(search.centre))
    for part in search.parts:
        centre, size = np.zeros(len(search.centre)), 1.0
        for _ in range(_ZOOMS):
            axes = [np.clip(x + size * side, -1.0, 1.0) for x in centre]
            centre = grid_point(axes, int(np.argmax(target.ranks(part.on_grid(axes, asked)))))
            size *= _SHRINK
        found.append(part.point(centre))
    return found + [search.points[i] for i in _best_known(target, search)]


class Target:
    """What the quantities should be.

    Parameters
    ----------
    lower, upper
        The interval that each quantity should lie in, shape (m,); NaN where nothing is printed.
    needed
        Those that hold for the printed inputs themselves and should not be given up for others, shape (m,).
    """

    def __init__(self, lower: np.ndarray, upper: np.ndarray, needed: np.ndarray) -> None:
        self.middle, self.half, self.needed = (lower + upper) / 2, (upper - lower) / 2, needed
        self.asked = np.isfinite(self.middle)

    def ranks(self, values: np.ndarray) -> np.ndarray:
        """Return one number for each point, larger the better, from the quantities asked for there, shape (k, n)."""
        # how far inside its interval a quantity is: 1 in the middle, 0 at the ends; NaN is nowhere
        with np.errstate(invalid="ignore"):
            slack = 1.0 - np.abs(values - self.middle[self.asked, None]) / self.half[self.asked, None]
        held = slack >= 0.0
        least = np.where(held, slack, 1.0).min(axis=0, initial=1.0)
        weights = 1.0 + (self.asked.size + 1) * self.needed[self.asked]
        return np.asarray(weights @ held + least / 2)

    def best(self, known: Sampled, points: Points) -> np.ndarray:
        """Return the best of some points at which the quantities are known.

        Best is where first the most needed quantities hold, then the most others; of equal points the first.
        """
        values = np.array([known.at(point) for point in points])
        return points[int(np.argmax(np.floor(self.ranks(values.T[self.asked]))))]


def _best_known(target: Target, search: Search) -> list[int]:
    ranks = target.ranks(np.array(search.values).T[target.asked])
    return [int(i) for i in np.argsort(-ranks, kind="stable")[:_TRIED]]

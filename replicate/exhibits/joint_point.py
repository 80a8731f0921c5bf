"""One point of the box of the printed inputs at which as many quantities of a case as possible round to their print.

The cells of a case share their inputs: that each of them could be right for some inputs does not mean that all of them
could be right for the same.
"""

from __future__ import annotations

import numpy as np

from replicate.exhibits.quadratic_model import Part, Search
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
    for part, scaled in search.searched():
        where = scaled
        centre, size = np.zeros(len(search.centre)), 1.0
        for _ in range(_ZOOMS):
            centre = where[_best(target, part, where)]
            size *= _SHRINK
            where = np.clip(centre + size * scaled, -1.0, 1.0)
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

    def slack(self, values: np.ndarray) -> np.ndarray:
        """Return, by quantity, how far inside its interval it is: 1 in the middle, 0 at the ends."""
        with np.errstate(invalid="ignore"):
            return np.where(self.asked, 1.0 - np.abs(values - self.middle) / self.half, -np.inf)

    def ranks(self, values: np.ndarray) -> np.ndarray:
        """Return one number for each line of values, larger the better."""
        slack = self.slack(values)
        slack = np.where(np.isnan(slack), -np.inf, slack)
        held = slack >= 0.0
        least = np.where(held, slack, 1.0).min(axis=1, initial=1.0)
        many = values.shape[1] + 1
        return np.asarray((held & self.needed).sum(axis=1) * many + held.sum(axis=1) + least / 2)

    def rank(self, values: np.ndarray) -> tuple[float]:
        """Return the rank of one point, without regard to how clearly."""
        return (float(np.floor(self.ranks(values[None])[0])),)

    def best(self, known: Sampled, points: Points) -> np.ndarray:
        """Return the best of some points at which the quantities are known.

        Best is where first the most needed quantities hold, then the most others; of equal points the first.
        """
        ranks = [self.rank(known.at(point)) for point in points]
        return points[max(range(len(points)), key=lambda i: (*ranks[i], -i))]


def _best(target: Target, part: Part, scaled: np.ndarray) -> int:
    return int(np.argmax(target.ranks(part(scaled))))


def _best_known(target: Target, search: Search) -> list[int]:
    ranks = target.ranks(np.array(search.values))
    return [int(i) for i in np.argsort(-ranks, kind="stable")[:_TRIED]]

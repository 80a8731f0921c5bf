r"""The range of functions over a small box, from quadratic models that are checked before they are believed.

Over the numbers that round to a few printed digits a computed quantity is nearly linear. It is evaluated at the middle
of the box, in the middle of its sides and at its corners; a quadratic polynomial is fitted to that, and compared with
the quantity at these points and, to see what they cannot, at others halfway to the corners. Where the two differ by
more than a given tolerance, the box is halved along its most curved side, and again, until every part passes or the
parts are too many; a part that does not pass (where the largest of two peaks changes) counts with its own values
alone. Where the derivatives of a model, which are linear, keep their sign over its part, the model's extrema are at
corners, and these have been evaluated; where one may vanish, the extrema inside are searched and evaluated once more.

So both ends of a range are values that the quantity takes. That it takes none beyond them is found by search, not
proven: between the points at which it was evaluated it could leave its model unseen. (Interval arithmetic through a
whole loop response would prove it, at a thousand times the cost.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from itertools import combinations_with_replacement, product

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]
"""From a point, shape (d,), to the values of all quantities there, shape (m,); NaN where there is none."""

_MOST_PARTS = 8
_CHECKED_AT = 0.5  # of the way to the corners
_FINENESS = {1: 401, 2: 61, 3: 21, 4: 11}  # points a side on which a model is searched
_COARSE = 7
MOST_INPUTS = 6  # whose corners are all evaluated


@dataclass(frozen=True)
class Part:
    """A part of the box with its models.

    Attributes
    ----------
    centre, half
        Shape (d,).
    coefficients
        Of the terms of `terms`; shape (terms, m).
    good
        By function: whether the model was confirmed; shape (m,).
    """

    centre: np.ndarray
    half: np.ndarray
    coefficients: np.ndarray
    good: np.ndarray

    def __call__(self, scaled: np.ndarray) -> np.ndarray:
        """Return the models at points of [-1, 1]^d, shape (n, d), as shape (n, m)."""
        return np.asarray(terms(scaled) @ self.coefficients)

    @property
    def monotonic(self) -> np.ndarray:
        """By function: whether no derivative of its model vanishes in the part, so that its extrema are at corners."""
        d = len(self.half)
        slope = np.abs(self.coefficients[1 : d + 1])
        spread = np.zeros_like(slope)
        for (i, j), curved in zip(
            combinations_with_replacement(range(d), 2), np.abs(self.coefficients[d + 1 :]), strict=True
        ):
            spread[i] += curved
            spread[j] += curved  # twice for i = j, as in the derivative of a square
        return np.asarray((slope >= spread).all(axis=0))

    def point(self, scaled: np.ndarray) -> np.ndarray:
        """Return points of the box for points of [-1, 1]^d."""
        return np.asarray(self.centre + scaled * self.half)


def terms(scaled: np.ndarray) -> np.ndarray:
    """Return 1, the coordinates and their products of degree two at points of shape (n, d)."""
    d = scaled.shape[1]
    pairs = [scaled[:, i] * scaled[:, j] for i, j in combinations_with_replacement(range(d), 2)]
    return np.column_stack([np.ones(len(scaled)), scaled, *pairs])


@cache
def _grid(d: int) -> np.ndarray:
    """Return the scaled points at which a model of d inputs is searched, shape (n, d)."""
    grid = np.array(list(product(np.linspace(-1.0, 1.0, _FINENESS.get(d, _COARSE)), repeat=d)))
    grid.setflags(write=False)  # shared
    return grid


@dataclass
class Search:
    """Functions over a box, found out as well as the tolerances ask for.

    Attributes
    ----------
    function
        Called once for each point.
    tolerance
        By function: how far a model may be off; shape (m,).
    """

    function: Function
    centre: np.ndarray
    half: np.ndarray
    tolerance: np.ndarray
    parts: list[Part] = field(default_factory=list)
    points: list[np.ndarray] = field(default_factory=list)
    values: list[np.ndarray] = field(default_factory=list)
    _known: dict[bytes, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Divide the box until the models are good enough, or the parts too many.

        Raises
        ------
        ValueError
            If there are more inputs than can be searched.
        """
        if len(self.centre) > MOST_INPUTS:
            msg = f"{len(self.centre)} printed inputs, allowed: at most {MOST_INPUTS}"
            raise ValueError(msg)
        waiting = [self._part(self.centre, self.half)]
        while waiting:
            part, worst = waiting.pop(0)
            if part.good.all() or len(self.parts) + len(waiting) + 2 > _MOST_PARTS:
                self.parts.append(part)
                continue
            step = np.zeros_like(part.half)
            step[worst] = part.half[worst] / 2
            waiting += [self._part(part.centre + side * step, part.half - step) for side in (-1.0, 1.0)]

    def at(self, point: np.ndarray) -> np.ndarray:
        """Return the values of all functions at a point of the box."""
        key = np.round((point - self.centre) / np.where(self.half > 0.0, self.half, 1.0), 12).tobytes()
        if key not in self._known:
            self._known[key] = np.asarray(self.function(point), dtype=float)
            self.points.append(point)
            self.values.append(self._known[key])
        return self._known[key]

    def range(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest and largest value of each function; NaN where it has none somewhere."""
        for part, scaled in self.searched():
            curved = np.nonzero(part.good & ~part.monotonic)[0]
            guesses = part(scaled) if curved.size else np.empty((0, 0))
            for place in curved:
                for extreme in {int(np.argmin(guesses[:, place])), int(np.argmax(guesses[:, place]))}:
                    if np.abs(scaled[extreme]).min(initial=1.0) < 1.0:  # the corners are known
                        self.at(part.point(scaled[extreme]))
        found = np.array(self.values)
        return found.min(axis=0), found.max(axis=0)

    def searched(self) -> Iterator[tuple[Part, np.ndarray]]:
        """Yield every part with a fine grid of scaled points."""
        grid = _grid(len(self.centre))
        for part in self.parts:
            yield part, grid

    def _part(self, centre: np.ndarray, half: np.ndarray) -> tuple[Part, int]:
        """Return a part of the box, and the variable in which it is most curved."""
        d = len(centre)
        corners = np.array(list(product((-1.0, 1.0), repeat=d)))
        sides = np.concatenate([np.eye(d), -np.eye(d)]) if d > 1 else np.empty((0, d))
        nodes = np.concatenate([np.zeros((1, d)), sides, corners])
        checks = _CHECKED_AT * corners[corners.prod(axis=1) > 0.0] if d > 2 else _CHECKED_AT * corners
        values = np.array([self.at(centre + node * half) for node in nodes])
        exists = np.isfinite(values).all(axis=0)
        coefficients = np.linalg.lstsq(terms(nodes), np.where(exists, values, 0.0), rcond=None)[0]
        where = np.concatenate([nodes, checks])
        truth = np.concatenate([values, [self.at(centre + check * half) for check in checks]])
        errors = np.abs(terms(where) @ coefficients - truth).max(axis=0)
        good = exists & (errors <= self.tolerance)  # NaN is not
        bad = exists & ~good
        curved = [self._curvature(coefficients[:, bad], d, axis, bad) for axis in range(d)]
        return Part(centre, half, coefficients, good | ~exists), int(np.argmax(curved))

    def _curvature(self, coefficients: np.ndarray, d: int, axis: int, bad: np.ndarray) -> float:
        pairs = list(combinations_with_replacement(range(d), 2))
        rows = [1 + d + place for place, pair in enumerate(pairs) if axis in pair]
        return float((np.abs(coefficients[rows]).sum(axis=0) / self.tolerance[bad]).max(initial=0.0))

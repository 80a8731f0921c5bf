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

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import numpy as np

from replicate.exhibits.rounds import Asking, Points, Sampled

Box = tuple[np.ndarray, np.ndarray]
"""Centre and half of the sides, shape (d,) each."""

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

    def on_grid(self, axes: Sequence[np.ndarray], chosen: np.ndarray) -> np.ndarray:
        """Return models at all combinations of scaled coordinates, in the order of `itertools.product`.

        Parameters
        ----------
        axes
            For each input its coordinates, within [-1, 1].
        chosen
            The places of the models asked for, shape (k,).

        Returns
        -------
        ndarray
            Shape (k, n).
        """
        d, coefficients = len(axes), self.coefficients[:, chosen]
        products = dict(zip(combinations_with_replacement(range(d), 2), coefficients[d + 1 :, :, None], strict=True))
        # one input after the other: what the models are at the coordinates so far, and what they grow by in the others
        values, slopes = coefficients[0][:, None], [row[:, None] for row in coefficients[1 : d + 1]]
        for k, x in enumerate(axes):
            steps = slopes[k][:, :, None] * x + (products[k, k] * x**2)[:, None]
            values, shape = values[:, :, None] + steps, (len(chosen), values.shape[1] * x.size)
            values = values.reshape(shape)
            for later in range(k + 1, d):
                slopes[later] = (slopes[later][:, :, None] + (products[k, later] * x)[:, None]).reshape(shape)
        return np.asarray(values)

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


def fine(d: int) -> np.ndarray:
    """Return the scaled coordinates of each of d inputs at which a model is searched."""
    return np.linspace(-1.0, 1.0, _FINENESS.get(d, _COARSE))


def grid_point(axes: Sequence[np.ndarray], place: int) -> np.ndarray:
    """Return a point of a grid by its place in the order of `itertools.product`."""
    places = np.unravel_index(place, [len(x) for x in axes])
    return np.array([x[i] for x, i in zip(axes, places, strict=True)])


class Search(Sampled):
    """Functions over a box, found out as well as the tolerances ask for.

    Parameters
    ----------
    centre, half
        Of the box, shape (d,).
    tolerance
        By function: how far a model may be off; shape (m,).

    Attributes
    ----------
    parts
        Of the box, with their models; none before `divide`.

    Raises
    ------
    ValueError
        If there are more inputs than can be searched.
    """

    def __init__(self, centre: np.ndarray, half: np.ndarray, tolerance: np.ndarray) -> None:
        super().__init__(centre, half)
        if len(centre) > MOST_INPUTS:
            msg = f"{len(centre)} printed inputs, allowed: at most {MOST_INPUTS}"
            raise ValueError(msg)
        self.tolerance = tolerance
        self.parts: list[Part] = []

    def divide(self) -> Asking[None]:
        """Divide the box until the models are good enough, or the parts too many."""
        waiting = yield from self._modelled([(self.centre, self.half)])
        while waiting:
            halves: list[Box] = []
            for place, (part, worst) in enumerate(waiting, 1):
                others = len(self.parts) + len(waiting) - place + len(halves)
                if part.good.all() or others + 2 > _MOST_PARTS:
                    self.parts.append(part)
                    continue
                step = np.zeros_like(part.half)
                step[worst] = part.half[worst] / 2
                halves += [(part.centre + side * step, part.half - step) for side in (-1.0, 1.0)]
            waiting = (yield from self._modelled(halves)) if halves else []

    def extremes(self) -> Points:
        """Return where a model has its smallest or largest value, if that is not at a corner, which is known."""
        found, axes = [], [fine(len(self.centre))] * len(self.centre)
        for part in self.parts:
            for guess in part.on_grid(axes, np.nonzero(part.good & ~part.monotonic)[0]):
                scaled = [grid_point(axes, place) for place in {int(np.argmin(guess)), int(np.argmax(guess))}]
                found += [part.point(point) for point in scaled if np.abs(point).min() < 1.0]
        return found

    def _modelled(self, boxes: Sequence[Box]) -> Asking[list[tuple[Part, int]]]:
        """Return parts of the box, and the variable in which each is most curved."""
        nodes, checks = _nodes(len(self.centre))
        where = np.concatenate([nodes, checks])
        values = yield from self.ask([centre + node * half for centre, half in boxes for node in where])
        per_box = np.split(values, len(boxes))
        return [self._part(*box, nodes, where, found) for box, found in zip(boxes, per_box, strict=True)]

    def _part(
        self, centre: np.ndarray, half: np.ndarray, nodes: np.ndarray, where: np.ndarray, truth: np.ndarray
    ) -> tuple[Part, int]:
        d, values = len(centre), truth[: len(nodes)]
        exists = np.isfinite(values).all(axis=0)
        coefficients = np.linalg.lstsq(terms(nodes), np.where(exists, values, 0.0), rcond=None)[0]
        errors = np.abs(terms(where) @ coefficients - truth).max(axis=0)
        good = exists & (errors <= self.tolerance)  # NaN is not
        bad = exists & ~good
        curved = [self._curvature(coefficients[:, bad], d, axis, bad) for axis in range(d)]
        return Part(centre, half, coefficients, good | ~exists), int(np.argmax(curved))

    def _curvature(self, coefficients: np.ndarray, d: int, axis: int, bad: np.ndarray) -> float:
        pairs = list(combinations_with_replacement(range(d), 2))
        rows = [1 + d + place for place, pair in enumerate(pairs) if axis in pair]
        return float((np.abs(coefficients[rows]).sum(axis=0) / self.tolerance[bad]).max(initial=0.0))


def _nodes(d: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the scaled points to which a model of d inputs is fitted, and others at which it is only checked."""
    corners = np.array(list(product((-1.0, 1.0), repeat=d)))
    sides = np.concatenate([np.eye(d), -np.eye(d)]) if d > 1 else np.empty((0, d))
    checks = _CHECKED_AT * corners[corners.prod(axis=1) > 0.0] if d > 2 else _CHECKED_AT * corners
    return np.concatenate([np.zeros((1, d)), sides, corners]), checks

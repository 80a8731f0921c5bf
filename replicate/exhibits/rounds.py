"""Searches that ask for values together: each says which points it wants, and those of all are computed at once.

A search is a generator. It yields a list of points and is sent a list with the values at each of them; what it returns
in the end is its result. What one search finds does not depend on which others ask beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

import numpy as np

T = TypeVar("T")
Points = list[np.ndarray]
Values = list[np.ndarray]
Asking = Generator[Points, Values, T]
"""Yields points, shape (d,) each, and is sent the values of all functions at each, shape (m,)."""


Answer = Callable[[list[tuple[int, np.ndarray]]], Sequence[np.ndarray]]
"""From pairs of a search's place and a point to the values there, in the same order."""


def in_rounds(searches: Sequence[Asking[T]], answer: Answer) -> list[T]:
    """Return the results of searches that run side by side: a round of questions of all, a round of answers.

    Parameters
    ----------
    searches
        Not begun yet.
    answer
        Called once for each round.

    Examples
    --------
    >>> def doubled(number):
    ...     values = yield [np.array([number])]
    ...     return float(values[0][0])
    >>> in_rounds([doubled(1.0), doubled(3.0)], lambda asked: [2.0 * point for _, point in asked])
    [2.0, 6.0]
    """
    results: dict[int, T] = {}
    waiting: dict[int, Points] = {}

    def go_on(place: int, values: Values | None) -> None:
        try:
            waiting[place] = next(searches[place]) if values is None else searches[place].send(values)
        except StopIteration as end:
            results[place] = end.value

    for place in range(len(searches)):
        go_on(place, None)
    while waiting:
        asked, waiting = waiting, {}
        found = iter(answer([(place, point) for place, points in asked.items() for point in points]))
        for place, points in asked.items():
            go_on(place, [next(found) for _ in points])
    return [results[place] for place in range(len(searches))]


class Sampled:
    """Functions over a box, and their values where these have been asked for.

    Parameters
    ----------
    centre, half
        Of the box, shape (d,).

    Attributes
    ----------
    points, values
        Where the functions are known, and their values there, shape (m,) each; in the order in which they were asked.
    """

    def __init__(self, centre: np.ndarray, half: np.ndarray) -> None:
        self.centre, self.half = centre, half
        self.points: Points = []
        self.values: Values = []
        self._places: dict[bytes, int] = {}

    def ask(self, points: Sequence[np.ndarray]) -> Asking[np.ndarray]:
        """Return the values at points of the box, shape (n, m); only what is not known is asked for, once."""
        new: Points = []
        for point in points:
            if (key := self._key(point)) not in self._places:
                self._places[key] = len(self.points) + len(new)
                new.append(point)
        if new:
            self.values += [np.asarray(values, dtype=float) for values in (yield new)]
            self.points += new
        return np.array([self.at(point) for point in points])

    def at(self, point: np.ndarray) -> np.ndarray:
        """Return the values at a point that has been asked for."""
        return self.values[self._places[self._key(point)]]

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest and largest known value of each function; NaN where it has none somewhere."""
        found = np.array(self.values)
        return found.min(axis=0), found.max(axis=0)

    def _key(self, point: np.ndarray) -> bytes:
        scaled = (point - self.centre) / np.where(self.half > 0.0, self.half, 1.0)
        return bytes(np.round(scaled, 12).tobytes())

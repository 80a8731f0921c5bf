"""What a reader may try out: plant and controller, as two texts, of the rows of a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

Loop = tuple[str, str]
"""Plant and controller."""

Trials = Callable[[], Mapping[str, Loop] | Mapping[tuple[str, str], Loop]]
"""Returns loops by row, or by row and case where a row holds several."""

ComputedTrial = Callable[[str, Mapping[str, float]], Loop]
"""Returns the loop of a row from the row and its computed numbers, by column."""


class Trial(NamedTuple):
    """A loop of a row; ``case`` tells it from others of the row, and is empty where there are none."""

    row: str
    case: str
    plant: str
    controller: str


def listed(trials: Trials | None) -> list[Trial]:
    """Return the loops that a table declares, in its order.

    Examples
    --------
    >>> listed(lambda: {("PA", "a"): ("1/s", "k=1"), ("PA", "b"): ("1/s", "k=2")})[1]
    Trial(row='PA', case='b', plant='1/s', controller='k=2')
    """
    found = trials() if trials is not None else {}
    return [Trial(*((key, "") if isinstance(key, str) else key), *loop) for key, loop in found.items()]

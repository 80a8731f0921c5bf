"""What a reader may try out: plant and controller, as two texts, of the rows of a table."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from replicate.errors import PaperDefinitionError
from replicate.exhibits.frames import FrameCells

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


@dataclass(frozen=True)
class TableTrials:
    """The loops of a table's rows.

    Attributes
    ----------
    declared
        In the table's order.
    computed
        Those whose parameters are computed, by the first reading.
    error
        A one-line reason if they could not be listed.
    """

    declared: tuple[Trial, ...] = ()
    computed: tuple[Trial, ...] = ()
    error: str = ""

    @property
    def all(self) -> tuple[Trial, ...]:
        """Those declared, then those computed."""
        return (*self.declared, *self.computed)


def declared_trials(trials: Trials | None, rows: Collection[str] = ()) -> tuple[Trial, ...]:
    """Return the loops that a table declares, in its order.

    Parameters
    ----------
    rows
        Of the table; any if there are none.

    Raises
    ------
    PaperDefinitionError
        If what is declared is no loop of a row.

    Examples
    --------
    >>> declared_trials(lambda: {("PA", "a"): ("1/s", "k=1"), ("PA", "b"): ("1/s", "k=2")})[1]
    Trial(row='PA', case='b', plant='1/s', controller='k=2')
    """
    found: object = trials() if trials is not None else {}
    if not isinstance(found, Mapping):
        msg = f"trials returns {type(found).__name__}; expected: plant and controller by row"
        raise PaperDefinitionError(msg)
    return tuple(_trial(key, loop, rows) for key, loop in found.items())


def computed_trials(computed: ComputedTrial | None, cells: FrameCells) -> tuple[Trial, ...]:
    """Return the loops of the rows of a frame whose parameters were computed.

    Raises
    ------
    PaperDefinitionError
        If one is no loop.
    """
    if computed is None:
        return ()
    found = []
    for row in cells.rows:
        numbers = {column: cells.numbers.get((row, column)) for column in cells.columns}
        with contextlib.suppress(KeyError):  # the row computes no parameters
            loop = computed(row, {column: number for column, number in numbers.items() if number is not None})
            found.append(_trial(row, loop, ()))
    return tuple(found)


def _trial(key: object, loop: object, rows: Collection[str]) -> Trial:
    names = (key, "") if isinstance(key, str) else key
    match names, loop:
        case (str(row), str(case)), (str(plant), str(controller)) if not rows or row in rows:
            return Trial(row, case, plant, controller)
    msg = f"trials has {loop!r} for {key!r}; expected: the texts of plant and controller for a row, or a row and case"
    raise PaperDefinitionError(msg)

"""Compute a reading that takes inputs from the print: each printed number stands for all numbers that round to it.

Where a table prints gains with two digits and, beside them, what follows from the gains, the author computed with more
digits than he printed. A quantity then has a range, not a value, and the quantities of one case share one point of the
box of inputs. Both are computed here: the range (`replicate.exhibits.quadratic_model`) and the point at which most of
the printed quantities of the case hold together (`replicate.exhibits.joint_point`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.conventions import settle
from replicate.exhibits.joint_point import joint_point
from replicate.exhibits.matching import match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.quadratic_model import Search
from replicate.exhibits.readings import Reading
from replicate.exhibits.results import Ranges
from replicate.exhibits.vocabulary import Table

if TYPE_CHECKING:
    import pandas as pd

Given = Mapping[str, float]
Row = Callable[[str, Given], Mapping[str, float]]

_TOLERANCE = 0.02  # of a unit of the last printed digit
_NO_UNIT = 1e-3  # relative, where nothing is printed


@dataclass(frozen=True)
class _Case:
    """The printed inputs of one case, and what follows from them."""

    name: str
    inputs: dict[str, PrintedValue]
    found: dict[str, float]


def compute_reading(table: Table, reading: Reading, printed: Mapping[Key, PrintedValue]) -> tuple[pd.DataFrame, Ranges]:
    """Compute a reading with printed inputs.

    Parameters
    ----------
    table, reading
        The exhibit and a reading of it that has `inputs`.
    printed
        The exhibit's printed values by (row, column).

    Returns
    -------
    DataFrame
        The exhibit for the printed inputs themselves, in its own layout; blank where the reading returns nothing.
    Ranges
        The range of every cell, and the joint point of every case. Both ends are values that the cell takes; that it
        takes none beyond them is found by a search at corners and inside (`replicate.exhibits.quadratic_model`), not
        proven.

    Raises
    ------
    ValueError
        If an input is not printed for any case, or the reading returns a quantity that the table does not have.
    """
    import pandas as pd

    cases = [found for name in _cases(table) if (found := _case(table, reading, printed, name)) is not None]
    if not cases:
        msg = f"reading '{reading.id}': no case has all of the inputs {', '.join(reading.inputs)} in print"
        raise ValueError(msg)
    numbers = {table.key(case.name, quantity): number for case in cases for quantity, number in case.found.items()}
    frame = pd.DataFrame(math.nan, index=list(table.rows), columns=list(table.columns))
    for (row, column), number in numbers.items():
        frame.loc[row, column] = number
    matches = {key: match(value, numbers.get(key)) for key, value in printed.items()}
    settled = settle(table, matches, exact=False)
    ranges = Ranges()
    for case in cases:
        _search(table, reading, printed, {key: one.kind == "equal" for key, (one, _) in settled.items()}, case, ranges)
    return frame, ranges


def _cases(table: Table) -> tuple[str, ...]:
    return table.columns if table.cases_are_columns else table.rows


def _case(table: Table, reading: Reading, printed: Mapping[Key, PrintedValue], name: str) -> _Case | None:
    """Return a case with what its printed inputs give; ``None`` if one of them is blank."""
    keys = {}
    for place in reading.inputs_of.get(name, reading.inputs):
        quantity, _, other = place.partition("@")
        keys[place] = table.key(other or name, quantity)
    if any(key not in printed for key in keys.values()):
        return None
    inputs = {quantity: printed[key] for quantity, key in keys.items()}
    found = dict(reading.compute(name, {quantity: float(value.value) for quantity, value in inputs.items()}))
    known = table.rows if table.cases_are_columns else table.columns
    unknown = [quantity for quantity in found if quantity not in known]
    if unknown:
        msg = f"reading '{reading.id}' returns '{unknown[0]}' for '{name}'; allowed: {', '.join(known)}"
        raise ValueError(msg)
    return _Case(name, inputs, {quantity: float(number) for quantity, number in found.items()})


def _search(
    table: Table,
    reading: Reading,
    printed: Mapping[Key, PrintedValue],
    equal: Mapping[Key, bool],
    case: _Case,
    ranges: Ranges,
) -> None:
    """Add the ranges and the joint point of one case."""
    quantities = [quantity for quantity, number in case.found.items() if math.isfinite(number)]
    if not quantities:
        return
    keys = [table.key(case.name, quantity) for quantity in quantities]
    prints = [value if (value := printed.get(key)) and value.states_number else None for key in keys]

    def function(point: np.ndarray) -> np.ndarray:
        try:
            found = reading.compute(case.name, dict(zip(case.inputs, map(float, point), strict=True)))
        except Exception:  # noqa: BLE001  -- no such number there, as the overshoot of an unstable loop
            return np.full(len(quantities), math.nan)
        return np.array([float(found.get(quantity, math.nan)) for quantity in quantities])

    intervals = np.array([[float(end) for end in value.interval] for value in case.inputs.values()])
    tolerance = [
        _TOLERANCE * float(value.unit) if value else _NO_UNIT * abs(case.found[quantity])
        for value, quantity in zip(prints, quantities, strict=True)
    ]
    search = Search(function, intervals.mean(axis=1), np.diff(intervals)[:, 0] / 2, np.array(tolerance) + 1e-300)
    targets = np.array([[float(end) for end in value.interval] if value else [math.nan] * 2 for value in prints])
    needed = np.array([equal.get(key, False) for key in keys])
    point = joint_point(search, targets[:, 0], targets[:, 1], needed)
    joint = search.at(point)
    for key, low, high, value in zip(keys, *search.range(), joint, strict=True):
        ranges.lower[key], ranges.upper[key], ranges.joint[key] = float(low), float(high), float(value)
    ranges.points[case.name] = dict(zip(case.inputs, map(float, point), strict=True))

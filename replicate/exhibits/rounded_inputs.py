"""Compute a reading that takes inputs from the print: each printed number stands for all numbers that round to it.

Where a table prints gains with two digits and, beside them, what follows from the gains, the author computed with more
digits than he printed. A quantity then has a range, not a value, and the quantities of one case share one point of the
box of inputs. Both are computed here: the range (`replicate.exhibits.quadratic_model`) and the point at which most of
the printed quantities of the case hold together (`replicate.exhibits.joint_point`); for more inputs than a grid can
cover, both by `replicate.exhibits.many_inputs`.

An input is named by the place of its print: ``k``, the quantity ``k`` of the same case; ``k@first``, that of the case
``first``; ``eq-7:a:value``, the cell of another table with printed numbers; ``p=1.6667``, a number of the text.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.conventions import settle
from replicate.exhibits.exclusion import Ends, Rule, excluded
from replicate.exhibits.joint_point import joint_point
from replicate.exhibits.many_inputs import ManyInputs
from replicate.exhibits.matching import match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.quadratic_model import MOST_INPUTS, Search
from replicate.exhibits.readings import Reading, is_elsewhere
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


def compute_reading(
    table: Table,
    reading: Reading,
    printed: Mapping[Key, PrintedValue],
    elsewhere: Mapping[str, PrintedValue] = MappingProxyType({}),
) -> tuple[pd.DataFrame, Ranges]:
    """Compute a reading with printed inputs.

    Parameters
    ----------
    table, reading
        The exhibit and a reading of it that has `inputs`.
    printed
        The exhibit's printed values by (row, column).
    elsewhere
        Inputs that are printed in other tables or in the text, by place.

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

    cases = [found for name in _cases(table) if (found := _case(table, reading, printed, elsewhere, name)) is not None]
    if not cases:
        places = dict.fromkeys([*reading.inputs, *(place for own in reading.inputs_of.values() for place in own)])
        msg = f"reading '{reading.id}': no case has all of the inputs {', '.join(places)} in print"
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


def given_cells(table: Table, reading: Reading) -> set[Key]:
    """Return the cells of a reading's own table that it takes from the print, and so does not compute.

    Examples
    --------
    >>> table = Table("table-1", "table", "Products", rows=("a", "b"), columns=("x", "y", "xy"))
    >>> reading = Reading("as-written", "", dict, inputs=("x", "y@b", "p=2.0"))
    >>> sorted(given_cells(table, reading))
    [('a', 'x'), ('b', 'x'), ('b', 'y')]
    """
    return {
        _own_cell(table, case, place)
        for case in _cases(table)
        for place in reading.inputs_of.get(case, reading.inputs)
        if not is_elsewhere(place)
    }


def _own_cell(table: Table, case: str, place: str) -> Key:
    quantity, _, other = place.partition("@")
    return table.key(other or case, quantity)


def places_elsewhere(reading: Reading) -> list[str]:
    """Return the places of the inputs of a reading that are not printed in its own table."""
    places = dict.fromkeys([*reading.inputs, *(place for own in reading.inputs_of.values() for place in own)])
    return [place for place in places if is_elsewhere(place)]


def _case(
    table: Table,
    reading: Reading,
    printed: Mapping[Key, PrintedValue],
    elsewhere: Mapping[str, PrintedValue],
    name: str,
) -> _Case | None:
    """Return a case with what its printed inputs give; ``None`` if one of them is blank, or it has none."""
    inputs: dict[str, PrintedValue] = {}
    for place in reading.inputs_of.get(name, reading.inputs):
        value = elsewhere[place] if is_elsewhere(place) else printed.get(_own_cell(table, name, place))
        if value is None:
            return None
        inputs[place] = value
    if not inputs:
        return None
    found = reading.compute(name, {quantity: float(value.value) for quantity, value in inputs.items()})
    if not isinstance(found, Mapping):
        msg = f"reading '{reading.id}' returns {type(found).__name__} for '{name}'; expected: numbers by quantity"
        raise TypeError(msg)
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

    intervals = np.array([value.ends for value in case.inputs.values()])
    tolerance = [
        _TOLERANCE * float(value.unit) if value else _NO_UNIT * abs(case.found[quantity])
        for value, quantity in zip(prints, quantities, strict=True)
    ]
    centre, half = intervals.mean(axis=1), np.diff(intervals)[:, 0] / 2
    targets = np.array([value.ends if value else (math.nan, math.nan) for value in prints])
    wanted = targets[:, 0], targets[:, 1], np.array([equal.get(key, False) for key in keys])
    search: Search | ManyInputs
    if len(half) > MOST_INPUTS:
        search = ManyInputs(function, centre, half)
        point = search.joint_point(*wanted)
    else:
        search = Search(function, centre, half, np.array(tolerance) + 1e-300)
        point = joint_point(search, *wanted)
    joint = search.at(point)
    for key, low, high, value in zip(keys, *search.range(), joint, strict=True):
        ranges.lower[key], ranges.upper[key], ranges.joint[key] = float(low), float(high), float(value)
    ranges.points[case.name] = dict(zip(case.inputs, map(float, point), strict=True))
    if reading.rules_out:
        wanted_ends = {q: value.ends for q, value in zip(quantities, prints, strict=True) if value}
        values = np.abs(np.array(search.values) - targets.mean(axis=1))
        nearest = {
            quantity: search.points[int(np.argmin(np.nan_to_num(away, nan=np.inf)))]
            for quantity, away in zip(quantities, values.T, strict=True)
        }
        _prove(table, reading.rules_out, case, wanted_ends, nearest, ranges)


def _prove(
    table: Table,
    rules: Mapping[str, Rule],
    case: _Case,
    targets: Mapping[str, Ends],
    nearest: Mapping[str, np.ndarray],
    ranges: Ranges,
) -> None:
    """Add what proves of the values of a case that no inputs give them, where there is such a proof."""
    box = {name: value.ends for name, value in case.inputs.items()}
    known = {quantity: targets[quantity] for quantity in rules if quantity in targets}
    joint = {quantity: ranges.joint[table.key(case.name, quantity)] for quantity in known}
    held = {quantity: ends for quantity, ends in known.items() if ends[0] <= joint[quantity] <= ends[1]}
    for quantity in [quantity for quantity in known if quantity not in held]:
        key, alone = table.key(case.name, quantity), {quantity: known[quantity]}
        closest = dict(zip(case.inputs, map(float, nearest[quantity]), strict=True))
        if excluded(rules, case.name, box, alone, closest):
            ranges.proofs[key] = "alone"
        elif held and excluded(rules, case.name, box, held | alone, ranges.points[case.name]):
            ranges.proofs[key] = "jointly"

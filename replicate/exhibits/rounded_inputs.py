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
from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.conventions import settle
from replicate.exhibits.exclusion import Rule, excluded
from replicate.exhibits.joint_point import Target, candidates
from replicate.exhibits.many_inputs import ManyInputs
from replicate.exhibits.matching import match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.quadratic_model import MOST_INPUTS, Search
from replicate.exhibits.readings import Reading, answers, is_elsewhere
from replicate.exhibits.results import Ranges
from replicate.exhibits.rounds import Asking, Sampled, in_rounds
from replicate.exhibits.vocabulary import Table

if TYPE_CHECKING:
    import pandas as pd

_TOLERANCE = 0.02  # of a unit of the last printed digit
_NO_UNIT = 1e-3  # relative, where nothing is printed


@dataclass(frozen=True)
class _Case:
    """The printed inputs of one case, and what follows from them."""

    name: str
    inputs: dict[str, PrintedValue]
    found: dict[str, float] = field(default_factory=dict)

    @cached_property
    def quantities(self) -> list[str]:
        """Those that the printed inputs give."""
        return [quantity for quantity, number in self.found.items() if math.isfinite(number)]

    def keys(self, table: Table) -> list[Key]:
        """Return their cells."""
        return [table.key(self.name, quantity) for quantity in self.quantities]


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

    cases = _given(table, reading, printed, elsewhere)
    if not cases:
        places = dict.fromkeys([*reading.inputs, *(place for own in reading.inputs_of.values() for place in own)])
        msg = f"reading '{reading.id}': no case has all of the inputs {', '.join(places)} in print"
        raise ValueError(msg)
    _compute(table, reading, cases)
    numbers = {table.key(case.name, quantity): number for case in cases for quantity, number in case.found.items()}
    frame = pd.DataFrame(math.nan, index=list(table.rows), columns=list(table.columns))
    for (row, column), number in numbers.items():
        frame.loc[row, column] = number
    matches = {key: match(value, numbers.get(key)) for key, value in printed.items()}
    settled = settle(table, matches, exact=False)
    equal = {key for key, (one, _) in settled.items() if one.kind == "equal"}
    return frame, _ranges(table, reading, printed, equal, [case for case in cases if case.quantities])


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


def _given(
    table: Table, reading: Reading, printed: Mapping[Key, PrintedValue], elsewhere: Mapping[str, PrintedValue]
) -> list[_Case]:
    """Return the cases with their printed inputs, without those of which one is blank, or that have none."""
    cases = []
    for name in _cases(table):
        inputs = {
            place: elsewhere[place] if is_elsewhere(place) else printed.get(_own_cell(table, name, place))
            for place in reading.inputs_of.get(name, reading.inputs)
        }
        values = {place: value for place, value in inputs.items() if value is not None}
        if values and len(values) == len(inputs):
            cases.append(_Case(name, values))
    return cases


def _compute(table: Table, reading: Reading, cases: list[_Case]) -> None:
    """Enter what the printed inputs of cases give."""
    known = table.rows if table.cases_are_columns else table.columns
    for case in cases:
        found = reading.compute(case.name, {place: float(value.value) for place, value in case.inputs.items()})
        if not isinstance(found, Mapping):
            kind = type(found).__name__
            msg = f"reading '{reading.id}' returns {kind} for '{case.name}'; expected: numbers by quantity"
            raise TypeError(msg)
        unknown = [quantity for quantity in found if quantity not in known]
        if unknown:
            msg = f"reading '{reading.id}' returns '{unknown[0]}' for '{case.name}'; allowed: {', '.join(known)}"
            raise ValueError(msg)
        case.found.update({quantity: float(number) for quantity, number in found.items()})


def _ranges(
    table: Table, reading: Reading, printed: Mapping[Key, PrintedValue], equal: Set[Key], cases: list[_Case]
) -> Ranges:
    """Return the ranges and the joint points of cases, all of which are searched side by side."""
    prints = [
        [value if (value := printed.get(key)) and value.states_number else None for key in case.keys(table)]
        for case in cases
    ]
    searches = [
        _search(case, own, np.array([key in equal for key in case.keys(table)]))
        for case, own in zip(cases, prints, strict=True)
    ]
    ranges = Ranges()
    for case, own, (search, point) in zip(
        cases, prints, in_rounds(searches, lambda asked: _values(reading, cases, asked)), strict=True
    ):
        for key, low, high, value in zip(case.keys(table), *search.ends(), search.at(point), strict=True):
            ranges.lower[key], ranges.upper[key], ranges.joint[key] = float(low), float(high), float(value)
        ranges.points[case.name] = dict(zip(case.inputs, map(float, point), strict=True))
        if reading.rules_out:
            _prove(table, reading.rules_out, case, own, search, ranges)
    return ranges


def _values(reading: Reading, cases: list[_Case], asked: list[tuple[int, np.ndarray]]) -> list[np.ndarray]:
    """Return the quantities of cases at points of their boxes; NaN where there is no such number."""
    points = [
        (cases[place].name, dict(zip(cases[place].inputs, map(float, point), strict=True))) for place, point in asked
    ]
    return [
        np.array([float(found.get(quantity, math.nan)) for quantity in cases[place].quantities])
        for (place, _), found in zip(asked, answers(reading, points), strict=True)
    ]


def _search(
    case: _Case, prints: list[PrintedValue | None], equal: np.ndarray
) -> Asking[tuple[Search | ManyInputs, np.ndarray]]:
    """Search the box of a case; return what is known of it then, and the joint point."""
    intervals = np.array([value.ends for value in case.inputs.values()])
    centre, half = intervals.mean(axis=1), np.diff(intervals)[:, 0] / 2
    targets = np.array([value.ends if value else (math.nan, math.nan) for value in prints])
    target = Target(targets[:, 0], targets[:, 1], equal)
    if len(half) > MOST_INPUTS:
        many = ManyInputs(centre, half)
        yield from many.explore()
        return many, (yield from many.joint_point(target))
    tolerance = [
        _TOLERANCE * float(value.unit) if value else _NO_UNIT * abs(case.found[quantity])
        for value, quantity in zip(prints, case.quantities, strict=True)
    ]
    search = Search(centre, half, np.array(tolerance) + 1e-300)
    yield from search.divide()
    points = candidates(search, target)
    yield from search.ask([*points, *search.extremes()])  # in one round
    return search, target.best(search, points)


def _prove(
    table: Table,
    rules: Mapping[str, Rule],
    case: _Case,
    prints: list[PrintedValue | None],
    search: Sampled,
    ranges: Ranges,
) -> None:
    """Add what proves of the values of a case that no inputs give them, where there is such a proof."""
    box = {name: value.ends for name, value in case.inputs.items()}
    targets = {quantity: value.ends for quantity, value in zip(case.quantities, prints, strict=True) if value}
    known = {quantity: targets[quantity] for quantity in rules if quantity in targets}
    joint = {quantity: ranges.joint[table.key(case.name, quantity)] for quantity in known}
    held = {quantity: ends for quantity, ends in known.items() if ends[0] <= joint[quantity] <= ends[1]}
    for quantity in [quantity for quantity in known if quantity not in held]:
        key, alone = table.key(case.name, quantity), {quantity: known[quantity]}
        values = np.array(search.values)[:, case.quantities.index(quantity)]
        away = np.nan_to_num(np.abs(values - sum(known[quantity]) / 2), nan=np.inf)
        closest = dict(zip(case.inputs, map(float, search.points[int(np.argmin(away))]), strict=True))
        if excluded(rules, case.name, box, alone, closest):
            ranges.proofs[key] = "alone"
        elif held and excluded(rules, case.name, box, held | alone, ranges.points[case.name]):
            ranges.proofs[key] = "jointly"

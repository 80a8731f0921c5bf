"""What a paper reads off its numbers, rankings and bounds, as data: so a wrong number shows what it upsets."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, get_args

from replicate.errors import PaperDefinitionError
from replicate.exhibits.claims import Consequence
from replicate.exhibits.definitions import as_keys, check_number, check_one_of, check_texts
from replicate.exhibits.printed import Key

if TYPE_CHECKING:
    from replicate.exhibits.vocabulary import Table


@dataclass(frozen=True)
class Ranking:
    """Numbers that the paper ranks: which is smallest, which second.

    Attributes
    ----------
    cells
        The numbers, by (row, column).
    says
        What the paper says of them, in our own words.
    consequence
        What follows if the ranking changes.
    """

    cells: tuple[Key, ...]
    says: str
    consequence: Consequence = "comparison"

    def reading_of(self, numbers: Mapping[Key, float]) -> tuple[Key, ...]:
        """Return the cells in ascending order; numbers that are equal stay in the order of the table."""
        return tuple(sorted(self.cells, key=lambda key: numbers.get(key, math.inf)))


@dataclass(frozen=True)
class Bound:
    """Numbers that the paper promises to be above or below a bound.

    Attributes
    ----------
    cells, says, consequence
        As for `Ranking`.
    above, below
        The ends; infinite where there is none.
    """

    cells: tuple[Key, ...]
    says: str
    above: float = -math.inf
    below: float = math.inf
    consequence: Consequence = "safety"

    def reading_of(self, numbers: Mapping[Key, float]) -> tuple[bool, ...]:
        """Say for each cell whether it keeps the bound; one without a number does not."""
        return tuple(self.above <= numbers.get(key, math.nan) <= self.below for key in self.cells)


Comparison = Ranking | Bound


def upsets(comparison: Comparison, printed: Mapping[Key, float], right: Mapping[Key, float]) -> bool:
    """Say whether right numbers in place of printed ones change what the paper reads off them.

    Parameters
    ----------
    printed
        The numbers as printed, by (row, column).
    right
        What some of them should be.

    Examples
    --------
    >>> ranking = Ranking((("ZN", "IAE"), ("PA", "IAE")), "PA has the smaller IAE")
    >>> printed = {("ZN", "IAE"): 3.1, ("PA", "IAE"): 2.9}
    >>> upsets(ranking, printed, {("PA", "IAE"): 3.0}), upsets(ranking, printed, {("PA", "IAE"): 3.2})
    (False, True)
    """
    return comparison.reading_of(printed) != comparison.reading_of({**printed, **right})


def rank(table: Table, quantity: str, cases: Sequence[str], says: str, consequence: Consequence = "comparison") -> None:
    """Put on record that the paper ranks a quantity of several cases.

    Parameters
    ----------
    table
        The table that prints them.
    quantity, cases
        A column and some of its rows; where the columns are the cases, a row and some columns.
    says
        What the paper says of them, in our own words.
    consequence
        What follows if the right numbers rank otherwise.

    Raises
    ------
    PaperDefinitionError
        If the table does not have such cells, or there are fewer than two.

    Examples
    --------
    >>> from replicate.exhibits import Table
    >>> table = Table("table-1", "table", "Costs", rows=("ZN", "PA"), columns=("IAE", "ISE"))
    >>> rank(table, "IAE", ("PA", "ZN"), "PA has the smaller IAE")
    >>> table.comparisons[0].cells
    (('PA', 'IAE'), ('ZN', 'IAE'))
    """
    cells = _cells(table, quantity, cases)
    _check_words(table, says, consequence)
    if len(cells) < 2:
        msg = f"{table.id}: a ranking of {len(cells)} number says nothing; expected: two or more cases"
        raise PaperDefinitionError(msg)
    table.comparisons.append(Ranking(cells, says, consequence))


def bound(
    table: Table,
    quantity: str,
    cases: Sequence[str],
    says: str,
    *,
    above: float = -math.inf,
    below: float = math.inf,
    consequence: Consequence = "safety",
) -> None:
    """Put on record that the paper promises a quantity to be above or below a bound.

    Parameters
    ----------
    table, quantity, cases, says
        As for `rank`.
    above, below
        The ends, one or both.
    consequence
        What follows if a right number does not keep the bound.

    Raises
    ------
    PaperDefinitionError
        If the table does not have such cells, or no end is given.

    Examples
    --------
    >>> from replicate.exhibits import Table
    >>> table = Table("table-1", "table", "Robustness", rows=("ZN", "PA"), columns=("Ms", "Mp"))
    >>> bound(table, "Ms", table.rows, "Ms is always below 2", below=2.0)
    >>> table.comparisons[0].reading_of({("ZN", "Ms"): 1.8, ("PA", "Ms"): 2.1})
    (True, False)
    """
    cells = _cells(table, quantity, cases)
    _check_words(table, says, consequence)
    if not cells:
        msg = f"{table.id}: a bound of no number says nothing; expected: one case or more"
        raise PaperDefinitionError(msg)
    for name, end in (("above", above), ("below", below)):
        check_number(f"{table.id}: bound", name, end)
    if math.isinf(above) and math.isinf(below):
        msg = f"{table.id}: a bound has no end; expected: above, below or both"
        raise PaperDefinitionError(msg)
    table.comparisons.append(Bound(cells, says, above, below, consequence))


def _cells(table: Table, quantity: str, cases: Sequence[str]) -> tuple[Key, ...]:
    check_texts(f"{table.id}: comparison", quantity=quantity)
    cells = tuple(table.key(case, quantity) for case in as_keys(f"{table.id}: comparison", "cases", cases))
    for row, column in cells:
        if row not in table.rows or column not in table.columns:
            msg = f"{table.id}: there is no cell in row '{row}', column '{column}' to compare"
            raise PaperDefinitionError(msg)
    return cells


def _check_words(table: Table, says: str, consequence: Consequence) -> None:
    check_texts(f"{table.id}: comparison", says=says)
    check_one_of(f"{table.id}: comparison", "consequence", consequence, get_args(Consequence))

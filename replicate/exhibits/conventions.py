"""Whether the numbers of a column were rounded or truncated, decided from its own cells.

A computed value that rounds to the print and one that truncates to it are different statements about how the author
shortened his numbers, and one column is shortened in one way. The cells that hold by one of the two only decide; those
that hold by both say nothing. A column with no clear majority follows its table, and a table with none rounds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from replicate.exhibits.matching import Match
from replicate.exhibits.printed import Key
from replicate.exhibits.vocabulary import Table

Convention = Literal["rounded", "truncated"]

_CLEAR = 2  # so many more of one kind decide a column; a single cell may be off by its own error


@dataclass(frozen=True)
class Tally:
    """How many cells hold by rounding only, by truncation only, and by both."""

    rounded: int = 0
    truncated: int = 0
    either: int = 0

    @property
    def total(self) -> int:
        """How many cells hold."""
        return self.rounded + self.truncated + self.either

    @property
    def sentence(self) -> str:
        """The count in words.

        Examples
        --------
        >>> Tally(40, 0, 2).sentence, Tally(3, 17, 9).sentence, Tally(0, 2, 1).sentence, Tally().sentence
        ('42 of 42 round', '17 truncate, 3 round, 9 do both', '3 of 3 truncate', 'none holds')
        """
        if not self.total:
            return "none holds"
        if not (self.rounded and self.truncated):
            return f"{self.total} of {self.total} {'truncate' if self.truncated else 'round'}"
        kinds = [(self.truncated, "truncate"), (self.rounded, "round")]
        words = [f"{count} {verb}" for count, verb in sorted(kinds, reverse=True)]
        return ", ".join([*words, f"{self.either} do both"] if self.either else words)

    def __add__(self, other: Tally) -> Tally:
        """Return both counts together."""
        return Tally(self.rounded + other.rounded, self.truncated + other.truncated, self.either + other.either)

    def _balance(self) -> int:
        return self.truncated - self.rounded

    def convention(self, table: Tally) -> Convention:
        """Return how the numbers were shortened, given the count of the whole table as well."""
        own = self._balance()
        deciding = own if abs(own) >= _CLEAR else table._balance()
        return "truncated" if deciding >= _CLEAR else "rounded"


def tallies(table: Table, matches: Mapping[Key, Match]) -> dict[str, Tally]:
    """Return the count for every quantity of a table (a column, if its rows are the cases) under one reading."""
    found: dict[str, Tally] = {}
    for key, one in matches.items():
        quantity = table.quantity(*key)
        found[quantity] = found.get(quantity, Tally()) + Tally(
            one.how == "rounded", one.how == "truncated", one.how == "either"
        )
    return found


def settle(table: Table, matches: Mapping[Key, Match], *, exact: bool = True) -> dict[Key, tuple[Match, Convention]]:
    """Apply to every cell the convention of its column.

    Parameters
    ----------
    matches
        By (row, column), as `replicate.exhibits.matching.match` gives them for one reading.
    exact
        Whether the reading gives numbers that can tell. Those that follow from printed inputs are off by what these
        have lost; they are taken as rounded.

    Returns
    -------
    dict
        By (row, column): the match, which is ``near`` where a cell holds by the other convention only, and the
        convention.
    """
    counts = tallies(table, matches if exact else dict.fromkeys(matches, Match("none")))
    whole = sum(counts.values(), Tally())
    conventions = {quantity: count.convention(whole) for quantity, count in counts.items()}
    settled = {}
    for key, one in matches.items():
        convention = conventions[table.quantity(*key)]
        # Words, bounds and points read off a figure are neither rounded nor truncated.
        holds = one.kind != "equal" or one.how in {convention, "either", ""}
        settled[key] = (one if holds else replace(one, kind="near"), convention)
    return settled

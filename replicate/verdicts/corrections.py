"""What a wrong print should be: the value of the reading that shows it, with no more digits than its evidence.

A reading that gives the other cells of the column to their last digit can say as many digits of a wrong one as the
column prints. A reading that gives them only within some per cent knows the wrong one no better.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import Decimal

from replicate.exhibits.matching import computed_text, format_like, match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.verdicts.ledger import LedgerEntry

_FEWEST_NEIGHBOURS = 2  # one cell alone says nothing of what is typical of its quantity


@dataclass(frozen=True)
class Correction:
    """The right value of one cell as text, or why there is none; exactly one of the two is not empty."""

    text: str = ""
    problem: str = ""


def correction(
    key: Key, entry: LedgerEntry, printed: Mapping[Key, PrintedValue], numbers: Mapping[Key, float]
) -> Correction:
    """Return what should stand in a cell.

    Parameters
    ----------
    key
        The cell.
    entry
        The ledger entry that calls its print wrong.
    printed
        The printed values of the same quantity, this one among them.
    numbers
        What the entry's reading gives for them.
    """
    number = numbers.get(key)
    text = computed_text(number)
    if number is None or text.endswith("inf"):
        return Correction(problem=f"reading '{entry.reading}' gives no value that could be the right one")
    unit = supported_unit(key, entry, printed, numbers)
    if not entry.corrected:
        return Correction(format_like(printed[key], number, unit))
    stated = replace(printed[key], text=entry.corrected)
    if match(stated, number).kind != "equal":
        return Correction(problem=f"corrected = '{entry.corrected}', but reading '{entry.reading}' gives {text}")
    too_fine = _finer(stated, unit) if unit else _finer_than_all(stated, printed)
    if too_fine:
        limit = format_like(printed[key], number, unit)
        return Correction(problem=f"corrected = '{entry.corrected}' has more digits than its evidence: {limit}")
    return Correction(entry.corrected)


def supported_unit(
    key: Key, entry: LedgerEntry, printed: Mapping[Key, PrintedValue], numbers: Mapping[Key, float]
) -> Decimal | None:
    """Return the weight of the last digit that the reading supports in a cell; ``None`` if it supports all.

    That is so if the reading meets at least half of the quantity's other cells; otherwise half a unit covers the median
    of the relative distances between reading and print in those cells.
    """
    value, number = printed[key], Decimal(computed_text(numbers[key]))
    distances = sorted(
        _distance(other, numbers[place])
        for place, other in printed.items()
        if place != key and place in numbers and not entry.covers(*place)
    )
    typical = distances[(len(distances) - 1) // 2] if len(distances) >= _FEWEST_NEIGHBOURS else Decimal(0)
    if not typical or not number:
        return None
    needed = 2 * typical * abs(number)
    place = needed.adjusted() if needed == Decimal(1).scaleb(needed.adjusted()) else needed.adjusted() + 1
    return max(value.unit, Decimal(1).scaleb(min(place, number.adjusted())))


def _finer(stated: PrintedValue, unit: Decimal) -> bool:
    """Say whether a correction has digits below the last one supported; a whole number may end in zeros."""
    return stated.unit < unit and bool(stated.unit != 1 or stated.value % unit)


def _finer_than_all(stated: PrintedValue, printed: Mapping[Key, PrintedValue]) -> bool:
    """Say whether a correction has more digits than any print of its quantity, after the point and altogether."""
    return stated.states_number and all(
        stated.unit < value.unit and _digits(stated) > _digits(value)
        for value in printed.values()
        if value.states_number
    )


def _digits(printed: PrintedValue) -> int:
    """Return the number of significant digits, with trailing zeros."""
    return printed.value.adjusted() - printed.unit.adjusted() + 1


def _distance(printed: PrintedValue, computed: float) -> Decimal:
    """Return the relative distance of a computed value from a print; 0 where it is equal at the printed precision."""
    if match(printed, computed).kind == "equal":
        return Decimal(0)
    text = computed_text(computed)
    if text.endswith("inf") or not printed.value:
        return Decimal(1)
    return abs(Decimal(text) - printed.value) / abs(printed.value)

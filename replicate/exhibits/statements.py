"""Whether what a reading gives agrees with a printed text that states more, or something else, than a number."""

from __future__ import annotations

import datetime as dt
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from numbers import Real
from typing import Literal

from replicate.exhibits.notation import Statement
from replicate.exhibits.numerals import last_place, parse_number

Agreement = Literal["equal", "consistent", "near", "differs", "none"]

#: Compares a number with a printed one: ``equal``, ``near`` or ``differs``.
Compare = Callable[[Decimal, Decimal, Decimal], Agreement]

_KINDS: tuple[Agreement, ...] = ("equal", "near", "differs")
_INFINITE = {"inf": "above", "-inf": "below"}  # beyond which bounds it lies


def as_float(given: object) -> float | None:
    """Return a real number of any kind as a float; ``None`` if it is none, or beyond the largest float.

    Examples
    --------
    >>> as_float(Decimal("0.5")), as_float(3), as_float(True), as_float("3"), as_float(10**400)
    (0.5, 3.0, None, None, None)
    """
    if isinstance(given, bool) or not isinstance(given, Real | Decimal):
        return None
    try:
        return float(given)
    except (OverflowError, ValueError):  # too large, or a NaN that signals
        return None


def given_text(given: object) -> str | None:
    """Return a word, a date or a pair of numbers as text; ``None`` if it is none of these.

    Examples
    --------
    >>> given_text(dt.date(2003, 5, 17)), given_text((1.25, 3.5)), given_text("n.s."), given_text(("a", 3.5))
    ('2003-05-17', '1.25 3.5', 'n.s.', None)
    """
    if isinstance(given, dt.date):  # a pandas Timestamp is one, too
        return given.isoformat()[:10]
    if isinstance(given, tuple | list) and len(given) == 2:
        ends = [number for end in given if (number := as_float(end)) is not None]
        return " ".join(f"{end:.12g}" for end in ends) if len(ends) == len(given) else None
    return given if isinstance(given, str) else None


def numbers_in(given: str) -> list[Decimal]:
    """Return the numbers of a number or a pair as `given_text` writes it; none if part of it is not a finite number."""
    numbers = [number for part in given.split() if (number := parse_number(part)) is not None]
    return numbers if len(numbers) == len(given.split()) else []


def takes_pair(statement: Statement) -> bool:
    """Say whether two numbers are compared: the ends of an interval, or a value and its uncertainty."""
    return bool(statement.upper or statement.uncertainty) and statement.kind != "inside"


def compare_statement(statement: Statement, given: str, compare: Compare) -> Agreement:
    """Return how what a reading gives compares with a print: ``equal``, ``near`` or ``differs``.

    Parameters
    ----------
    given
        The computed number with twelve significant digits, the two numbers of a pair, a word, or a date.
    compare
        The rule for plain numbers: print, weight of its last digit, computed value.
    """
    if statement.kind in {"word", "date"}:
        return "equal" if given == statement.text else "differs"
    if statement.kind in {"below", "above"} and given in _INFINITE:
        return "equal" if _INFINITE[given] == statement.kind else "differs"
    numbers = numbers_in(given)
    pair = takes_pair(statement)
    if len(numbers) != (2 if pair else 1):
        return "differs"
    if pair:
        ends = (statement.text, statement.upper or statement.uncertainty)
        stated = [scaled(replace(statement, text=end)) for end in ends]
        kinds = [compare(*end, number) for end, number in zip(stated, numbers, strict=True)]
        return max(kinds, key=_KINDS.index)
    if statement.kind == "inside":
        lower, upper = (scaled(replace(statement, text=end)) for end in (statement.text, statement.upper))
        return _inside(lower, upper, numbers[0])
    return _bound_or_count(statement, numbers[0])


def _bound_or_count(statement: Statement, value: Decimal) -> Agreement:
    printed, unit = scaled(statement)
    if statement.kind == "count":
        return "equal" if value == printed else "differs"
    beyond = value < printed if statement.kind == "below" else value > printed
    beyond = beyond or (statement.reached and value == printed)
    # A value that rounds to the bound itself is on the border.
    return "equal" if beyond else "near" if 2 * abs(value - printed) <= unit else "differs"


def scaled(statement: Statement) -> tuple[Decimal, Decimal]:
    """Return the number that is stated and the weight of its last digit."""
    number = parse_number(statement.text)
    if number is None:
        msg = f"'{statement.text}' states no number"
        raise ValueError(msg)
    number = number.scaleb(statement.scale)
    return number, Decimal(1).scaleb(last_place(number))


def _inside(lower: tuple[Decimal, Decimal], upper: tuple[Decimal, Decimal], value: Decimal) -> Agreement:
    if lower[0] <= value <= upper[0]:
        return "equal"
    unit = max(lower[1], upper[1])
    return "near" if lower[0] - unit / 2 <= value <= upper[0] + unit / 2 else "differs"

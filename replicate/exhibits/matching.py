"""Whether a computed number agrees with a printed one, at the printed precision.

The computed number is first written with 12 significant digits, and every comparison is made exactly on that
decimal. So a match can be recomputed from ``results.csv`` alone, and no binary rounding error decides one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from decimal import ROUND_HALF_UP, Decimal, localcontext
from functools import partial
from typing import Literal

from replicate.exhibits.near import USUAL, Near
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.statements import compare_statement

MatchKind = Literal["equal", "consistent", "near", "differs", "none"]
MatchHow = Literal["rounded", "truncated", "either", ""]

COMPUTED_DIGITS = 12

_BEST_FIRST: dict[MatchKind, int] = {"equal": 0, "consistent": 1, "near": 2, "differs": 3, "none": 4}

# Wide enough that sums of a 12-digit number and a printed one, of any magnitudes that can tie, are exact.
_PRECISION = 200


@dataclass(frozen=True)
class Match:
    """How a computed value compares with a printed one.

    Attributes
    ----------
    kind
        ``equal``: the computed value rounds, or truncates, to the print. ``consistent``: it does not, but inputs
        that round to what the paper prints give a value that does. ``near``: within 2 units of the last printed
        digit or 1 % of the print. ``differs``: none of these. ``none``: nothing was computed.
    how
        For a value that holds: ``rounded``, ``truncated``, or ``either`` where both fit. One that holds by the
        convention of other columns only is ``near``, and keeps this (`replicate.exhibits.conventions`).
    """

    kind: MatchKind
    how: MatchHow = ""


def computed_text(value: float | None) -> str:
    """Write a computed number with 12 significant digits; empty where there is none (``None`` or NaN).

    Examples
    --------
    >>> computed_text(2 / 3)
    '0.666666666667'
    >>> computed_text(float("nan"))
    ''
    """
    if value is None or math.isnan(value):
        return ""
    return f"{value + 0.0:.{COMPUTED_DIGITS}g}"  # + 0.0 turns -0 into 0


def match(
    printed: PrintedValue | str, computed: float | None, significant_digits: int | None = None, word: str = ""
) -> Match:
    """Compare a computed value with a printed one.

    Parameters
    ----------
    printed
        The print, as text or as read from a printed CSV.
    computed
        The computed value; ``None`` or NaN where there is none.
    significant_digits
        If given: the paper prints so many significant digits and strips trailing zeros.
    word
        What is computed if it is not a number: a word, a date, or the two numbers of a pair.

    Returns
    -------
    Match
        A tie rounds either way, because papers do.

    Raises
    ------
    PrintedFileError
        If the printed text is not a number.

    Examples
    --------
    >>> match("6.968", 6.96849)
    Match(kind='equal', how='either')
    >>> match("6.968", 6.9689)
    Match(kind='equal', how='truncated')
    >>> match("6.9680", 6.9689).kind, match("6.968", 7.1).kind, match("6.968", None).kind
    ('near', 'differs', 'none')
    """
    if isinstance(printed, str):
        printed = PrintedValue(printed)
    if significant_digits is not None:
        printed = replace(printed, significant_digits=significant_digits)
    text = word or computed_text(computed)
    if not text:
        return Match("none")
    with localcontext(prec=_PRECISION):
        if printed.reading_error is not None:
            return _within(printed.value, printed.reading_error, Decimal(text))
        compare = partial(_compare, near=printed.near)
        if not printed.states_number or word:
            return Match(compare_statement(printed.statement, text, lambda *numbers: compare(*numbers).kind))
        found = [compare(value, printed.unit, Decimal(text)) for value in printed.candidates]
    best = min(found, key=lambda one: _BEST_FIRST[one.kind])
    return replace(best, how="either") if printed.lost_digit and best.how else best


def meets(printed: str, computed: float) -> bool:
    """Whether a computed value is equal to a print, for exhibits that count how many numbers a hypothesis meets.

    Examples
    --------
    >>> meets("3.84", 3.8361), meets("3.84", 3.8499), meets("3.84", 3.8501), meets("3.84", 3.834)
    (True, True, False, False)
    """
    return match(printed, computed).kind == "equal"


def _within(printed: Decimal, error: Decimal, computed: Decimal) -> Match:
    """Compare with a point read off a figure."""
    distance = abs(computed - printed)
    return Match("equal" if distance <= error else "near" if distance <= 2 * error else "differs")


def _compare(printed: Decimal, unit: Decimal, computed: Decimal, near: Near = USUAL) -> Match:
    distance = abs(computed - printed)
    rounds = 2 * distance <= unit
    # Truncation goes toward zero: the computed value lies farther out, on the same side.
    truncates = 0 <= abs(computed) - abs(printed) < unit and computed * printed >= 0
    if rounds or truncates:
        return Match("equal", "either" if rounds and truncates else "rounded" if rounds else "truncated")
    if distance <= Decimal(str(near.units)) * unit or distance <= Decimal(str(near.fraction)) * abs(printed):
        return Match("near")
    return Match("differs")


def format_like(printed: PrintedValue, computed: float, unit: Decimal | None = None) -> str:
    """Write a finite computed value with the precision of a printed one.

    Parameters
    ----------
    printed
        Where its table has fixed significant digits, so has the result, without trailing zeros; otherwise
        the result ends at the same decimal place.
    computed
        A finite number.
    unit
        The weight of the last digit, where it is to be larger than that of the print.

    Examples
    --------
    >>> format_like(PrintedValue("1.20"), 3.0), format_like(PrintedValue("1.20"), 3.14, Decimal("0.1"))
    ('3.00', '3.1')
    >>> format_like(PrintedValue("1.9715", significant_digits=6), 1.671586)
    '1.67159'
    """
    number = Decimal(computed_text(computed))
    with localcontext(prec=_PRECISION):
        if printed.significant_digits is None or not number:
            return f"{number.quantize(max(unit or printed.unit, printed.unit), rounding=ROUND_HALF_UP):f}"
        place = Decimal(1).scaleb(number.adjusted() - printed.significant_digits + 1)
        place = max(unit, place) if unit and unit > printed.unit else place
        text = f"{number.quantize(place, rounding=ROUND_HALF_UP):f}"
    return text.rstrip("0").rstrip(".") if "." in text else text

"""Numbers as papers print them in plain notation: sign, digits, decimal point, repeating decimals, exponent.

A last digit that cannot be read in the copy at hand is a question mark: ``1.2?`` is one of 1.20 to 1.29.
"""

from __future__ import annotations

import re
from decimal import Decimal

MINUS = "\N{MINUS SIGN}"
LOST = "?"
ALLOWED = (
    "digits with an optional sign, decimal point, repeating decimals in brackets, ? for a lost last digit, exponent"
)

#: A longer number, or one beyond any computed one, is more likely a slip than a print.
MOST_DIGITS, LARGEST_EXPONENT = 100, 300

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*\??|\.\d+\??|\d*\.\d*\[(?P<repeated>\d+)\])([eE][+-]?\d{1,4})?", re.ASCII)
_REPEATED_DIGITS = 30  # many more than comparisons use


def parse_number(text: str) -> Decimal | None:
    """Read a printed number exactly; ``None`` if the text is not one, or is longer or larger than any print.

    Examples
    --------
    >>> parse_number("6.9680")
    Decimal('6.9680')
    >>> parse_number("1.2?")
    Decimal('1.20')
    >>> parse_number("0.91[6]").quantize(Decimal("1e-9"))
    Decimal('0.916666667')
    >>> parse_number("1,2") is None
    True
    """
    plain = text.replace(MINUS, "-")
    found = _NUMBER.fullmatch(plain) if len(plain) <= MOST_DIGITS else None
    if found is None:
        return None
    digits = found["repeated"]
    if digits:
        plain = plain.replace(f"[{digits}]", (digits * _REPEATED_DIGITS)[:_REPEATED_DIGITS])
    number = Decimal(plain.replace(LOST, "0"))
    return number if not number or abs(number.adjusted()) <= LARGEST_EXPONENT else None


def last_place(number: Decimal) -> int:
    """Return the exponent of the last digit that is written."""
    exponent = number.as_tuple().exponent
    assert isinstance(exponent, int)  # noqa: S101  -- a letter for NaN and infinity only
    return exponent

"""Numbers with a decimal mark, separators of groups and a power of ten of any kind, turned into plain notation."""

from __future__ import annotations

import re

from replicate.exhibits.numerals import parse_number

_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_EXPONENT = r"\{?\s*(?P<exponent>[+-]?[\d⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]{1,4})\s*\}?"
_POWER = re.compile(rf"\s*[×x·*]\s*10\s*(?:\^|\*\*)?\s*{_EXPONENT}$")
_POWER_ALONE = re.compile(rf"(?P<sign>[+-]?)10\s*(?:(?:\^|\*\*)\s*{_EXPONENT}|(?P<raised>[⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]{{1,3}}))")
_GROUPS = {",": ",", ".": ".", "'": "'’", " ": " \u00a0\u2009\u202f"}


def plain_number(text: str, decimal: str = ".", thousands: str = "") -> str | None:
    """Return a number in plain notation: sign, digits, decimal point, exponent; ``None`` if the text is not one.

    Parameters
    ----------
    text
        With ``-`` for minus.
    decimal, thousands
        As of `replicate.exhibits.Notation`.

    Examples
    --------
    >>> plain_number("1.234,50", decimal=",", thousands="."), plain_number("6.626 070 × 10^-34", thousands=" ")
    ('1234.50', '6.626070e-34')
    >>> plain_number("0,123", thousands=",") is None  # no group begins with zero: a decimal comma
    True
    """
    text = text.strip()
    alone = _POWER_ALONE.fullmatch(text)
    if alone:
        return f"{alone['sign']}1e{int((alone['exponent'] or alone['raised']).translate(_SUPERSCRIPTS))}"
    power = _POWER.search(text)
    exponent = ""
    if power:
        text, exponent = text[: power.start()], f"e{int(power['exponent'].translate(_SUPERSCRIPTS))}"
    for mark in _GROUPS.get(thousands, ""):
        whole, point, rest = text.partition(decimal)
        if mark in whole:
            first, *groups = whole.lstrip("+-").split(mark)
            if not re.fullmatch(r"[1-9]\d{0,2}", first) or any(len(group) != 3 for group in groups):
                return None
        if mark in rest and thousands == " ":
            *groups, last = rest.split(mark)
            if any(len(group) != 3 for group in groups) or not re.match(r"\d{1,3}(?!\d)", last):
                return None
            rest = rest.replace(mark, "")
        text = whole.replace(mark, "") + point + rest
    if decimal != ".":
        if "." in text:
            return None
        text = text.replace(decimal, ".")
    text += exponent
    return None if parse_number(text) is None else text

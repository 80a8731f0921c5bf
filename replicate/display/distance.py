"""How far a computed value is from its print: in per cent, and in units of the last printed digit."""

from __future__ import annotations

import math
from decimal import Decimal

from replicate.exhibits.matching import computed_text
from replicate.exhibits.numerals import MINUS
from replicate.exhibits.printed import PrintedValue


def off(printed: PrintedValue | None, number: float | None) -> str:
    """Return how far off the print is, seen from the computed value; empty where nothing can be said.

    Examples
    --------
    >>> off(PrintedValue("2.10"), 2.0), off(PrintedValue("0.0"), 0.26), off(PrintedValue("1.20"), 1.2)
    ('+5 %, 10 units of the last digit', '3 units of the last digit', '')
    >>> off(PrintedValue("0.[6]"), 0.5), off(PrintedValue("2.1?"), 2.0)  # no last digit to count in
    ('+33 %', '+5 %')
    """
    if printed is None or number is None or not math.isfinite(number) or not printed.states_number:
        return ""
    computed = Decimal(computed_text(number))
    gap = printed.value - computed
    units = abs(gap) / printed.unit
    if units <= Decimal("0.5"):
        return ""
    found = []
    if printed.value and computed:
        percent = 100 * gap / abs(computed)
        found.append(f"{'+' if percent > 0 else MINUS}{_short(abs(percent), 2)} %")
    if not (printed.repeating or printed.lost_digit):
        found.append(f"{_short(units)} unit{'s' if _short(units) != '1' else ''} of the last digit")
    return ", ".join(found)


def _short(value: Decimal, digits: int = 1) -> str:
    """Return a size as one would say it: whole numbers above ten, few digits below."""
    if value >= 10:
        return f"{value:.0f}" if value < Decimal("1e6") else f"{value:.1e}".replace("e+", "e")
    text = f"{value:.{digits}g}"
    return f"{Decimal(text).normalize():f}"

"""Numbers as the report shows them: a little more precise than the print, decimal points under each other."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from decimal import ROUND_HALF_EVEN, Decimal

from replicate.exhibits.matching import computed_text
from replicate.exhibits.numerals import MINUS
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.statements import numbers_in, scaled

FIGURE_SPACE = "\N{FIGURE SPACE}"  # as wide as a digit
OVERLINE = "\N{COMBINING OVERLINE}"
PUNCTUATION_SPACE = "\N{PUNCTUATION SPACE}"  # as wide as a decimal point

_HYPHEN = re.compile(r"(?<![\w.)\]/-])-(?=[\d\[]|\.\d)|(?<=[\d.]e)-(?=\d)")  # before a number, not between two
_EXPONENT = re.compile(r"(?<=\d)e([+-])0*(?=\d)(\d+)\b")
_REPEATED = re.compile(r"(?<=[\d.])\[(\d+)\]")  # the brackets of an interval hold more, and follow nothing
_PLAIN_DIGITS = 6  # significant digits where nothing printed tells how many are of interest
_LONG_PRINT = 5  # a print with at least so many digits is followed by one more, a shorter one by two
_MOST_PADDING = 8  # a column that mixes 0.0000001 and 1000 is not aligned


def shown(computed: float | None, printed: PrintedValue | None) -> str:
    """Return a computed number with one or two digits more than the print has, and never more than it has itself.

    Parameters
    ----------
    computed
        The number; `None` and NaN give an empty text.
    printed
        What it is compared with; without it the number is shown with six significant digits.

    Examples
    --------
    >>> shown(6.96812345, PrintedValue("6.968"))
    '6.96812'
    >>> shown(6.96812345, PrintedValue("6.968", significant_digits=6))
    '6.968123'
    >>> shown(-497.0, PrintedValue("-0.43035")), shown(2.0, PrintedValue("2.10"))
    ('−497', '2')
    >>> shown(-0.5, None), shown(1e-9, PrintedValue("0.1")), shown(float("inf"), None)
    ('−0.5', '1e−9', '∞')
    """
    text = computed_text(computed)
    if computed is None or not text:
        return ""
    if math.isinf(computed):
        return "∞" if computed > 0 else f"{MINUS}∞"
    number = Decimal(text)
    if not number:
        return "0"
    if printed is not None and printed.repeating:
        printed = None
    if printed is None or not printed.value:
        place = number.adjusted() - _PLAIN_DIGITS + 1
        if printed is not None:  # a printed zero: its decimals say what is of interest
            place = printed.unit.adjusted() - 2
    else:
        digits = printed.value.adjusted() - printed.unit.adjusted() + 1
        place = printed.unit.adjusted() - (1 if digits >= _LONG_PRINT else 2)
    significant = number.adjusted() - place + 1
    if not (1 <= significant <= 12 and -5 <= number.adjusted() < 9):
        return _scientific(number)
    if printed is None:
        return _minus(_stripped(f"{number:.{_PLAIN_DIGITS}g}") if place < 0 else f"{number:.0f}")
    rounded = number.quantize(Decimal(1).scaleb(min(place, 0)), rounding=ROUND_HALF_EVEN)
    own = number.normalize()  # a reading may round, and what it rounded away is not made up again
    return _minus(f"{own if own == rounded else rounded:f}")


def shown_word(word: str, printed: PrintedValue | None) -> str:
    """Return what is computed in place of a number: a word or a date as it is, each number of a pair as `shown`.

    Examples
    --------
    >>> from replicate.exhibits import Notation
    >>> shown_word("3.00949525 0.0776547", PrintedValue("3.01 ± 0.08", notation=Notation(uncertainty=True)))
    '3.0095 ± 0.0777'
    >>> shown_word("1.2041 -3.4", PrintedValue("[1.2, -3.4]", notation=Notation(interval="ends")))
    '1.204 to −3.4'
    >>> shown_word("n.s.", None)
    'n.s.'
    """
    if printed is None or len(computed := numbers_in(word)) != 2:
        return word
    statement = printed.statement
    stated = (statement.text, statement.upper or statement.uncertainty or statement.text)
    prints = [PrintedValue(str(scaled(replace(statement, text=text))[0])) for text in stated]
    ends = [shown(float(number), one) for number, one in zip(computed, prints, strict=True)]
    return (" to " if statement.upper else " ± ").join(ends)


def _scientific(number: Decimal) -> str:
    mantissa, exponent = f"{number:.{_PLAIN_DIGITS - 1}e}".split("e")
    return _minus(f"{_stripped(mantissa)}e{int(exponent)}")


def _stripped(text: str) -> str:
    """Return a number without the zeros that say nothing: those at the end of a computed one."""
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def _minus(text: str) -> str:
    return text.replace("-", MINUS)


def overlined(printed: str) -> str:
    r"""Return a print as the paper shows it: digits in brackets under an overbar, a minus sign that is one.

    Examples
    --------
    >>> overlined("-0.916"), overlined("0.91[6]") == "0.916\N{COMBINING OVERLINE}", overlined("[1.2, 3.4]")
    ('−0.916', True, '[1.2, 3.4]')
    """
    return _REPEATED.sub(lambda found: "".join(f"{digit}{OVERLINE}" for digit in found[1]), _HYPHEN.sub(MINUS, printed))


def minus_signs(text: str) -> str:
    """Return a text in which numbers have minus signs, and exponents neither a plus sign nor zeros before them.

    Examples
    --------
    >>> minus_signs("from -0.5 to 4.1e-04, pp. 3-5, x-1"), minus_signs("1.7e+06 or -3e10")
    ('from −0.5 to 4.1e−4, pp. 3-5, x-1', '1.7e6 or −3e10')
    """
    text = _EXPONENT.sub(lambda found: f"e{MINUS if found[1] == '-' else ''}{found[2]}", text)
    return _HYPHEN.sub(MINUS, text)


def full(computed: float | None) -> str:
    """Return a number with all twelve digits that comparisons use.

    Examples
    --------
    >>> full(-2 / 3), full(-3.49297502034e-09)
    ('−0.666666666667', '−3.49297502034e−9')
    """
    return minus_signs(computed_text(computed))


def quoted(computed: float, text: str) -> str:
    """Return a number as a text quotes it, if that is with one digit and a power of ten; empty otherwise.

    What is zero but for rounding has no second digit: beside "within 1e-15" it is not 1.38778e-15.

    Examples
    --------
    >>> quoted(1.38778e-15, "The deviation is 1e-15."), quoted(1.38778e-15, "Below 1e-12."), quoted(3e-15, "13e-15")
    ('1e−15', '', '')
    """
    one_digit = f"{computed:.0e}"
    stands = re.search(rf"(?<![\d.]){re.escape(one_digit)}(?!\d)", text)
    return minus_signs(one_digit) if stands and math.isfinite(computed) else ""


def between(low: str, high: str) -> str:
    """Return a range as text, one number if its ends are shown alike; empty if it has none.

    Examples
    --------
    >>> between("1.25", "1.3"), between("1.25", "1.25"), between("", "1.3")
    ('1.25 to 1.3', '1.25', '')
    """
    if not low or not high:
        return ""
    return low if low == high else f"{low} to {high}"


def aligned(texts: Iterable[str]) -> dict[str, str]:
    r"""Return, by text, the number with spaces after it that bring the points of a column in line; not a pair.

    Examples
    --------
    >>> [text.replace("\u2007", "_").replace("\u2008", ",") for text in aligned(["1.25", "10"]).values()]
    ['1.25', '10__,']
    >>> aligned(["1.2", "3.0095 ± 0.0777"])["1.2"]
    '1.2'
    """
    texts = list(texts)
    alone = [text for text in texts if text and "e" not in text and text.count(".") < 2]
    decimals = {text: len(text.replace(OVERLINE, "").partition(".")[2]) for text in alone}
    most = max(decimals.values(), default=0)
    result = dict.fromkeys(texts, "")
    for text in result:
        result[text] = text
        missing = most - decimals.get(text, most)
        if 0 < missing <= _MOST_PADDING:
            result[text] += FIGURE_SPACE * missing + (PUNCTUATION_SPACE if "." not in text else "")
    return result

r"""How a column prints its values: bounds, stars, parentheses, percent, decimal commas, dates, words, and their like.

A paper declares it for a table or a column: ``notation=Notation(bounds=True, stars=True)``. A printed text is then read
into what it states, a `Statement`, and compared by the rule of its kind:

=============================  ==================================================================================
print                          the computed value is equal if
=============================  ==================================================================================
``6.968``, ``1.2 × 10^-3``     it rounds (or truncates) to the print
``<0.001``, ``>10``            it is beyond the bound
``0.12***``                    it rounds to the number; the stars are not compared
``(0.045)``                    as declared: it rounds to −0.045, or is a standard error and rounds to 0.045
``3.4 ± 0.2``, ``3.4(2)``      it rounds to 3.4; a pair ``(value, uncertainty)`` must round to both
``12 %``                       it rounds to 12, or as declared, as a fraction, to 0.12
``[1.2, 3.4]``                 a pair of ends rounds to both; or as declared, a number lies between them
a count                        it is that whole number
a date                         it is that day
a word from the fixed list     it is that word
=============================  ==================================================================================
"""

from __future__ import annotations

import datetime as dt
import re
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

from replicate.errors import PrintedFileError
from replicate.exhibits.numerals import ALLOWED, MINUS, last_place, parse_number

Kind = Literal["number", "below", "above", "interval", "inside", "count", "date", "word"]

_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_POWER = re.compile(r"\s*[×x·*]\s*10\s*(?:\^|\*\*)?\s*\{?\s*([+-]?[\d⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]{1,4})\s*\}?$")
_STARS = re.compile(r"\s*[*∗†‡§]{1,4}$")
_UNCERTAIN = re.compile(r"(.*?)\s*(?:±|\+/-|\+-)\s*(.*)")
_CONCISE = re.compile(r"(.*\d)\((\d+)\)(.*)")
_INTERVAL = re.compile(r"[\[(]\s*(.+?)\s*(?:;|\.\.\.|–|\bto\b|,(?=\s))\s*(.+?)\s*[\])]")
_GROUPS = {",": ",", ".": ".", "'": "'’", " ": " \u00a0\u2009\u202f"}
_DATE = re.compile(r"\d{4}-\d{2}-\d{2}")


@dataclass(frozen=True)
class Statement:
    """What a printed text states.

    Attributes
    ----------
    kind
        How it is compared; see the table above.
    text
        The number in plain notation: sign, digits, decimal point, exponent; trailing zeros are kept. For a word or a
        date the text itself.
    scale
        Power of ten to shift the number by: −2 for a percentage whose computed value is a fraction.
    uncertainty
        In plain notation, for ``3.4 ± 0.2`` and ``3.4(2)``.
    upper
        The upper end of an interval, in plain notation; `text` is the lower.
    """

    kind: Kind
    text: str
    scale: int = 0
    uncertainty: str = ""
    upper: str = ""


@dataclass(frozen=True)
class Notation:
    """How a column prints its values.

    Attributes
    ----------
    decimal, thousands
        The decimal mark, ``.`` or ``,``, and what separates groups of three digits: ``,``, ``.``, ``'`` or a space.
    bounds
        ``<0.001`` and ``>10`` occur.
    stars
        Stars and daggers of significance may follow a number.
    parentheses
        What a number in parentheses is: ``negative``, or a ``standard-error``.
    uncertainty
        ``3.4 ± 0.2`` and ``3.4(2)`` occur.
    percent
        A per cent sign may follow a number. The readings compute in ``percent`` (12) or as a ``fraction`` (0.12).
    interval
        ``[1.2, 3.4]`` occurs; readings compute a pair of ``ends``, or a number that must lie ``inside``.
    count
        Every number is a whole number that counts something: nothing is rounded.
    date
        Every cell is a date, ``2003-05-17``.
    words
        A fixed list of words that may stand in place of a number.
    none
        Texts that mean that there is no value, besides a blank cell.

    Examples
    --------
    >>> Notation(bounds=True).read("<0.001")
    Statement(kind='below', text='0.001', scale=0, uncertainty='', upper='')
    >>> Notation(decimal=",", thousands=".").read("1.234,50").text
    '1234.50'
    >>> Notation(uncertainty=True).read("3.4(2)").uncertainty
    '0.2'
    """

    decimal: Literal[".", ","] = "."
    thousands: Literal["", ",", ".", "'", " "] = ""
    bounds: bool = False
    stars: bool = False
    parentheses: Literal["", "negative", "standard-error"] = ""
    uncertainty: bool = False
    percent: Literal["", "percent", "fraction"] = ""
    interval: Literal["", "ends", "inside"] = ""
    count: bool = False
    date: bool = False
    words: tuple[str, ...] = ()
    none: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.decimal == self.thousands:
            msg = f"decimal and thousands are both '{self.decimal}'; expected: two different marks"
            raise ValueError(msg)

    @property
    def plain(self) -> bool:
        """Whether a reading must give a single number."""
        return not (self.words or self.date or self.interval == "ends" or self.uncertainty)

    def is_blank(self, text: str) -> bool:
        """Whether a cell holds no printed value.

        Parameters
        ----------
        text
            The cell.
        """
        return not text or text in self.none

    def read(self, text: str) -> Statement:
        """Read a printed text.

        Parameters
        ----------
        text
            The cell, not blank.

        Raises
        ------
        PrintedFileError
            If it is none of what the notation allows; the message says what is allowed.
        """
        plain = text.strip()
        if plain in self.words:
            return Statement("word", plain)
        if self.date:
            return self._date(plain)
        found = self.states(plain)
        if found is None:
            msg = f"'{text}' is not {self.allowed}{_hint(plain)}"
            raise PrintedFileError(msg)
        return found

    def states(self, text: str) -> Statement | None:
        """Return what a number or an interval states; ``None`` if the text is neither.

        Parameters
        ----------
        text
            The cell, without spaces around it.
        """
        return (self._interval(text) if self.interval else None) or self._number(text)

    @property
    def allowed(self) -> str:
        """What a cell may hold, in words."""
        parts = ["a whole number" if self.count else "a number"]
        marks = {"decimal comma": self.decimal == ",", "separators of thousands": bool(self.thousands)}
        marks |= {"stars": self.stars, "a per cent sign": bool(self.percent), "an uncertainty": self.uncertainty}
        with_ = [name for name, there in marks.items() if there]
        if with_:
            parts[0] += f" (allowed: {', '.join(with_)})"
        parts += ["a bound such as <0.001"] if self.bounds else []
        parts += ["a number in parentheses"] if self.parentheses else []
        parts += ["an interval such as [1.2, 3.4]"] if self.interval else []
        parts = ["a date such as 2003-05-17"] if self.date else parts
        parts += [f"'{word}'" for word in self.words]
        return " or ".join(parts) if len(parts) > 1 or with_ or self.count or self.date else PLAIN_ALLOWED

    def _date(self, text: str) -> Statement:
        if _DATE.fullmatch(text):
            try:
                return Statement("date", dt.date.fromisoformat(text).isoformat())
            except ValueError:  # the 30th of February
                pass
        msg = f"'{text}' is not {self.allowed}"
        raise PrintedFileError(msg)

    def _interval(self, text: str) -> Statement | None:
        match = _INTERVAL.fullmatch(text)
        lower, upper = (self._plain(match[1]), self._plain(match[2])) if match else (None, None)
        if lower is None or upper is None:
            return None
        return Statement("interval" if self.interval == "ends" else "inside", lower, upper=upper)

    def _number(self, text: str) -> Statement | None:
        kind: Kind = "count" if self.count else "number"
        if self.bounds and text[:1] in {"<", ">", "≤", "≥"}:
            kind = "below" if text[0] in "<≤" else "above"
            text = text[1:].removeprefix("=").strip()
        if self.stars:
            text = _STARS.sub("", text)
        scale = 0
        if self.percent and text.endswith("%"):
            text, scale = text[:-1].rstrip(), -2 if self.percent == "fraction" else 0
        sign = ""
        if self.parentheses and text.startswith("(") and text.endswith(")"):
            text, sign = text[1:-1].strip(), "-" if self.parentheses == "negative" else ""
        uncertainty = ""
        if self.uncertainty:
            text, uncertainty = self._uncertain(text)
        number = self._plain(text)
        if number is None or (self.count and not number.lstrip("+-").isdigit()):
            return None
        return Statement(kind, sign + number, scale, uncertainty)

    def _uncertain(self, text: str) -> tuple[str, str]:
        """Return value and uncertainty; that of ``3.4(2)`` counts units of the last digit."""
        match = _UNCERTAIN.fullmatch(text)
        if match:
            return match[1], self._plain(match[2]) or ""
        match = _CONCISE.fullmatch(text)
        value = self._plain(match[1] + match[3]) if match else None
        if match is None or value is None:
            return text, ""
        return match[1] + match[3], f"{Decimal(match[2]).scaleb(last_place(Decimal(value))):f}"

    def _plain(self, text: str) -> str | None:
        """Return a number in plain notation; ``None`` if the text is not one."""
        text = text.strip().replace(MINUS, "-")
        power = _POWER.search(text)
        exponent = ""
        if power:
            text, exponent = text[: power.start()], f"e{int(power[1].translate(_SUPERSCRIPTS))}"
        for mark in _GROUPS.get(self.thousands, ""):
            if mark in text:
                whole, point, rest = text.partition(self.decimal)
                groups = whole.lstrip("+-").split(mark)
                if not 1 <= len(groups[0]) <= 3 or any(len(group) != 3 for group in groups[1:]):
                    return None
                text = whole.replace(mark, "") + point + rest
        if self.decimal == ",":
            if "." in text:
                return None
            text = text.replace(",", ".")
        text += exponent
        return None if parse_number(text) is None else text


def _hint(text: str) -> str:
    """Say which notation would accept a text, if one would."""
    for name, notation in _SUGGESTIONS.items():
        if notation.states(text) is not None:
            return f"; notation=Notation({name}) would accept it"
    return ""


PLAIN_ALLOWED = f"a number; allowed: {ALLOWED}"
PLAIN = Notation()

_SUGGESTIONS = {
    "bounds=True": Notation(bounds=True),
    "stars=True": Notation(stars=True),
    'percent="percent"': Notation(percent="percent"),
    'parentheses="negative"': Notation(parentheses="negative"),
    "uncertainty=True": Notation(uncertainty=True),
    'interval="ends"': Notation(interval="ends"),
    'thousands=","': Notation(thousands=","),
    'decimal=","': Notation(decimal=","),
    'thousands=" "': Notation(thousands=" "),
    'decimal=",", thousands="."': Notation(decimal=",", thousands="."),
}

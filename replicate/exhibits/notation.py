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
a count, a date, a word        it is that one
=============================  ==================================================================================
"""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from decimal import Decimal
from itertools import combinations
from typing import Any, Literal

from replicate.errors import PrintedFileError
from replicate.exhibits.definitions import check_lists, check_one_of, refuse
from replicate.exhibits.grouped_numbers import plain_number
from replicate.exhibits.numerals import ALLOWED, MINUS, last_place, parse_number

Kind = Literal["number", "below", "above", "interval", "inside", "count", "date", "word"]

_STARS = re.compile(r"(\s*[*∗†‡§]){1,4}$")
_FACTOR = r"(?:\s*[×x·*]\s*10.*|[eE][+-]?\d+)?"
_UNCERTAIN = re.compile(r"(.*?)\s*(?:±|\+/-|\+-)\s*(.*)")
_UNCERTAIN_INSIDE = re.compile(rf"\(\s*(.*(?:±|\+/-|\+-).*?)\s*\)({_FACTOR})")
_CONCISE = re.compile(rf"([^()eE×]*\d)\((\d+|\d*[.,·]\d+)\)({_FACTOR})")
_BRACKETS = re.compile(r"[\[(\]](.+)[\])\[]")
_BETWEEN = re.compile(r"\s*(?:;|\.\.\.|…|–|\bto\b|,(?=\s))\s*")
_ANY_COMMA = re.compile(r"\s*,\s*")
_WITHOUT_BRACKETS = re.compile(r"\s*(?:\.\.\.|…|–|\bto\b)\s*")
_DASH = re.compile(r"[-–—−.…/]+")
_WORD = re.compile(r"[^\W\d_⁰-₟²³¹]\D+")


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
    reached
        Whether a bound may be reached: ``≤`` and ``≥``.
    """

    kind: Kind
    text: str
    scale: int = 0
    uncertainty: str = ""
    upper: str = ""
    reached: bool = False


@dataclass(frozen=True)
class Notation:
    """How a column prints its values.

    Attributes
    ----------
    decimal, thousands
        The decimal mark, ``.``, ``,`` or ``·``, and what separates groups of three digits: ``,``, ``.``, ``'`` or a
        space, which may also stand between digits behind the decimal mark.
    bounds
        ``<0.001`` and ``>10`` occur.
    stars
        Stars and daggers of significance may follow a number.
    parentheses
        What a number in parentheses is: ``negative``, or a ``standard-error``.
    uncertainty
        ``3.4 ± 0.2``, ``3.4(2)`` and ``(3.4 ± 0.2) × 10^-3`` occur.
    percent
        A per cent sign may follow a number. The readings compute in ``percent`` (12) or as a ``fraction`` (0.12).
    interval
        ``[1.2, 3.4]`` and ``1.2–3.4`` occur; readings compute a pair of ``ends``, or a number that must lie ``inside``.
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
    Statement(kind='below', text='0.001', scale=0, uncertainty='', upper='', reached=False)
    >>> Notation(decimal=",", thousands=".").read("1.234,50").text
    '1234.50'
    >>> Notation(uncertainty=True).read("3.4(2)").uncertainty
    '0.2'
    """

    decimal: Literal[".", ",", "·"] = "."
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
        for name, allowed in _CHOICES.items():
            check_one_of("notation", name, getattr(self, name), allowed)
        check_lists("notation", words=self.words, none=self.none)
        if self.decimal == self.thousands:
            refuse(f"notation: decimal and thousands are both '{self.decimal}'; expected: two different marks")

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
        found = self.states(plain)
        if found is None:
            msg = f"'{text}' is not {self.allowed}{hint(self, plain)}"
            raise PrintedFileError(msg)
        return found

    def states(self, text: str) -> Statement | None:
        """Return what a number, an interval or a date states; ``None`` if the text is none of what is declared.

        Parameters
        ----------
        text
            The cell, without spaces around it.
        """
        if self.date:
            return Statement("date", text) if is_date(text) else None
        text = text.replace(MINUS, "-")
        return (self._interval(text) if self.interval else None) or self._number(text)

    @property
    def declared(self) -> str:
        """How it is declared."""
        given = {one.name: getattr(self, one.name) for one in fields(self) if getattr(self, one.name) != one.default}
        said = (
            f"{name}={value!r}" if value == "'" else f"{name}={value!r}".replace("'", '"')
            for name, value in given.items()
        )
        return f"Notation({', '.join(said)})"

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

    def _interval(self, text: str) -> Statement | None:
        """Read ``[1.2, 3.4]``; what separates the ends is what leaves a number on both sides."""
        text, percent = self._bare(text)
        brackets = _BRACKETS.fullmatch(text)
        separators = [_BETWEEN if brackets else _WITHOUT_BRACKETS]
        if brackets and "," not in (self.decimal, self.thousands):
            separators.append(_ANY_COMMA)
        inside = brackets[1] if brackets else text
        for found in (found for separator in separators for found in separator.finditer(inside)):
            (lower, _), (upper, also) = self._bare(inside[: found.start()]), self._bare(inside[found.end() :])
            ends = self._plain(lower), self._plain(upper)
            if ends[0] is not None and ends[1] is not None:
                kind: Kind = "interval" if self.interval == "ends" else "inside"
                return Statement(kind, ends[0], self._scale(percent or also), upper=ends[1])
        return None

    def _number(self, text: str) -> Statement | None:
        kind: Kind = "count" if self.count else "number"
        reached = False
        if self.bounds and text[:1] in {"<", ">", "≤", "≥"}:
            kind = "below" if text[0] in "<≤" else "above"
            reached = text[0] in "≤≥" or text[1:2] == "="
            text = text[1:].removeprefix("=").strip()
        text, percent = self._bare(text)
        sign = ""
        if self.parentheses and text.startswith("(") and text.endswith(")") and not _UNCERTAIN_INSIDE.fullmatch(text):
            text, also = self._bare(text[1:-1].strip())
            percent, sign = percent or also, "-" if self.parentheses == "negative" else ""
            if text.startswith(("-", "+")):
                return None  # twice negative, or a negative error: what is meant is for the reader of the paper to say
        number, uncertainty = (self._uncertain(text, percent) if self.uncertainty else None) or (self._plain(text), "")
        if number is None or (self.count and not number.lstrip("+-").isdigit()):
            return None
        return Statement(kind, sign + number, self._scale(percent), uncertainty, reached=reached)

    def _bare(self, text: str) -> tuple[str, bool]:
        """Return a text without the stars and the per cent sign behind it, and whether there was such a sign."""
        text = _STARS.sub("", text) if self.stars else text
        percent = bool(self.percent) and text.endswith("%")
        if percent:
            text = text[:-1].rstrip()
            text = _STARS.sub("", text) if self.stars else text
        return text, percent

    def _scale(self, percent: bool) -> int:
        return -2 if percent and self.percent == "fraction" else 0

    def _uncertain(self, text: str, percent: bool) -> tuple[str, str] | None:
        """Return value and uncertainty; digits in parentheses without a decimal mark count units of the last digit."""
        common = _UNCERTAIN_INSIDE.fullmatch(text)
        match = _UNCERTAIN.fullmatch(common[1] if common else text)
        if match:
            (first, of_first), (second, of_second) = self._bare(match[1]), self._bare(match[2])
            factor = common[2] if common else ""
            value, uncertainty = self._plain(first + factor), self._plain(second + factor)
            # A power of ten behind the second alone may be meant for both.
            unclear = uncertainty is not None and "e" in uncertainty.lower() and "e" not in (value or "").lower()
            unclear |= of_first and not (of_second or percent)
            if value is None or uncertainty is None or uncertainty.startswith(("-", "+")) or unclear:
                return None
            return value, uncertainty
        match = _CONCISE.fullmatch(text)
        value = self._plain(match[1] + match[3]) if match else None
        if match is None or value is None:
            return None
        if not match[2].isdigit():
            uncertainty = self._plain(match[2] + match[3])
            return None if uncertainty is None else (value, uncertainty)
        number = parse_number(value)
        return None if number is None else (value, str(Decimal(match[2]).scaleb(last_place(number))))

    def _plain(self, text: str) -> str | None:
        return plain_number(text, self.decimal, self.thousands)


def is_date(text: str) -> bool:
    """Say whether a text is a day, ``2003-05-17``."""
    try:
        return dt.date.fromisoformat(text).isoformat() == text
    except ValueError:  # the 30th of February
        return False


_CHOICES: dict[str, tuple[object, ...]] = {
    "decimal": (".", ",", "·"),
    "thousands": ("", ",", ".", "'", " "),
    "parentheses": ("", "negative", "standard-error"),
    "percent": ("", "percent", "fraction"),
    "interval": ("", "ends", "inside"),
    **dict.fromkeys(("bounds", "stars", "uncertainty", "count", "date"), (False, True)),
}
PLAIN_ALLOWED = f"a number; allowed: {ALLOWED}"
PLAIN = Notation()
_DECLARATIONS: tuple[dict[str, Any], ...] = (
    {"bounds": True},
    {"stars": True},
    {"percent": "percent"},
    {"parentheses": "negative"},
    {"uncertainty": True},
    {"interval": "ends"},
    {"thousands": ","},
    {"decimal": ","},
    {"decimal": ",", "thousands": ""},
    {"decimal": ".", "thousands": ""},
    {"thousands": " "},
    {"thousands": "'"},
    {"decimal": ",", "thousands": "."},
    {"decimal": ",", "thousands": " "},
    {"decimal": ".", "thousands": ","},
    {"count": False},
)


def hint(notation: Notation, text: str) -> str:
    """Say which notation would accept a text that a notation does not, if one or two more declarations would do."""
    changed = next(_accepting(notation, text), None)
    if changed is not None:
        return f"; notation={changed.declared} would accept it"
    if notation.states(text.replace("–", "-")) is not None:
        return "; the dash is no minus sign: write - or −"
    return ""


def _accepting(notation: Notation, text: str) -> Iterator[Notation]:
    """Yield notations that accept a text, the likeliest first."""
    if is_date(text):
        yield Notation(date=True)
    if _DASH.fullmatch(text):
        yield replace(notation, none=(*notation.none, text))
    if _WORD.fullmatch(text):
        yield replace(notation, words=(*notation.words, text))
    doubles = ({**first, **second} for first, second in combinations(_DECLARATIONS, 2))
    for more in () if notation.date else (*_DECLARATIONS, *doubles):
        given: dict[str, Any] = {**vars(notation), **more}
        if given["decimal"] != given["thousands"] and (changed := Notation(**given)).states(text) is not None:
            yield changed

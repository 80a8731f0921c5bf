"""Names of functions in formulas, set apart from what is beside them as TeX does; browsers do not see to it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from xml.etree import ElementTree as ET

#: Invisible operators: application of a function, times, separator, plus.
OPERATORS = re.compile("[\u200b\u2061-\u2064]")
_APPLICATION = "\N{FUNCTION APPLICATION}"
_FORMULA = re.compile(r"(?<=<math)([^>]*>)(.*?)(?=</math>)", re.DOTALL)
_ROWS = {"row", "mrow", "mstyle", "msqrt", "mtd"}  # whose parts stand side by side
_SCRIPTS = {"msub", "msup", "msubsup", "munder", "mover", "munderover"}
_BARS = {"|", "‖"}
_CLOSING = {")", "]", "}", "⟩"}
_SIGNS = {"−", "+", "±", "∓", "/"}  # which pandoc writes as identifiers, too


def functions_apart(page: str) -> str:
    r"""Set the names of functions in the MathML of a page apart from a factor before and an argument without brackets.

    Invisible operators of these formulas are written as references, since a page shows such characters raw.

    Examples
    --------
    >>> name = '<mrow><mi mathvariant="normal">ln</mi><mo>&#8289;</mo></mrow>'
    >>> functions_apart(f"<p><math><mrow>{name}<mn>10</mn></mrow></math></p>").count("<mspace")
    1
    """
    return _FORMULA.sub(_formula, page)


def references(text: str) -> str:
    """Return a text whose invisible operators are written as references."""
    return OPERATORS.sub(lambda found: f"&#{ord(found[0])};", text)


def markup(parts: Iterable[ET.Element]) -> str:
    """Return elements as a page writes them."""
    return "".join(ET.tostring(part, encoding="unicode", short_empty_elements=False) for part in parts)


def _formula(found: re.Match[str]) -> str:
    attributes, content = found.groups()
    if _APPLICATION not in content and f"&#{ord(_APPLICATION)};" not in content:
        return found[0]
    row = ET.fromstring(f"<row>{content}</row>")  # noqa: S314 -- pandoc's
    for element in [*row.iter()]:
        if element.tag in _ROWS:
            _set_apart(element)
    return f"{attributes}{references(markup(row))}"


def _set_apart(row: ET.Element) -> None:
    parts = list(row)
    for place in range(len(parts) - 1, 0, -1):
        before, after = parts[place - 1], parts[place]
        paired = sum(part.text in _BARS for part in parts[:place]) % 2 == 0
        if (_is_function(before) and _is_argument(after, paired)) or (
            _is_function(after) and _is_factor(before, paired)
        ):
            row.insert(place, ET.Element("mspace", width="0.167em"))


def _is_function(element: ET.Element) -> bool:
    if element.tag in _SCRIPTS:
        return _is_function(element[0])
    return element.tag == "mrow" and len(element) > 1 and element[-1].text == _APPLICATION


def _is_argument(element: ET.Element, paired: bool) -> bool:
    """Return whether an element begins an argument without brackets; after paired bars, a bar does."""
    first = element[0] if element.tag == "mrow" and len(element) else element
    if first.tag == "mo":
        return first.text in _BARS and (paired or first is not element)
    return first.tag not in {"mspace", "mtext"} and first.text not in _SIGNS


def _is_factor(element: ET.Element, paired: bool) -> bool:
    """Return whether an element ends a factor; a bar that completes a pair does."""
    if element.tag == "mo":
        return element.text in _CLOSING or (element.text in _BARS and paired)
    return element.tag not in {"mspace", "mtext"} and element.text not in _SIGNS

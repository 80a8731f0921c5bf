"""Formulas as pages need them: without the TeX they came from, reachable by keyboard, broken at the end of a line."""

from __future__ import annotations

import html
import re
from xml.etree import ElementTree as ET

from replicate.display.formula_text import formula_text
from replicate.display.function_names import OPERATORS, functions_apart, markup, references

_FORMULA = re.compile(
    r'<math display="(block|inline)"><semantics>(.*?)<annotation[^>]*>(.*?)</annotation></semantics></math>', re.DOTALL
)
_BESIDE = re.compile(
    '(?P<opens>[(\\[“‘]?)(?P<formula><math [^>]*?display="inline"[^>]*>.*?</math>)(?P<ends>[-,.;:!?)\\]”’%]*)',
    re.DOTALL,
)
_CALLED = re.compile(r"<(a|h[1-6]|th|summary|label)\b[^>]*>.*?</\1>", re.DOTALL)
_SHOWN = re.compile(
    r'<math(?P<attributes>(?: (?!alttext)[^ >]*| alttext="(?P<said>[^"]*)")*)>(?P<content>.*?)</math>', re.DOTALL
)
_BUILT = re.compile("<m(?:sup|subsup|frac|sqrt|root|over|space|table)\\b")
_LONG = 45  # characters of TeX; a longer displayed formula may be wider than a phone
_LONG_IN_LINE, _VERY_LONG_IN_LINE = 24, 34
_BREAKS = {"=", "≤", "≥", "<", ">", "≈", "≠", "→", "+", "−"}  # a line may break before these, as in a printed text


def formulas(text: str) -> str:
    r"""Return pandoc's HTML with its formulas made fit for a page.

    A third of the elements of a page would only carry TeX. A displayed formula that may be too wide for a phone
    scrolls, so the keyboard has to reach it; one in a line is cut before its outer relations and signs, since a browser
    does not break a formula.

    Examples
    --------
    >>> tex = '<annotation encoding="application/x-tex">a_{long} = b + c, where c is something</annotation>'
    >>> math = "<mi>a</mi><mo>=</mo><mi>b</mi><mo>+</mo><mi>c</mi>"
    >>> formulas(f'<math display="inline"><semantics><mrow>{math}</mrow>{tex}</semantics></math>').count("<math")
    3
    """
    return _FORMULA.sub(lambda found: references(_formula(found)), functions_apart(text))


def without_operators(text: str) -> str:
    r"""Return a text taken out of formulas with spaces in place of invisible operators.

    Examples
    --------
    >>> without_operators("ln\u206110")
    'ln 10'
    """
    return OPERATORS.sub(" ", text)


def in_place(page: str) -> str:
    """Return a page whose formulas fit what is around them.

    To a browser a formula is like a picture: a comma after it may begin the next line, so that it is tied to its
    punctuation; and what is called by its content, as a link or a heading is, is called without it, unless it has a
    name.

    Examples
    --------
    >>> in_place('(<math display="inline"><mi>k</mi></math>, that is')
    '<span class="tied">(<math display="inline"><mi>k</mi></math>,</span> that is'
    >>> in_place('<a href="#k">its <math display="inline"><mi>k</mi></math></a>')
    '<a href="#k">its <math aria-label="k" display="inline"><mi>k</mi></math></a>'
    >>> in_place('<h2><math alttext="k squared" display="inline"><msup><mi>k</mi><mn>2</mn></msup></math></h2>')[:49]
    '<h2><math aria-label="k squared" alttext="k squar'
    """
    page = _BESIDE.sub(lambda found: _tied(*found.groups()), page)
    return _CALLED.sub(lambda found: _SHOWN.sub(_named, found[0]), page)


def _named(match: re.Match[str]) -> str:
    attributes, said, content = match.groups()
    name = said or re.sub("<[^>]*>|&#[0-9]+;", "", content).replace('"', "&quot;")
    return f'<math aria-label="{name}"{attributes}>{content}</math>'


def _tied(opens: str, formula: str, ends: str) -> str:
    whole = f"{opens}{formula}{ends}"
    return f'<span class="tied">{whole}</span>' if opens or ends else whole


def _formula(match: re.Match[str]) -> str:
    display, content, tex = match.groups()
    if display == "inline":
        return "".join(_element(piece, 'display="inline"') for piece in breakable(content, html.unescape(tex)))
    reachable = ' tabindex="0"' if len(html.unescape(tex)) > _LONG else ""
    return _element(content, f'display="block"{reachable}')


def _element(content: str, attributes: str) -> str:
    """Return a formula; with its text where that is more than the letters one after the other."""
    said = ""
    if _BUILT.search(content):
        text = formula_text(ET.fromstring(f"<math>{content}</math>"))  # noqa: S314 -- pandoc's, and sanitised
        said = f' alttext="{html.escape(text)}"'
    return f"<math {attributes}{said}>{content}</math>"


def breakable(content: str, tex: str) -> list[str]:
    """Return the content of a formula in a line, a long one in pieces between which the line may end.

    It is cut before its relations and signs outside fractions and roots, and in at most one pair of brackets.
    """
    if len(tex) <= _LONG_IN_LINE:
        return [content]
    inside = 1 if len(tex) > _VERY_LONG_IN_LINE else 0
    row = ET.fromstring(content)  # noqa: S314 -- pandoc's, and sanitised
    if row.tag != "mrow":
        return [content]
    pieces: list[list[ET.Element]] = [[]]
    depth = 0
    for part in row:
        sign = part.text if part.tag == "mo" else ""
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(sign or "", 0)
        if sign in _BREAKS and depth <= inside and pieces[-1]:
            part.set("form", "infix")  # at the start of a piece, it would be taken for a sign before a number
            pieces.append([])
        pieces[-1].append(part)
    return [f"<mrow>{markup(piece)}</mrow>" for piece in pieces]

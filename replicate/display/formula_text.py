"""A formula of a page as characters in one line, for where no element can stand: a description, what is copied.

It is read from the MathML of the page. Labels of the data and of drawings are no part of a page that pandoc converts,
and say "K_P", as whoever plots them would type; here, an index is set beside its letter.
"""

from __future__ import annotations

from xml.etree import ElementTree as ET

from replicate.display.function_names import OPERATORS
from replicate.display.numbers import OVERLINE

_PRIMES = set("′″‴*")
_ENDS = {",", ".", ";"}
_BARS = {"¯", "‾", "_"}
_SMALL = {"2": "²", "3": "³"}


def formula_text(element: ET.Element) -> str:
    """Return what a MathML element shows; exponents, fractions and roots with brackets where they need some.

    Examples
    --------
    >>> formula_text(ET.fromstring("<msqrt><mn>2</mn><mi>T</mi><mi>/</mi><mi>θ</mi></msqrt>"))
    '√(2T/θ)'
    >>> power = "<msup><mfrac><mi>L</mi><mi>τ</mi></mfrac><mrow><mi>−</mi><mn>0.9</mn></mrow></msup>"
    >>> formula_text(ET.fromstring(power))
    '(L/τ)^(−0.9)'
    >>> formula_text(ET.fromstring("<mrow><mstyle><mfrac><mn>1</mn><mi>K</mi></mfrac></mstyle><mi>h</mi></mrow>"))
    '(1/K)h'
    """
    parts = [formula_text(child) for child in element]
    text = OPERATORS.sub("", element.text or "") + _joined(element, parts)
    match element.tag:
        case "mspace":
            text = " "
        case "mfrac":
            text = "/".join(map(_grouped, parts))
        case "msqrt":
            text = f"√{_grouped(text)}"
        case "mroot":
            text = f"{_grouped(parts[0])}^(1/{parts[1]})"
        case "msup":
            text = _raised(*parts)
        case "msubsup":
            text = _raised(f"{parts[0]}{parts[1]}", parts[2])
        case "mtr":
            text = ", ".join(parts)
        case "mtable":
            text = "; ".join(parts)
        case "mover" if parts[1] in _BARS:
            text = f"{parts[0]}{OVERLINE}"
    return text


def _joined(element: ET.Element, parts: list[str]) -> str:
    """Return parts side by side, a fraction in brackets where a factor follows."""
    found: list[str] = []
    factor = False  # whether one stands at the right
    for child, part in zip(map(_unwrapped, reversed(element)), reversed(parts), strict=True):
        found.append(f"({part})" if child.tag == "mfrac" and factor else part)
        if child.tag != "mspace":
            factor = child.get("form") == "prefix" if child.tag == "mo" else part not in _ENDS
    return "".join(reversed(found))


def _unwrapped(element: ET.Element) -> ET.Element:
    return _unwrapped(element[0]) if element.tag in {"mrow", "mstyle"} and len(element) == 1 else element


def _raised(base: str, exponent: str) -> str:
    if set(exponent) <= _PRIMES:
        return f"{base}{exponent}"
    base = _grouped(base) if {"/", "√"} & set(base) else base
    return f"{base}{_SMALL[exponent]}" if exponent in _SMALL else f"{base}^{_grouped(exponent)}"


def _grouped(text: str) -> str:
    """Return a part in brackets, unless it is a number, a symbol or in brackets already."""
    bracketed = text.startswith("(") and text.find(")") == len(text) - 1
    alone = len(text) == 1 or text.replace(OVERLINE, "").replace(".", "").isalnum()
    return text if alone or bracketed else f"({text})"

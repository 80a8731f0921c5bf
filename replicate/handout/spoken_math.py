"""Formulas in words, for readers who listen: a walk through the MathML that pandoc makes of LaTeX.

Fractions and roots longer than one symbol are said with their end, so that nothing is ambiguous to the ear.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from xml.etree import ElementTree as ET

_WORDS = {
    "+": "plus", "-": "minus", "−": "minus", "±": "plus or minus", "=": "equals", "≠": "is not equal to",
    "<": "is less than", ">": "is greater than", "≤": "is at most", "≥": "is at least",
    "≈": "is about", "≪": "is much less than", "≫": "is much greater than", "∼": "is like",
    "·": "times", "⋅": "times", "×": "times", "∗": "times", "/": "over", "∞": "infinity",
    "∫": "the integral", "∑": "the sum", "∏": "the product", "∂": "partial", "√": "root", "…": "and so on",
    "⋯": "and so on", "→": "tends to", "∈": "in", "∠": "the angle of", "°": "degrees", "′": "prime",
    "∣": "bar", "|": "bar", "‖": "double bar", "∥": "double bar", "(": "(", ")": ")", "[": "[", "]": "]",
    "{": "{", "}": "}", ",": ",", ";": ";", ".": ".", ":": ":", "!": "factorial", "%": "per cent",
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ϵ": "epsilon", "ζ": "zeta",
    "η": "eta", "θ": "theta", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi",
    "ρ": "rho", "σ": "sigma", "τ": "tau", "φ": "phi", "ϕ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega",
    "Γ": "capital gamma", "Δ": "capital delta", "Θ": "capital theta", "Λ": "capital lambda",
    "Σ": "capital sigma", "Φ": "capital phi", "Ψ": "capital psi", "Ω": "capital omega", "ℓ": "l",
    "⟨": "(", "⟩": ")", "⇒": "implies", "⇔": "if and only if", "↦": "maps to", "⌊": "floor", "⌋": "",
    "∀": "for all", "Ⅎ": "", "\u2061": "of", "\u2062": "", "\u2063": "", "\u200b": "", "&": "",
}  # fmt: skip
_ACCENTS = {
    "^": "hat",
    "ˆ": "hat",
    "¯": "bar",
    "‾": "bar",
    "―": "bar",
    "~": "tilde",
    "˜": "tilde",
    "˙": "dot",
}
_ACCENTS |= {"\u0307": "dot", "\u0308": "double dot", "\u0302": "hat", "\u0304": "bar", "\u0305": "bar"}
_ACCENTS |= {"\u0303": "tilde", "\u203e": "bar"}
_NAMES = {
    "max": "the maximum", "min": "the minimum", "ln": "the natural logarithm of", "exp": "e to the",
    "sin": "sine", "cos": "cosine", "tan": "tangent", "arg": "the argument of", "Re": "real part of",
    "Im": "imaginary part of",
}  # fmt: skip


_OF_TWICE = re.compile(r"\b(of|to the) of\b")  # said by a function's name, and by the sign of its application


def spoken(mathml: str | ET.Element) -> str:
    r"""Return a formula in words.

    Parameters
    ----------
    mathml
        A ``<math>`` element, as pandoc writes it.

    Examples
    --------
    >>> spoken("<math><msub><mi>K</mi><mi>i</mi></msub><mo>=</mo>"
    ...        "<mfrac><msub><mi>K</mi><mi>p</mi></msub><mi>T</mi></mfrac></math>")
    'K sub i equals the fraction K sub p over T, end of fraction'
    """
    root = ET.fromstring(mathml) if isinstance(mathml, str) else mathml  # noqa: S314  -- pandoc's own output
    words = _say(root)
    words = _OF_TWICE.sub(r"\1", " ".join(words.split()))
    return re.sub(r"\s+([,.;)\]])", r"\1", re.sub(r"([(\[])\s+", r"\1", words))


def _say(node: ET.Element) -> str:
    children = [child for child in node if _tag(child) != "annotation"]
    if not children:
        return "" if _tag(node) == "mspace" else _token(node.text or "")
    parts = [_say(child) for child in children]
    say = _STRUCTURES.get(_tag(node))
    return say(parts, children) if say else " ".join(parts)


def _tag(node: ET.Element) -> str:
    return node.tag.rpartition("}")[2]


def _fraction(parts: list[str], nodes: list[ET.Element]) -> str:
    if all(_is_token(node) for node in nodes):
        return f"{parts[0]} over {parts[1]}"
    return f"the fraction {parts[0]} over {parts[1]}, end of fraction"


def _sub(parts: list[str], _: list[ET.Element]) -> str:
    return _under(parts, _) if parts[0].endswith(" of") else f"{parts[0]} sub {parts[1]}"


def _under(parts: list[str], _: list[ET.Element]) -> str:
    return f"{parts[0].removesuffix(' of')} over {parts[1]} of"  # the maximum over all frequencies of ...


def _sub_and_super(parts: list[str], _: list[ET.Element]) -> str:
    if parts[0].startswith("the "):
        return f"{parts[0]} from {parts[1]} to {parts[2]} of"
    return _power(f"{parts[0]} sub {parts[1]}", parts[2])


def _over(parts: list[str], nodes: list[ET.Element]) -> str:
    accent = (nodes[1].text or "").strip()
    return f"{parts[0]} {_ACCENTS.get(accent, parts[1])}"


def _root(parts: list[str], nodes: list[ET.Element]) -> str:
    end = "" if len(nodes) == 1 and _is_token(nodes[0]) else ", end of root"
    return f"the square root of {' '.join(parts)}{end}"


_STRUCTURES: dict[str, Callable[[list[str], list[ET.Element]], str]] = {
    "mfrac": _fraction,
    "msup": lambda parts, _: _power(parts[0], parts[1]),
    "msub": _sub,
    "munder": _under,
    "msubsup": _sub_and_super,
    "munderover": _sub_and_super,
    "mover": _over,
    "msqrt": _root,
    "mroot": lambda parts, _: f"the root of order {parts[1]} of {parts[0]}, end of root",
    "mtr": lambda parts, _: ", ".join(part for part in parts if part.strip()),
    "mtable": lambda parts, _: "; ".join(parts),
}


def _is_token(node: ET.Element) -> bool:
    """Whether a node is one symbol, perhaps inside rows of its own."""
    return all(len(inner) <= 1 for inner in node.iter())


def _power(base: str, exponent: str) -> str:
    return {"2": f"{base} squared", "3": f"{base} cubed", "prime": f"{base} prime"}.get(
        exponent.strip(), f"{base} to the power {exponent},"
    )


def _token(text: str) -> str:
    text = text.strip()
    if text in _NAMES:
        return _NAMES[text]
    if re.fullmatch(r"[\w.\s-]*", text, re.ASCII):
        return text if text != "-" else "minus"
    return " ".join(_WORDS.get(character, character) for character in text)

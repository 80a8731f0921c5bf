r"""LaTeX math as text for the terminal: ``$M_s \le 1.4$`` becomes ``M_s ≤ 1.4``.

The texts of a paper (titles, notes, explanations) are Markdown with LaTeX between dollar signs. The report
turns it into MathML; a terminal has one line of characters, in which Greek letters, relations and simple
exponents can be shown, and fractions and roots with a slash and a root sign.
"""

from __future__ import annotations

import re
import unicodedata

_MATH = re.compile(r"\$\$(.+?)\$\$|\$(\S(?:[^$]*\S)?)\$", re.DOTALL)
_PIECE = re.compile(r"\\[A-Za-z]+|\\.|\s+|.", re.DOTALL)

_SYMBOLS = {
    "le": "≤", "leq": "≤", "ge": "≥", "geq": "≥", "ne": "≠", "neq": "≠", "approx": "≈", "pm": "±", "mp": "∓",
    "to": "→", "infty": "∞", "cdot": "·", "times": "×", "dots": "…", "ldots": "…", "cdots": "…", "int": "∫",
    "sum": "Σ", "in": "∈", "star": "*", "ast": "*", "dagger": "†", "circ": "°", "quad": " ", "qquad": "  ",
    "left": "", "right": "", "displaystyle": "", ",": " ", ";": " ", ":": " ", " ": " ", "!": "",
}  # fmt: skip
_ACCENTS = {"bar": "\u0304", "hat": "\u0302", "tilde": "\u0303", "dot": "\u0307"}
_FRACTIONS = {"frac", "dfrac", "tfrac"}
_ALPHABETS = {"text", "mathrm", "mathit", "mathbf", "mathcal", "operatorname"}
_RAISED = str.maketrans("0123456789-+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺")


def readable(text: str) -> str:
    r"""Return a text with the LaTeX between dollar signs as plain characters.

    Examples
    --------
    >>> readable(r"Settings for $KK_p = \sqrt{2T/\theta}$, within $\pm 2\,\%$")
    'Settings for KK_p = √(2T/θ), within ±2 %'
    >>> readable(r"$e^{-0.7s}/(s-1)$, $\frac{1}{p}\ln\frac{a + b}{KL}$, $M_s^*$, $K_{max}$ at $\omega^2$")
    'e^(-0.7s)/(s-1), 1/p ln (a + b)/(KL), M_s*, K_max at ω²'
    """
    return _MATH.sub(lambda match: _Reader(match[1] or match[2]).expression().strip(), text)


class _Reader:
    """Reads one formula from left to right."""

    def __init__(self, tex: str) -> None:
        self._pieces: list[str] = _PIECE.findall(tex)
        self._next = 0

    def expression(self) -> str:
        """Read up to the end, or to the brace that closes the group."""
        out = ""
        while (piece := self._take()) not in {"", "}"}:
            shown = self._shown(piece)
            if out[-1:].isalnum() and shown[:1].isalnum() and (_is_function(shown) or re.search(r"_\w+$", out)):
                out += " "  # x ln y, and K_p T rather than K_pT
            out += shown
        return re.sub(r" {2,}", " ", out)

    def _take(self) -> str:
        """Return the next piece; empty at the end."""
        self._next += 1
        return self._pieces[self._next - 1] if self._next <= len(self._pieces) else ""

    def _peek(self) -> str:
        return self._pieces[self._next] if self._next < len(self._pieces) else ""

    def _argument(self) -> str:
        """Read what follows a command: a group in braces, or one piece."""
        if self._peek().isspace():
            self._take()
        piece = self._take()
        return self.expression() if piece == "{" else self._shown(piece)

    def _shown(self, piece: str) -> str:
        match piece[:1]:
            case "{":
                return self.expression()
            case "_":
                return f"_{_one(self._argument())}"
            case "^":
                return _power(self._argument())
            case "\\":
                return self._command(piece[1:])
            case _:
                return " " if piece.isspace() else piece

    def _command(self, name: str) -> str:
        if name in _FRACTIONS:
            shown = f"{_one(self._argument())}/{_one(self._argument(), product=False)}"
        elif name == "sqrt":
            shown = f"√{_one(self._argument())}"
        elif name in _ACCENTS:
            shown = unicodedata.normalize("NFC", self._argument() + _ACCENTS[name])
        elif name in _ALPHABETS:
            shown = self._argument()
        elif name in _SYMBOLS:
            if name in {"pm", "mp"} and self._peek().isspace():
                self._take()  # a sign stands at its number
            shown = _SYMBOLS[name]
        else:
            shown = _greek(name) or name
            if _is_function(shown) and (self._peek()[:1].isalnum() or self._peek().startswith("\\")):
                shown += " "
        return shown


def _is_function(shown: str) -> bool:
    name = shown.rstrip()
    return len(name) > 1 and name.isalpha()


def _greek(name: str) -> str:
    case = "CAPITAL" if name[:1].isupper() else "SMALL"
    name = name.removeprefix("var").upper()
    try:
        return unicodedata.lookup(f"GREEK {case} LETTER {'LAMDA' if name == 'LAMBDA' else name}")
    except KeyError:
        return ""


def _one(text: str, *, product: bool = True) -> str:
    """Return a text in parentheses unless it is one symbol or number, or (if allowed) a product of such."""
    bare = len(text) <= 1 or text.replace(".", "").isdigit() or (product and text.replace(".", "").isalnum())
    return text if bare else f"({text})"


def _power(text: str) -> str:
    if re.fullmatch(r"[-+]?\d+", text):
        return text.translate(_RAISED)
    return text if text in {"*", "'", "†", "°", "+", "-"} else f"^{_one(text, product=False)}"

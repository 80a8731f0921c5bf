"""Cut a plant's text into tokens, each with its column."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NoReturn

from replicate.loops.errors import NotationError

FUNCTIONS = ("exp", "sqrt", "sinh", "cosh", "tanh", "sech", "csch", "coth")
NAMES = (*FUNCTIONS, "s", "e")  # longer ones first, so that a run of letters is split greedily

_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_LETTERS = re.compile(r"[^\W\d_]+")
_NAME = re.compile("|".join(NAMES))
_SPACE = re.compile(r"(?:\s|\\left|\\right|\\[,;!:])+")
_SYMBOLS = {
    "**": "^", "\\cdot": "*", "\\frac": "\\frac", "−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*",
    **{symbol: symbol for symbol in "+-*/^(){}[]"},
}  # fmt: skip
_SUPERSCRIPT = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")


@dataclass(frozen=True)
class Token:
    """A piece of the text: its kind (``number``, ``name``, a symbol, or ``end``), its text, and its column from 1."""

    kind: str
    text: str
    column: int


def refuse(what: str, text: str, column: int, reason: str) -> NoReturn:
    """Raise the error that names the column; ``what`` is plant or controller."""
    raise NotationError(what, text, column, reason) from None


def tokens(text: str, what: str) -> list[Token]:
    """Return the tokens of a text, the last one of kind ``end``.

    Raises
    ------
    NotationError
        At the first character that cannot belong to a transfer function; ``what`` names the text in the message.
    """
    found: list[Token] = []
    at = 0
    while at < len(text):
        if space := _SPACE.match(text, at):
            at = space.end()
            continue
        pieces, at = _next(text, at, what)
        found += pieces
    return [*found, Token("end", "", len(text) + 1)]


def _next(text: str, at: int, what: str) -> tuple[list[Token], int]:
    column = at + 1
    if number := _NUMBER.match(text, at):
        return [Token("number", number.group(), column)], number.end()
    for symbol, kind in _SYMBOLS.items():
        if text.startswith(symbol, at):
            return [Token(kind, symbol, column)], at + len(symbol)
    end = at
    while end < len(text) and text[end] in "⁰¹²³⁴⁵⁶⁷⁸⁹":
        end += 1
    if end > at:
        return [Token("^", "^", column), Token("number", text[at:end].translate(_SUPERSCRIPT), column)], end
    if letters := _LETTERS.match(text, at):
        return _names(letters.group(), text, column, what), letters.end()
    reason = "a decimal point is written '.', not ','" if text[at] == "," else f"'{text[at]}' is not understood"
    refuse(what, text, column, reason)


def _names(run: str, text: str, column: int, what: str) -> list[Token]:
    """Split a run of letters such as ``se`` into names."""
    found: list[Token] = []
    at = 0
    while at < len(run):
        name = _NAME.match(run, at)
        if name is None:
            reason = f"'{run}' is not known; allowed are s, numbers, e^{{...}} and {', '.join(FUNCTIONS)}"
            refuse(what, text, column, reason)
        found.append(Token("name", name.group(), column + at))
        at = name.end()
    return found

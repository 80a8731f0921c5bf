r"""From tokens to an expression tree.

.. code-block:: text

    sum     = [+|-] product {(+|-) product}
    product = factor {(* factor) | (/ factor) | power}        a power without sign: the product sign may be left out
    factor  = [-] power
    power   = primary [^ exponent]
    primary = number | s | e^{sum} | function(sum) | (sum) | \frac{sum}{sum}

What two readers would understand differently is refused: ``1/(s+1)(s+2)``, ``1/2s``, ``s2``, ``e^-2s``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

from replicate.loops.notation.tokens import Token, refuse, tokens

CLOSING = {"(": ")", "{": "}", "[": "]"}
DEEPEST = 40
LONGEST = 300  # operations: every later step calls itself once for each that is nested in another

_OPERATIONS = {"+", "-", "*", "/", "^", "name", "\\frac"}


@dataclass(frozen=True)
class Node:
    """A node of the tree: ``kind`` is number, s, +, -, *, /, ^, negative or a function's name; ``text`` a number's."""

    kind: str
    column: int
    parts: tuple[Node, ...] = ()
    text: str = ""


def parse(text: str, what: str = "plant") -> Node:
    """Return the tree of an expression in s.

    Raises
    ------
    NotationError
        One line with the column at which the text stops making sense, and what is allowed there.
    """
    if not isinstance(text, str):
        refuse(what, str(text), 1, f"a text is needed, not {type(text).__name__}")
    found = _Parser(text, what)
    count = sum(token.kind in _OPERATIONS for token in found.tokens)
    if count > LONGEST:
        found.fail(f"more than {LONGEST} operations and names")
    return found.whole()


class _Parser:
    def __init__(self, text: str, what: str) -> None:
        self.text = text
        self.what = what
        self.tokens = tokens(text, what)
        self.at = 0
        self.depth = 0

    @property
    def next(self) -> Token:
        return self.tokens[self.at]

    def take(self) -> Token:
        token = self.next
        self.at += token.kind != "end"
        return token

    def fail(self, reason: str, column: int | None = None) -> NoReturn:
        refuse(self.what, self.text, self.next.column if column is None else column, reason)

    def whole(self) -> Node:
        if self.next.kind == "end":
            self.fail("the text is empty")
        tree = self.sum()
        if self.next.kind != "end":
            self.fail(f"'{self.next.text}' is not expected here")
        return tree

    def sum(self) -> Node:
        self.depth += 1
        if self.depth > DEEPEST:
            self.fail(f"more than {DEEPEST} parentheses inside each other")
        sign = self.take() if self.next.kind in "+-" else None
        tree = self.product()
        if sign and sign.kind == "-":
            tree = Node("negative", sign.column, (tree,))
        while self.next.kind in "+-":
            operation = self.take()
            tree = Node(operation.kind, operation.column, (tree, self.product()))
        self.depth -= 1
        return tree

    def product(self) -> Node:
        tree = self.factor()
        divided = False
        while True:
            token = self.next
            if token.kind in {"*", "/"}:
                self.take()
                tree = Node(token.kind, token.column, (tree, self.factor()))
                divided = token.kind == "/"
            elif token.kind == "number":
                self.fail("a number stands before what it multiplies, and a power is written ^")
            elif token.kind in {"name", "\\frac", *CLOSING}:
                if divided and token.text not in {"e", "exp"}:
                    self.fail("is this above or below the division? Write a/(b c) or a/b*c")
                tree = Node("*", token.column, (tree, self.power()))
            else:
                return tree

    def factor(self) -> Node:
        if self.next.kind == "-":
            column = self.take().column
            return Node("negative", column, (self.power(),))
        return self.power()

    def power(self) -> Node:
        base = self.primary()
        if self.next.kind != "^":
            return base
        column = self.take().column
        tree = Node("^", column, (base, self.exponent()))
        if self.next.kind == "^":
            self.fail("a power of a power needs parentheses")
        return tree

    def exponent(self) -> Node:
        if self.next.kind in CLOSING:
            return self.group()
        sign = self.take() if self.next.kind == "-" else None
        if self.next.kind != "number":
            self.fail("an exponent is a number, or stands in braces")
        number = self.number()
        return Node("negative", sign.column, (number,)) if sign else number

    def number(self) -> Node:
        token = self.take()
        value = float(token.text)
        if value == float("inf") or (value == 0.0 and token.text.lower().partition("e")[0].strip("0.")):
            self.fail(f"{token.text} is not a floating-point number", token.column)
        return Node("number", token.column, text=token.text)

    def primary(self) -> Node:
        token = self.next
        if token.kind == "number":
            return self.number()
        if token.kind in CLOSING:
            return self.group()
        if token.kind == "\\frac":
            self.take()
            return Node("/", token.column, (self.group(), self.group()))
        if token.kind == "name":
            return self.name(self.take())
        reason = f"'{token.text}' is not expected here" if token.text else "the text ends too early"
        return self.fail(reason)

    def name(self, token: Token) -> Node:
        if token.text == "s":
            return Node("s", token.column)
        if token.text == "e":
            if self.next.kind != "^" or self.tokens[self.at + 1].kind not in CLOSING:
                self.fail("e needs an exponent in braces, as in e^{-2s}", token.column)
            self.take()
            return Node("exp", token.column, (self.group(),))
        if self.next.kind not in CLOSING:
            self.fail(f"{token.text} needs its argument in parentheses, as in {token.text}(s)")
        return Node(token.text, token.column, (self.group(),))

    def group(self) -> Node:
        opening = self.next
        if opening.kind not in CLOSING:
            self.fail("'{' is missing")
        self.take()
        inside = self.sum()
        if self.next.kind != CLOSING[opening.kind]:
            wrong = f", not '{self.next.text}'" if self.next.text else ""
            self.fail(f"'{CLOSING[opening.kind]}' is needed for column {opening.column}{wrong}")
        self.take()
        return inside

"""Plants in text."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from replicate.loops.errors import LoopError, NotationError
from replicate.loops.notation.functions import TextFunction
from replicate.loops.notation.grammar import Node, parse
from replicate.loops.notation.rational import NotRationalError, Term, constant, delay, value
from replicate.loops.notation.tokens import refuse
from replicate.loops.notation.writing import expression, transfer
from replicate.loops.plant import Plant


def parse_plant(text: str) -> Plant:
    r"""Return the plant that a text names, its coefficients exact to the last digit written.

    The product sign may be left out; braces, brackets and parentheses are the same; ``e^{...}`` and ``exp(...)`` are
    the dead time. Roots, fractional powers and hyperbolic functions make a plant given by a function.

    Parameters
    ----------
    text
        For example ``e^{-1.5s}/(s+1)^3``, ``2 e^{-s}/(s(s+1))``, ``1/(s^2+0.4s+1) e^{-0.5s}``, ``e^{-sqrt(s)}`` or
        ``\frac{e^{-s}}{s+1}``.

    Raises
    ------
    NotationError
        If the text is not a transfer function, is improper, or predicts; the line names the column.

    Examples
    --------
    >>> parse_plant("2 e^{-0.5s}/(s(s+1))")
    Plant([2.0], [1.0, 1.0, 0.0], dead_time=0.5)
    >>> parse_plant("1/(s+1)(s+2)")
    Traceback (most recent call last):
    ...
    replicate.loops.errors.NotationError: plant '1/(s+1)(s+2)', column 8: is this above or below the division? ...
    """
    tree = parse(text)
    try:
        terms = value(tree)
    except NotRationalError as error:
        if error.fatal:
            refuse("plant", text, error.column, error.reason)
        return _function_plant(tree, text)
    try:
        if len(terms) > 1:
            _dead_time(terms[0].dead_time, text)
            return Plant.from_terms([(*_coefficients(term), float(term.dead_time)) for term in terms])
        return Plant(*_coefficients(terms[0]), _dead_time(terms[0].dead_time, text))
    except (LoopError, OverflowError) as error:
        if isinstance(error, NotationError):
            raise
        refuse("plant", text, 1, str(error))


def _coefficients(term: Term) -> tuple[list[float], list[float]]:
    return [float(c) for c in term.num], [float(c) for c in term.den]


def _dead_time(dead_time: Fraction, text: str) -> float:
    if dead_time < 0:
        refuse("plant", text, 1, f"e^{{{float(-dead_time):g}s}} predicts; the dead time must be >= 0")
    return float(dead_time)


def _function_plant(tree: Node, text: str) -> Plant:
    _refuse_unusable(tree, text)
    dead_time, rest = _split_delay(tree)
    if rest is None:
        refuse("plant", text, 1, "the plant is a dead time only")
    return Plant.from_function(TextFunction(expression(rest), rest), _dead_time(dead_time, text))


def _refuse_unusable(tree: Node, text: str) -> None:
    """Look at the parts that `value` has not reached behind the first that is not rational."""
    for part in tree.parts:
        _refuse_unusable(part, text)
    if tree.kind == "^" and constant(tree.parts[1]) is None:
        refuse("plant", text, tree.column, "an exponent is a number; only e^{...} may hold s there")
    if tree.kind == "/" and constant(tree.parts[1]) == 0:
        refuse("plant", text, tree.column, "division by zero")


def _split_delay(tree: Node) -> tuple[Fraction, Node | None]:
    """Return the dead times among the factors of the numerator, added, and what is left of the tree."""
    own = delay(tree)
    if own is not None:
        return own, None
    if tree.kind == "negative":
        dead_time, rest = _split_delay(tree.parts[0])
        return dead_time, Node("negative", tree.column, (rest or _ONE,))
    if tree.kind == "/":
        dead_time, above = _split_delay(tree.parts[0])
        return dead_time, Node("/", tree.column, (above or _ONE, tree.parts[1]))
    if tree.kind == "*":
        (a, left), (b, right) = (_split_delay(part) for part in tree.parts)
        both = Node("*", tree.column, (left, right)) if left and right else left or right
        return a + b, both
    return Fraction(0), tree


_ONE = Node("number", 1, text="1")


def plant_notation(plant: Plant) -> str:
    """Return the plant as a text from which `parse_plant` gives the same plant, bit by bit.

    Raises
    ------
    LoopError
        If the plant is given by a Python function, which has no text.

    Examples
    --------
    >>> plant_notation(Plant([8.0], [1.0, 4.0, 0.0], dead_time=1.0))
    '8 e^{-s}/(s(s+4))'
    """
    if plant.parts:
        texts = [transfer(part.num, part.den, part.dead_time) for part in plant.parts]
        return "+".join(texts).replace("+-", "-")
    if not isinstance(plant.function, TextFunction):
        msg = "a plant given by a Python function has no notation; write it as a text, for example e^{-sqrt(s)}"
        raise LoopError(msg)
    text = plant.function.text
    if not plant.dead_time:
        return text
    factor = f"({text})" if plant.function.tree.kind in {"+", "-", "negative"} else text
    return f"{factor} {transfer(np.array([1.0]), np.array([1.0]), plant.dead_time)}"

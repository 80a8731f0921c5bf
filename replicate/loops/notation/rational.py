"""The value of an expression as an exact sum of rational functions times dead times, where it is one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest

from replicate.loops.notation.grammar import Node

Polynomial = tuple[Fraction, ...]  # descending powers of s, leading zeros kept

MOST_DEGREE = 60


class NotRationalError(ValueError):
    """An expression is not a sum of rational functions times dead times; ``args`` hold column and reason."""

    def __init__(self, column: int, reason: str, *, fatal: bool = True) -> None:
        super().__init__(reason)
        self.column = column
        self.reason = reason
        self.fatal = fatal  # no transfer function at all, rather than one of another kind


@dataclass(frozen=True)
class Term:
    """``num(s)/den(s) e^{-s dead_time}``."""

    num: Polynomial
    den: Polynomial
    dead_time: Fraction


Sum = tuple[Term, ...]  # with different dead times, ascending


def value(node: Node) -> Sum:
    """Return the exact value of a tree.

    Raises
    ------
    NotRationalError
        If the expression is of another kind: roots, hyperbolic functions, a sum of dead times in a denominator.
    """
    if node.kind == "number":
        return (Term((Fraction(node.text),), (Fraction(1),), Fraction(0)),)
    if node.kind == "s":
        return (Term((Fraction(1), Fraction(0)), (Fraction(1),), Fraction(0)),)
    if node.kind in _RULES:
        return _RULES[node.kind](node)
    raise NotRationalError(node.column, f"{node.kind} makes the plant a function", fatal=False)


def constant(node: Node) -> Fraction | None:
    """Return the value of a tree that does not depend on s, else None."""
    try:
        terms = value(node)
    except NotRationalError:
        return None
    if len(terms) != 1 or terms[0].dead_time or len(terms[0].num) > 1 or len(terms[0].den) > 1:
        return None
    return terms[0].num[0] / terms[0].den[0]


def delay(node: Node) -> Fraction | None:
    """Return L where the tree is ``e^{-sL}``, else None."""
    if node.kind != "exp":
        return None
    try:
        (term,) = value(node)
    except (NotRationalError, ValueError):
        return None
    return term.dead_time if term.num == (Fraction(1),) else None


def _add(node: Node) -> Sum:
    left, right = (value(part) for part in node.parts)
    return _collect((*left, *(_negated(right) if node.kind == "-" else right)), node)


def _collect(terms: Sequence[Term], node: Node) -> Sum:
    """Add the terms with equal dead times; like denominators are kept, others multiplied."""
    found: dict[Fraction, Term] = {}
    for term in terms:
        other = found.get(term.dead_time)
        if other is None:
            found[term.dead_time] = term
        elif other.den == term.den:
            found[term.dead_time] = Term(_plus(other.num, term.num), term.den, term.dead_time)
        else:
            num = _plus(_times(other.num, term.den, node), _times(term.num, other.den, node))
            found[term.dead_time] = Term(num, _times(other.den, term.den, node), term.dead_time)
    kept = tuple(found[key] for key in sorted(found) if any(found[key].num))
    return kept or tuple(found.values())[:1]


def _multiply(node: Node) -> Sum:
    return _product(value(node.parts[0]), value(node.parts[1]), node)


def _product(left: Sum, right: Sum, node: Node) -> Sum:
    if len(left) * len(right) > MOST_DEGREE:
        raise NotRationalError(node.column, f"the plant has more than {MOST_DEGREE} terms")
    products = [
        Term(_times(a.num, b.num, node), _times(a.den, b.den, node), a.dead_time + b.dead_time)
        for a in left
        for b in right
    ]
    return _collect(products, node) if len(products) > 1 else tuple(products)


def _divide(node: Node) -> Sum:
    return _product(value(node.parts[0]), _inverse(value(node.parts[1]), node), node)


def _inverse(terms: Sum, node: Node) -> Sum:
    if len(terms) != 1:
        raise NotRationalError(node.column, "division by a sum of dead times makes the plant a function", fatal=False)
    (term,) = terms
    if not any(term.num):
        raise NotRationalError(node.column, "division by zero")
    return (Term(term.den, term.num, -term.dead_time),)


def _power(node: Node) -> Sum:
    exponent = constant(node.parts[1])
    if exponent is None:
        raise NotRationalError(node.column, "an exponent is a number; only e^{...} may hold s there")
    base = constant(node.parts[0])
    if exponent.denominator != 1:
        if base is None:
            raise NotRationalError(node.column, "a fractional power makes the plant a function", fatal=False)
        if base < 0:
            raise NotRationalError(node.column, "a fractional power of a negative number is not real")
        return _number(_finite(float(base) ** float(exponent), node))
    if abs(exponent) > MOST_DEGREE:
        raise NotRationalError(node.column, f"an exponent may be at most {MOST_DEGREE}")
    terms = value(node.parts[0])
    if exponent < 0:
        terms = _inverse(terms, node)
    result = _number(1)
    for _ in range(abs(int(exponent))):
        result = _product(result, terms, node)
    return result


def _exponential(node: Node) -> Sum:
    terms = value(node.parts[0])
    if len(terms) != 1 or terms[0].dead_time or len(terms[0].den) > 1 or any(terms[0].num[:-2]):
        raise NotRationalError(node.column, "an exponential of that kind makes the plant a function", fatal=False)
    slope, offset = (Fraction(0), Fraction(0), *terms[0].num)[-2:]
    scale = terms[0].den[0]
    factor = Fraction(1) if not offset else _number(_finite(_exp(offset / scale), node))[0].num[0]
    return (Term((factor,), (Fraction(1),), -slope / scale),)


def _exp(exponent: Fraction) -> float:
    try:
        return math.exp(exponent)
    except OverflowError:
        return math.inf


def _number(number: float) -> Sum:
    return (Term((Fraction(number),), (Fraction(1),), Fraction(0)),)


def _finite(number: float, node: Node) -> float:
    if not math.isfinite(number):
        raise NotRationalError(node.column, "the number is too large")
    return number


def _negative(node: Node) -> Sum:
    return _negated(value(node.parts[0]))


def _negated(terms: Sum) -> Sum:
    return tuple(Term(tuple(-c for c in term.num), term.den, term.dead_time) for term in terms)


def _plus(a: Polynomial, b: Polynomial) -> Polynomial:
    pairs = zip_longest(reversed(a), reversed(b), fillvalue=Fraction(0))
    return tuple(reversed([x + y for x, y in pairs]))


def _times(a: Polynomial, b: Polynomial, node: Node) -> Polynomial:
    if len(a) + len(b) - 2 > MOST_DEGREE:
        raise NotRationalError(node.column, f"the degree is more than {MOST_DEGREE}")
    result = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return tuple(result)


_RULES: dict[str, Callable[[Node], Sum]] = {
    "+": _add,
    "-": _add,
    "*": _multiply,
    "/": _divide,
    "^": _power,
    "exp": _exponential,
    "negative": _negative,
}

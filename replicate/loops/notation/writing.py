"""The inverse of the parser: the shortest text that gives exactly the same plant or expression."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from replicate.loops.notation.grammar import Node, parse
from replicate.loops.notation.rational import value

Array = NDArray[np.float64]

_FACTOR = re.compile(r"s(\^\d+)?|\([^()]*\)(\^\d+)?|[\d.]+(e[+-]\d+)?")  # needs no parentheses below a fraction bar
_STRENGTH = {"+": 1, "-": 1, "negative": 1, "*": 2, "/": 2, "^": 3}


def number(x: float) -> str:
    """Return the shortest text of a float that reads back exactly."""
    return repr(float(x)).removesuffix(".0")


def polynomial(coefficients: Sequence[float], *, keep_zeros: bool = False) -> str:
    """Return a polynomial in s, descending powers; ``keep_zeros`` writes leading zeros, too."""
    last = len(coefficients) - 1
    text = ""
    for index, c in enumerate(coefficients):
        power = last - index
        if c == 0.0 and not (keep_zeros and index == 0) and last:
            continue
        unit = "" if power == 0 else "s" if power == 1 else f"s^{power}"
        size = "" if abs(c) == 1.0 and unit else number(abs(c))
        sign = ("-" if c < 0.0 else "") if not text else ("-" if c < 0.0 else "+")
        text += f"{sign}{size}{unit}"
    return text


def transfer(num: Array, den: Array, dead_time: float) -> str:
    """Return the shortest ``num e^{-Ls}/(den)`` from which the parser gives these coefficients, ``den`` being monic.

    Tried are a constant term of one, and a denominator written as a power of s times a power of a linear factor.
    """
    monic = (tuple(num), tuple(den))
    texts = [
        _assemble(above, factors, dead_time) for above, below in _scalings(num, den) for factors in _denominators(below)
    ]
    return min((text for text in texts if _reads_as(text, monic, dead_time)), key=len)


def _scalings(num: Array, den: Array) -> list[tuple[Array, Array]]:
    """Return the coefficients over the last one of the denominator, with few digits, and as they are."""
    lowest = abs(den[np.nonzero(den)[0][-1]])
    scaled = [(num / lowest, den / lowest)] if lowest != 1.0 else []
    few = [tuple(np.array([float(f"{c:.12g}") for c in part]) for part in pair) for pair in scaled]
    return [(a, b) for a, b in few] + [(num, den)]


def _denominators(den: Array) -> list[tuple[str, ...]]:
    """Return the denominator as factors: a power of s and a power of a linear factor, and expanded."""
    order = den.size - 1
    lower = np.trim_zeros(den, "b")
    integrators = den.size - lower.size
    front = () if integrators == 0 else ("s",) if integrators == 1 else (f"s^{integrators}",)
    rest = order - integrators
    expanded = (*front, f"({polynomial(lower.tolist())})") if rest and integrators else (polynomial(den.tolist()),)
    if rest < 2 or lower[0] * lower[-1] <= 0.0:
        return [expanded]
    time = float(f"{(lower[0] / lower[-1]) ** (1.0 / rest):.12g}")
    corner = float(f"{1.0 / time:.12g}")
    powers = [(lower[-1], (time, 1.0)), (lower[0], (1.0, corner))]
    scaled = [(() if scale == 1.0 else (number(scale),), polynomial(factor)) for scale, factor in powers]
    return [(*scale, *front, f"({factor})^{rest}") for scale, factor in scaled] + [expanded]


def _assemble(num: Array, below: tuple[str, ...], dead_time: float) -> str:
    above = polynomial(num.tolist())
    if np.count_nonzero(num) > 1:
        above = f"({above})"
    if dead_time:
        delay = f"e^{{-{'' if dead_time == 1.0 else number(dead_time)}s}}"
        above = {"1": delay, "-1": f"-{delay}"}.get(above, f"{above} {delay}")
    divisor = "".join(below)
    if divisor == "1":
        return above
    return f"{above}/{divisor}" if _FACTOR.fullmatch(divisor) else f"{above}/({divisor})"


def _reads_as(text: str, monic: tuple[tuple[float, ...], tuple[float, ...]], dead_time: float) -> bool:
    terms = value(parse(text))
    if len(terms) != 1:
        return False
    num, den = (np.array([float(c) for c in part]) for part in (terms[0].num, terms[0].den))
    num, den = np.trim_zeros(num, "f"), np.trim_zeros(den, "f")
    return (tuple(num / den[0]), tuple(den / den[0])) == monic and float(terms[0].dead_time) == dead_time


def expression(node: Node) -> str:
    """Return the canonical text of any tree; parsing it gives the same text again."""
    match node.kind, node.parts:
        case "number", _:
            text = node.text
        case "s", _:
            text = "s"
        case "exp", (argument,):
            text = f"e^{{{expression(argument)}}}"
        case "negative", (argument,):
            text = f"-{_wrapped(argument, 2)}"
        case "^", (base, exponent):
            text = f"{_wrapped(base, 4)}^{{{expression(exponent)}}}"
        case ("+" | "-") as sign, (left, right):
            text = f"{_wrapped(left, 1, first=True)}{sign}{_wrapped(right, 2)}"
        case ("*" | "/") as sign, (left, right):
            text = f"{_wrapped(left, 2)}{sign}{_wrapped(right, 3)}"
        case name, (argument,):
            text = f"{name}({expression(argument)})"
        case _:  # pragma: no cover - the parser makes no other node
            raise AssertionError
    return text


def _wrapped(node: Node, least: int, *, first: bool = False) -> str:
    """Return a tree's text, in parentheses unless it binds at least so strongly."""
    text = expression(node)
    strength = _STRENGTH.get(node.kind, 4)
    bare = strength >= least and (first or node.kind != "negative")
    return text if bare else f"({text})"

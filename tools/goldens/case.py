"""The loops of `loops.toml`, as polynomials in mpmath."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import mpmath as mp
import sympy
from loops.references import ReferenceLoop

DIGITS = 50
GAINS = ("k", "ki", "kd", "b", "c", "derivative_filter")
Poly = list[mp.mpf]


@dataclass(frozen=True)
class Case:
    """A loop; ``record`` is its table in the file."""

    record: dict[str, Any]

    @property
    def id(self) -> str:
        """Its name."""
        return str(self.record["id"])

    @cached_property
    def numbers(self) -> dict[str, mp.mpf]:
        """The controller's parameters, closed forms to all digits."""
        given = {name: self.record.get(name, 1.0 if name == "b" else 0.0) for name in GAINS}
        return {name: _exact(value) for name, value in given.items()}

    @property
    def dead_time(self) -> float:
        """The dead time, zero if there is none."""
        return float(self.record.get("dead_time", 0.0))

    @property
    def plant(self) -> tuple[list[float], list[float]]:
        """Numerator and denominator, descending powers of s."""
        return self.record.get("num", [1.0]), self.record["den"]

    @cached_property
    def reference(self) -> ReferenceLoop:
        """The loop whose parameters are the doubles nearest to the closed forms."""
        num, den = self.plant
        return ReferenceLoop(tuple(num), tuple(den), self.dead_time, **{n: float(v) for n, v in self.numbers.items()})

    @cached_property
    def polynomials(self) -> dict[str, Poly]:
        """Return A, B of f = A + B e^{-sL}, and the numerators F (set-point to y) and G (load to y) over f."""
        x = self.numbers
        num, den = ([mp.mpf(c) for c in part] for part in self.plant)
        lag = [x["derivative_filter"], mp.mpf(1)] if x["derivative_filter"] else [mp.mpf(1)]
        integral = [mp.mpf(1), mp.mpf(0)] if x["ki"] else [mp.mpf(1)]

        def controller(k: mp.mpf, kd: mp.mpf) -> Poly:
            parts = multiply([k, x["ki"]] if x["ki"] else [k], lag)
            return add(parts, multiply([kd, mp.mpf(0)], integral)) if x["kd"] else parts

        below = multiply(integral, lag)
        return {
            "A": multiply(den, below),
            "B": multiply(num, controller(x["k"], x["kd"])),
            "F": multiply(num, controller(x["b"] * x["k"], x["c"] * x["kd"])),
            "G": multiply(num, below),
        }


def load() -> list[Case]:
    """Return all loops, in the order of the file."""
    text = Path(__file__).with_name("loops.toml").read_text(encoding="utf-8")
    return [Case(record) for record in tomllib.loads(text)["loop"]]


def _exact(value: float | str) -> mp.mpf:
    return mp.mpf(str(sympy.N(sympy.sympify(value), DIGITS + 10))) if isinstance(value, str) else mp.mpf(value)


def evaluate(poly: Poly, s: Any) -> Any:
    """Evaluate by Horner's rule, mpmath numbers and numpy arrays alike."""
    value = 0 * s
    for c in poly:
        value = value * s + c
    return value


def bracketed_root(function: Callable[[mp.mpf], mp.mpf], low: float, high: float) -> mp.mpf:
    """Return the root between two points of opposite sign to 18 digits (Illinois variant of the false position)."""
    a, b = mp.mpf(low), mp.mpf(high)
    fa, fb = function(a), function(b)
    if fa * fb > 0:
        msg = f"no sign change between {low} and {high}"
        raise ArithmeticError(msg)
    for _ in range(60):
        if fa == 0 or abs(b - a) <= mp.mpf(10) ** -18 * abs(b):
            return a if fa == 0 else b
        c = (a * fb - b * fa) / (fb - fa)
        fc = function(c)
        if abs(c - b) <= mp.mpf(10) ** -18 * abs(c):
            return c
        if fc * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = c, fc
        if fb == 0:
            return b
    msg = f"no convergence between {low} and {high}"
    raise ArithmeticError(msg)


def derivative(poly: Poly) -> Poly:
    """Return the derivative."""
    degree = len(poly) - 1
    return [c * (degree - i) for i, c in enumerate(poly[:-1])] or [mp.mpf(0)]


def multiply(a: Poly, b: Poly) -> Poly:
    """Return the product of two polynomials."""
    result = [mp.mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def add(a: Poly, b: Poly) -> Poly:
    """Return the sum of two polynomials."""
    size = max(len(a), len(b))
    left, right = ([mp.mpf(0)] * (size - len(p)) + list(p) for p in (a, b))
    return [x + y for x, y in zip(left, right, strict=True)]

"""A plant given by a text that is not rational, as a function of s that neither overflows nor forgets its text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops.notation.grammar import Node
from replicate.loops.notation.rational import constant

ComplexArray = NDArray[np.complex128]
Scaled = tuple[ComplexArray, ComplexArray]  # (m, x) stands for m e^x: cosh of a large argument stays finite


@dataclass(frozen=True)
class TextFunction:
    """A transfer function given by a text; two are equal when their texts are.

    Attributes
    ----------
    text
        In the canonical form that `replicate.loops.notation.writing.expression` gives.
    """

    text: str
    tree: Node = field(compare=False, repr=False)

    def __call__(self, s: ArrayLike) -> ComplexArray:
        """Evaluate at complex ``s`` of any shape; an underflow is zero."""
        mantissa, exponent = _scaled(self.tree, np.asarray(s, dtype=complex))
        with np.errstate(under="ignore"):
            return np.asarray(mantissa * np.exp(exponent))


def _scaled(node: Node, s: ComplexArray) -> Scaled:
    if node.kind == "number":
        return np.full_like(s, float(node.text)), np.zeros_like(s)
    if node.kind == "s":
        return s, np.zeros_like(s)
    mantissa, exponent = _scaled(node.parts[0], s)
    if node.kind in _FUNCTIONS:
        return _FUNCTIONS[node.kind](np.asarray(mantissa * np.exp(exponent)))
    if node.kind == "negative":
        return -mantissa, exponent
    if node.kind == "^":
        power = constant(node.parts[1])
        assert power is not None  # noqa: S101  -- `plants` has refused everything else
        return np.asarray(mantissa ** float(power)), exponent * float(power)
    return _combined(node.kind, (mantissa, exponent), _scaled(node.parts[1], s))


def _combined(sign: str, a: Scaled, b: Scaled) -> Scaled:
    if sign == "*":
        return a[0] * b[0], a[1] + b[1]
    if sign == "/":
        return a[0] / b[0], a[1] - b[1]
    largest = np.where(a[1].real >= b[1].real, a[1], b[1])
    with np.errstate(under="ignore"):
        left, right = a[0] * np.exp(a[1] - largest), b[0] * np.exp(b[1] - largest)
    return left + right if sign == "+" else left - right, largest


def _hyperbolic(top: float | None, bottom: float | None) -> Callable[[ComplexArray], Scaled]:
    """Return (e^x + top e^-x) / (e^x + bottom e^-x); None stands for a part that is 2 instead."""

    def evaluate(x: ComplexArray) -> Scaled:
        sign = np.where(x.real >= 0.0, 1.0, -1.0)
        large = sign * x  # e^-2|x| never overflows
        with np.errstate(under="ignore"):
            small = np.exp(-2.0 * large)
        above, up = (2.0, 0.0 * x) if top is None else (_side(top, sign, small), large)
        below, down = (2.0, 0.0 * x) if bottom is None else (_side(bottom, sign, small), large)
        return np.asarray(above / below), up - down

    def _side(weight: float, sign: NDArray[np.float64], small: ComplexArray) -> ComplexArray:
        return np.asarray((1.0 + weight * small) * (sign if weight < 0.0 else 1.0))

    return evaluate


_FUNCTIONS: dict[str, Callable[[ComplexArray], Scaled]] = {
    "exp": lambda x: (np.ones_like(x), x),
    "sqrt": lambda x: (np.sqrt(x), np.zeros_like(x)),
    "cosh": _hyperbolic(1.0, None),
    "sinh": _hyperbolic(-1.0, None),
    "tanh": _hyperbolic(-1.0, 1.0),
    "coth": _hyperbolic(1.0, -1.0),
    "sech": _hyperbolic(None, 1.0),
    "csch": _hyperbolic(None, -1.0),
}

"""What a set-point, a load or another disturbance does over time: steps, pulses, ramps, sines, piecewise polynomials.

Every one but the sine is a sum of steps, ramps, parabolas ... that start at certain times: a jump of the n-th
derivative by J at t0 adds J (t - t0)^n / n!. A linear loop answers each of them with the n-th integral of its step
response.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from replicate.loops import checks
from replicate.loops.errors import LoopError

__all__ = ["Input", "PiecewisePolynomial", "Pulse", "Ramp", "Sine", "Step"]

Event = tuple[float, int, float]  # time, order n of the derivative that jumps, height of the jump


def _as_floats(item: object, kind: str, **fields: Callable[[str, object], float]) -> None:
    """Replace fields of an input by what the check of each returns, a float."""
    for field, check in fields.items():
        name = f"the {'time' if field == 'at' else field} of a {kind}"
        object.__setattr__(item, field, check(name, getattr(item, field)))


@dataclass(frozen=True)
class Step:
    """A step of the given height at time ``at`` >= 0."""

    height: float = 1.0
    at: float = 0.0

    def __post_init__(self) -> None:
        _as_floats(self, "step", height=checks.finite, at=checks.non_negative)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        return [(self.at, 0, self.height)]


@dataclass(frozen=True)
class Pulse:
    """A rectangular pulse from ``at`` to ``at + duration``."""

    height: float
    duration: float
    at: float = 0.0

    def __post_init__(self) -> None:
        _as_floats(self, "pulse", height=checks.finite, duration=checks.positive, at=checks.non_negative)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        return [(self.at, 0, self.height), (self.at + self.duration, 0, -self.height)]


@dataclass(frozen=True)
class Ramp:
    """A ramp of the given slope from ``at`` on; constant after ``duration`` if that is finite."""

    slope: float = 1.0
    at: float = 0.0
    duration: float = math.inf

    def __post_init__(self) -> None:
        _as_floats(self, "ramp", slope=checks.finite, at=checks.non_negative)
        if not np.isscalar(self.duration) or self.duration != math.inf:
            _as_floats(self, "ramp", duration=checks.positive)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        start: list[Event] = [(self.at, 1, self.slope)]
        return start if math.isinf(self.duration) else [*start, (self.at + self.duration, 1, -self.slope)]


@dataclass(frozen=True)
class PiecewisePolynomial:
    """A function that is a polynomial from each start on until the next one.

    Attributes
    ----------
    pieces
        Pairs (start, coefficients), starts ascending and >= 0; coefficients of the powers of t - start, constant first.
        Before the first start the function is zero; the last piece has no end.

    Examples
    --------
    A ramp up within one unit of time, and constant afterwards:

    >>> PiecewisePolynomial(((0.0, (0.0, 1.0)), (1.0, (1.0,)))).events()
    [(0.0, 1, 1.0), (1.0, 1, -1.0)]
    """

    pieces: Sequence[tuple[float, Sequence[float]]]

    def __post_init__(self) -> None:
        pieces = []
        for piece in checks.several("the pieces", self.pieces, "a list of (start, coefficients)"):
            start, coefficients = checks.exactly(2, "each piece", piece, "(start, coefficients)")
            listed = checks.several("the coefficients of a piece", coefficients, "a list of numbers, constant first")
            at = checks.non_negative("the start of a piece", start)
            pieces.append((at, tuple(checks.finite("a coefficient of a piece", c) for c in listed)))
        starts = [start for start, _ in pieces]
        if not starts or any(b <= a for a, b in pairwise(starts)):
            msg = f"the pieces must have ascending starts, at least one, not {starts}"
            raise LoopError(msg)
        object.__setattr__(self, "pieces", tuple(pieces))

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives, those of height zero left out."""
        found: list[Event] = []
        before: list[float] = []  # derivatives of the piece before, at the start of this one
        start = 0.0
        for index, (at, coefficients) in enumerate(self.pieces):
            after = [math.factorial(n) * c for n, c in enumerate(coefficients)]
            before = _shifted(before, at - start) if index else []
            size = max(len(before), len(after))
            left, right = (part + [0.0] * (size - len(part)) for part in (before, after))
            found += [(at, n, right[n] - left[n]) for n in range(size) if right[n] != left[n]]
            before, start = after, at
        return found


def _shifted(derivatives: list[float], by: float) -> list[float]:
    """Return the derivatives of a polynomial at a later time."""
    size = len(derivatives)
    return [math.fsum(derivatives[n + k] * by**k / math.factorial(k) for k in range(size - n)) for n in range(size)]


@dataclass(frozen=True)
class Sine:
    """``amplitude sin(frequency (t - at) + phase)`` from ``at`` on; frequency in rad per unit of time."""

    amplitude: float
    frequency: float
    phase: float = 0.0
    at: float = 0.0

    def __post_init__(self) -> None:
        _as_floats(self, "sine", amplitude=checks.finite, frequency=checks.positive)
        _as_floats(self, "sine", phase=checks.finite, at=checks.non_negative)


Input = Step | Pulse | Ramp | PiecewisePolynomial | Sine

"""What a set-point, a load or another disturbance does over time: steps, pulses, ramps, sines, piecewise polynomials.

Every one but the sine is a sum of steps, ramps, parabolas ... that start at certain times: a jump of the n-th
derivative by J at t0 adds J (t - t0)^n / n!. A linear loop answers each of them with the n-th integral of its step
response.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from replicate.loops.errors import LoopError

__all__ = ["Input", "PiecewisePolynomial", "Pulse", "Ramp", "Sine", "Step"]

Event = tuple[float, int, float]  # time, order n of the derivative that jumps, height of the jump


def _checked(name: str, value: object, *, at_least: float = -math.inf) -> float:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, str) or not (at_least <= number < math.inf):
        allowed = "a finite number" if math.isinf(at_least) else f"a finite number >= {at_least:g}"
        msg = f"{name} must be {allowed}, not {value!r}"
        raise LoopError(msg)
    return number


@dataclass(frozen=True)
class Step:
    """A step of the given height at time ``at`` >= 0."""

    height: float = 1.0
    at: float = 0.0

    def __post_init__(self) -> None:
        _checked("the height of a step", self.height)
        _checked("the time of a step", self.at, at_least=0.0)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        return [(float(self.at), 0, float(self.height))]


@dataclass(frozen=True)
class Pulse:
    """A rectangular pulse from ``at`` to ``at + duration``."""

    height: float
    duration: float
    at: float = 0.0

    def __post_init__(self) -> None:
        _checked("the height of a pulse", self.height)
        _checked("the time of a pulse", self.at, at_least=0.0)
        if _checked("the duration of a pulse", self.duration) <= 0.0:
            msg = f"the duration of a pulse must be > 0, not {self.duration!r}"
            raise LoopError(msg)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        return [(float(self.at), 0, float(self.height)), (float(self.at + self.duration), 0, -float(self.height))]


@dataclass(frozen=True)
class Ramp:
    """A ramp of the given slope from ``at`` on; constant after ``duration`` if that is finite."""

    slope: float = 1.0
    at: float = 0.0
    duration: float = math.inf

    def __post_init__(self) -> None:
        _checked("the slope of a ramp", self.slope)
        _checked("the time of a ramp", self.at, at_least=0.0)
        if self.duration != math.inf and _checked("the duration of a ramp", self.duration) <= 0.0:
            msg = f"the duration of a ramp must be > 0, not {self.duration!r}"
            raise LoopError(msg)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives."""
        start: list[Event] = [(float(self.at), 1, float(self.slope))]
        return start if math.isinf(self.duration) else [*start, (self.at + self.duration, 1, -float(self.slope))]


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
        starts = [_checked("the start of a piece", start, at_least=0.0) for start, _ in self.pieces]
        if not starts or any(b <= a for a, b in pairwise(starts)):
            msg = f"the pieces must have ascending starts, at least one, not {starts}"
            raise LoopError(msg)
        for _, coefficients in self.pieces:
            for c in coefficients:
                _checked("a coefficient", c)

    def events(self) -> list[Event]:
        """Return the jumps of the derivatives, those of height zero left out."""
        found: list[Event] = []
        before: list[float] = []  # derivatives of the piece before, at the start of this one
        start = 0.0
        for index, (at, coefficients) in enumerate(self.pieces):
            after = [math.factorial(n) * float(c) for n, c in enumerate(coefficients)]
            before = _shifted(before, at - start) if index else []
            size = max(len(before), len(after))
            left, right = (part + [0.0] * (size - len(part)) for part in (before, after))
            found += [(float(at), n, right[n] - left[n]) for n in range(size) if right[n] != left[n]]
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
        _checked("the amplitude of a sine", self.amplitude)
        _checked("the phase of a sine", self.phase)
        _checked("the time of a sine", self.at, at_least=0.0)
        if _checked("the frequency of a sine", self.frequency) <= 0.0:
            msg = f"the frequency of a sine must be > 0, not {self.frequency!r}"
            raise LoopError(msg)


Input = Step | Pulse | Ramp | PiecewisePolynomial | Sine

"""Functions of s and their derivatives, bounded on intervals of the imaginary axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from replicate.loops.bounds import intervals
from replicate.loops.bounds.intervals import ComplexInterval, Interval, exactly


@dataclass(slots=True)
class AxisJet:
    """What a function and its derivative with respect to s are for s = iw, w in an interval."""

    value: ComplexInterval
    slope: ComplexInterval

    @classmethod
    def polynomial(cls, descending: Sequence[Interval], w: Interval) -> AxisJet:
        """Return a polynomial.

        Examples
        --------
        >>> found = AxisJet.polynomial([exactly(9.0), exactly(6.0), exactly(1.0)], Interval(1.9, 2.1))
        >>> found.value.real.holds(-35.0), found.value.imag.holds(12.0)
        (True, True)
        >>> found.slope.real.holds(6.0), found.slope.imag.holds(36.0)
        (True, True)
        """
        return cls(intervals.on_the_axis(descending, w), intervals.on_the_axis(intervals.derivative(descending), w))

    def delayed(self, length: float, w: Interval) -> AxisJet:
        """Return the product with exp(-s length)."""
        time, angle = exactly(length), w * exactly(length)
        turn = ComplexInterval(intervals.cosine(angle), -intervals.sine(angle))
        late = ComplexInterval(self.value.real * time, self.value.imag * time)
        return AxisJet(self.value * turn, (self.slope - late) * turn)

    def wronskian(self, other: AxisJet) -> ComplexInterval:
        """Return the derivative of the quotient, times the square of the divisor."""
        return self.slope * other.value - self.value * other.slope

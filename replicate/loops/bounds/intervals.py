"""Interval arithmetic: numbers known to lie between two ends, and what follows from them with certainty.

Every operation returns an interval that holds all results for numbers of its operands; the ends are moved outward by
one unit in the last place, which is more than floating point loses in an addition, a product or a quotient.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, inf, isnan, nextafter, sin

_LIBRARY_ERROR = 1e-15  # more than that of a sine or cosine of the mathematical library


@dataclass(slots=True, unsafe_hash=True)  # a frozen one takes three times as long to make, and a proof makes millions
class Interval:
    """All numbers from `low` to `high`; never changed once made.

    Examples
    --------
    >>> product = Interval(1.0, 2.0) * Interval(-3.0, 0.5)
    >>> product.low <= -6.0, product.high >= 1.0, product.holds(0.3), product.holds(1.1)
    (True, True, True, False)
    """

    low: float
    high: float

    @property
    def middle(self) -> float:
        """The number in the middle."""
        return (self.low + self.high) / 2.0

    @property
    def reach(self) -> float:
        """How far its numbers are from the middle at most."""
        return nextafter(max(self.high - self.middle, self.middle - self.low), inf)

    @property
    def around(self) -> Interval:
        """What its numbers differ from the middle by."""
        return Interval(-self.reach, self.reach)

    def holds(self, number: float) -> bool:
        """Say whether a number lies in it."""
        return self.low <= number <= self.high

    def meets(self, low: float, high: float) -> bool:
        """Say whether it has a number in common with the numbers from `low` to `high`."""
        return self.low <= high and low <= self.high

    def __add__(self, other: Interval) -> Interval:
        """Return the sum."""
        return _outward(self.low + other.low, self.high + other.high)

    def __sub__(self, other: Interval) -> Interval:
        """Return the difference."""
        return _outward(self.low - other.high, self.high - other.low)

    def __mul__(self, other: Interval) -> Interval:
        """Return the product."""
        a, b, c, d = self.low, self.high, other.low, other.high
        # half of a proof's time goes here: the signs say which two of the four products of ends are the ends
        if a >= 0.0:
            low, high = (a if c >= 0.0 else b) * c, (b if d >= 0.0 else a) * d
        elif b <= 0.0:
            low, high = (a if d >= 0.0 else b) * d, (b if c >= 0.0 else a) * c
        elif c >= 0.0:
            low, high = a * d, b * d
        elif d <= 0.0:
            low, high = b * c, a * c
        else:
            low, high = min(a * d, b * c), max(a * c, b * d)
        if isnan(low) or isnan(high):  # zero times a number without limits
            return Interval(-inf, inf)
        return Interval(nextafter(low, -inf), nextafter(high, inf))

    def __truediv__(self, other: Interval) -> Interval:
        """Return the quotient; without limits where the divisor may be zero."""
        if other.holds(0.0):
            return Interval(-inf, inf)
        ends = [a / b for a in (self.low, self.high) for b in (other.low, other.high)]
        if any(map(isnan, ends)):
            return Interval(-inf, inf)
        return _outward(min(ends), max(ends))

    def __neg__(self) -> Interval:
        """Return the negative."""
        return Interval(-self.high, -self.low)

    def square(self) -> Interval:
        """Return the square, which is never negative."""
        low, high = sorted((abs(self.low), abs(self.high)))
        found = _outward(0.0 if self.holds(0.0) else low * low, high * high)
        return Interval(max(found.low, 0.0), found.high)


@dataclass(slots=True, unsafe_hash=True)
class ComplexInterval:
    """All complex numbers with real and imaginary part in two intervals."""

    real: Interval
    imag: Interval

    def __add__(self, other: ComplexInterval) -> ComplexInterval:
        """Return the sum."""
        return ComplexInterval(self.real + other.real, self.imag + other.imag)

    def __sub__(self, other: ComplexInterval) -> ComplexInterval:
        """Return the difference."""
        return ComplexInterval(self.real - other.real, self.imag - other.imag)

    def __mul__(self, other: ComplexInterval) -> ComplexInterval:
        """Return the product."""
        return ComplexInterval(
            self.real * other.real - self.imag * other.imag, self.real * other.imag + self.imag * other.real
        )

    def cross(self, other: ComplexInterval) -> Interval:
        """Return the imaginary part of the product with the conjugate of another."""
        return self.imag * other.real - self.real * other.imag


def exactly(number: float) -> Interval:
    """Return the interval of one number."""
    return Interval(number, number)


def exponential(number: Interval) -> Interval:
    """Return an interval that holds e to the power of all numbers."""
    return Interval(exp(number.low), exp(number.high)) * Interval(1.0 - _LIBRARY_ERROR, 1.0 + _LIBRARY_ERROR)


def cosine(angle: Interval) -> Interval:
    """Return an interval that holds the cosine of all angles; its slope is at most one."""
    return _around(cos(angle.middle), angle.reach)


def sine(angle: Interval) -> Interval:
    """Return an interval that holds the sine of all angles; its slope is at most one."""
    return _around(sin(angle.middle), angle.reach)


def _around(value: float, reach: float) -> Interval:
    away = reach + _LIBRARY_ERROR
    return Interval(max(value - away, -1.0), min(value + away, 1.0))


def polynomial(ascending: Sequence[Interval], x: Interval) -> Interval:
    """Return a polynomial at real numbers of an interval."""
    value = exactly(0.0)
    for coefficient in reversed(ascending):
        value = value * x + coefficient
    return value


def on_the_axis(descending: Sequence[Interval], w: Interval) -> ComplexInterval:
    """Return a polynomial at i w: its even part, and its odd one over i w, are polynomials of -w^2."""
    ascending, x = descending[::-1], -w.square()
    return ComplexInterval(polynomial(ascending[::2], x), polynomial(ascending[1::2], x) * w)


def derivative(coefficients: Sequence[Interval]) -> list[Interval]:
    """Return the coefficients of a polynomial's derivative."""
    degree = len(coefficients) - 1
    return [exactly(float(degree - place)) * c for place, c in enumerate(coefficients[:-1])]


def product(first: Sequence[Interval], second: Sequence[Interval]) -> list[Interval]:
    """Return the coefficients of the product of two polynomials."""
    found = [exactly(0.0)] * (len(first) + len(second) - 1)
    for i, a in enumerate(first):
        for j, b in enumerate(second):
            found[i + j] = found[i + j] + a * b
    return found


def _outward(low: float, high: float) -> Interval:
    return Interval(nextafter(low, -inf), nextafter(high, inf))

r"""Where the complementary sensitivity of loops with gains in a box peaks, and what follows from that peak.

With the integral time :math:`T_i`, :math:`T_i T_d`, :math:`1/k_i` and s = iw, let

.. math::

    \frac{1}{k_i P S} \, s = 1 + s \rho, \qquad
    \rho = (T_i + T_i T_d \, s) \, e^{-sL} + \frac{e^{-sL} - 1}{s} + \frac{1}{k_i} \frac{d(s)}{n(s)}

for the plant :math:`P = (n/d) e^{-sL}`. Then :math:`|k_i P S / s|^2 = 1/(1 + w^2 Q)` and
:math:`|T|^2 = (w^2 T_i^2 + (1 - w^2 T_i T_d)^2) / (1 + w^2 Q)` with the *excess*
:math:`Q = |\rho|^2 - 2 \operatorname{Im} \rho / w`, which has a limit for w -> 0. What a set-point weight or filter
must do for :math:`|k_i P S / s|` at the peak of :math:`|T|` depends on Q and w alone, and :math:`\rho` is linear in
what the box leaves open. So interval arithmetic over the box and short intervals of frequencies bounds Q well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from replicate.loops.bounds import intervals
from replicate.loops.bounds.gain_boxes import NOTHING, GainBox, no_peak_between
from replicate.loops.bounds.intervals import Interval, exactly, polynomial
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
Excludes = Callable[[Interval, Interval], bool]
"""From an interval of frequencies and one of the excess there: whether what is looked for is certainly not there."""

_ONE = exactly(1.0)
_RATIO = 1.25  # of the ends of the first intervals of frequencies
_SPAN = 1e3  # of the frequencies, up to that beyond which the loop gain is small
_MOST_INTERVALS = 160  # that are looked at
_BESIDE = 8  # frequencies of a grid beside a peak, of which one is taken for the largest
_NARROWEST = 2e-3  # relative width of an interval that is still divided


@dataclass(frozen=True)
class ResonanceBox:
    """All PID controllers with gain, integral and derivative time in intervals, around a plant.

    Attributes
    ----------
    plant
        Rational times a dead time; its numerator has no zero at s = 0.
    k, integral, derivative
        Gain and times; positive numbers, the derivative time may be zero.

    Raises
    ------
    ValueError
        If the plant is of another kind.
    """

    plant: Plant
    k: Interval
    integral: Interval
    derivative: Interval = NOTHING

    def __post_init__(self) -> None:
        """Check the plant."""
        if not self.plant.is_rational or not self.plant.num[-1]:
            msg = "the plant is not rational, or has a zero at s = 0; allowed: another one, with or without dead time"
            raise ValueError(msg)

    @cached_property
    def gains(self) -> GainBox:
        """The controllers by their gains."""
        return GainBox.of_times(self.k, self.integral, self.derivative)

    def excess(self, w: Interval) -> Interval:
        """Return an interval that holds Q for all controllers and frequencies."""
        real, slope = self._rho(w)
        return real.square() + _turned(w.square(), slope)

    def size(self, w: Interval) -> Interval:
        """Return an interval that holds the square of ``|T|`` for all controllers and frequencies."""
        return self._size(w, self.excess(w))

    def _size(self, w: Interval, excess: Interval) -> Interval:
        x = w.square()
        top = x * self._square + (_ONE - x * self._both).square()
        bottom = _ONE + x * excess
        return top / bottom if bottom.low > 0.0 else Interval(0.0, math.inf)

    def no_resonance_where(self, excludes: Excludes) -> bool:
        """Say whether certainly no controller has the peak of ``|T|`` where something looked for may be.

        Parameters
        ----------
        excludes
            Where it certainly is not.
        """
        # what stays open does so where the middle controller peaks: looked at first, that is soon known
        waiting = [Interval(float(a), float(b)) for a, b in pairwise(self._edges)]
        waiting.sort(key=lambda w: -max(w.low - self._peak, self._peak - w.high))
        for _ in range(_MOST_INTERVALS):
            if not waiting:
                return True
            w = waiting.pop()
            excess = self.excess(w)
            if not (excludes(w, excess) or self._size(w, excess).high < self._least or self._no_peak(w)):
                if w.high - w.low < _NARROWEST * w.high:
                    return False  # what is left open is the width of the box, not that of the interval
                waiting += [Interval(w.low, w.middle), Interval(w.middle, w.high)]
        return False

    def none_largest_where(self, excludes: Excludes, frequencies: Iterable[float]) -> bool:
        """Say the same of the frequency of a grid at which ``|T|`` is largest."""
        nearest = sorted(map(float, frequencies), key=lambda w: abs(math.log(w / self._peak)))
        # those beside the peak of the middle controller are the largest, and the first to stay open
        largest = max((self.size(exactly(w)).low for w in nearest[:_BESIDE]), default=0.0)
        for w in map(exactly, nearest):
            if w.low >= self._top and largest > 1.0:
                continue
            excess = self.excess(w)
            if not (self._size(w, excess).high < largest or excludes(w, excess)):
                return False
        return True

    def _no_peak(self, w: Interval) -> bool:
        return w.low > 0.0 and no_peak_between(self.plant, self.gains, w.low, w.high, complementary=True, parts=1)

    def _rho(self, w: Interval) -> tuple[Interval, Interval]:
        """Return the real part of rho, and its imaginary part over w."""
        delay = self.plant.dead_time
        x, turn = w.square(), intervals.cosine(w * exactly(delay)) if delay else _ONE
        sine, half = _sine_over(w, delay), _sine_over(w, delay / 2.0)
        even, odd, size = (polynomial(part, -x) for part in self._quotient)
        real = self.integral * turn + (self._both * x - _ONE) * sine + self._inverse * (even / size)
        slope = self._both * turn - self.integral * sine + exactly(2.0) * half.square() + self._inverse * (odd / size)
        return real, slope

    @cached_property
    def _square(self) -> Interval:
        return self.integral.square()

    @cached_property
    def _both(self) -> Interval:
        return self.integral * self.derivative

    @cached_property
    def _inverse(self) -> Interval:
        """The inverse of the integral gain."""
        return self.integral / self.k

    @cached_property
    def _quotient(self) -> tuple[list[Interval], list[Interval], list[Interval]]:
        """Even and odd part of d(s) n(-s), and n(s) n(-s), as polynomials in -w^2, ascending."""
        num, den = ([exactly(float(c)) for c in part[::-1]] for part in (self.plant.num, self.plant.den))
        mirrored = [-c if place % 2 else c for place, c in enumerate(num)]
        top, bottom = intervals.product(den, mirrored), intervals.product(num, mirrored)
        return top[::2], top[1::2], bottom[::2]

    @cached_property
    def _edges(self) -> Array:
        """Ends of the first intervals of frequencies: up to where no peak can be."""
        count = 1 + math.ceil(math.log(_SPAN) / math.log(_RATIO))
        return np.append(0.0, np.geomspace(self._top / _SPAN, self._top, count))

    @cached_property
    def _peak(self) -> float:
        """A frequency near that of the middle controller's peak."""
        s = 1j * self._edges[1:]
        loop = self.gains.middle.feedback(s) * self.plant(s)
        return float(s[np.argmax(np.abs(loop / (1.0 + loop)))].imag)

    @cached_property
    def _least(self) -> float:
        """A number below the square of the peak for all controllers: its size where the middle one's is near."""
        return self.size(exactly(self._peak)).low

    @cached_property
    def _top(self) -> float:
        """A frequency beyond which ``|L| < 1/2`` for all controllers, so that ``|T| < 1``, its value at rest."""
        gains = [gain.high for gain in (self.gains.kd, self.gains.k, self.gains.ki)]
        num = np.polymul(np.abs(self.plant.num), gains)
        den = np.append(np.abs(self.plant.den), 0.0)
        w = 1.0
        # both sides over the highest power: what is left of the left one only falls, the right one only rises
        while 2.0 * np.polyval(num, w) >= 2.0 * den[0] * w ** (den.size - 1) - np.polyval(den, w):
            w *= 2.0
        return w


def _turned(x: Interval, m: Interval) -> Interval:
    """Return an interval that holds x m^2 - 2 m for x >= 0: it grows with x, and is smallest at m = 1/x."""

    def values(x: float) -> list[Interval]:
        return [exactly(x) * exactly(end).square() - exactly(2.0 * end) for end in (m.low, m.high)]

    low = min(value.low for value in values(x.low))
    if x.low and m.meets((vertex := _ONE / exactly(x.low)).low, vertex.high):
        low = -vertex.high
    return Interval(low, max(value.high for value in values(x.high)))


def _sine_over(w: Interval, delay: float) -> Interval:
    """Return an interval that holds sin(w delay)/w, whose slope is less than half the square of the delay."""
    if not delay:
        return NOTHING
    middle = math.sin(w.middle * delay) / w.middle if w.middle else delay
    reach = 0.5 * delay**2 * w.reach + 1e-15 * delay
    return Interval(middle - reach, min(middle + reach, delay))

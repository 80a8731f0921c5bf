r"""The end of a response as a few modes :math:`\mathrm{Re}\, c_i e^{s_i (t - t_0)}`, and its metrics in closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

MOST = 3  # modes
STEPS = 20  # most steps of Newton's method
CONVERGED = 1e-9  # last step, of the time, after which the next would be rounding


@dataclass
class LastModes:
    """For each loop the modes that are left from some time on.

    Either the first is real and larger than all others together, and so is its slope: the signal keeps its sign and
    approaches zero steadily. Or it is the only one, which may be an oscillation.

    Attributes
    ----------
    found
        Whether the rest is known.
    pole, coefficient : array, shape (MOST, n)
        s and c, the slowest first; a real pole has a real coefficient. Where there are fewer, c is zero.
    start : array, shape (n,)
        The time t_0.
    error : array, shape (n,)
        The largest deviation from their sum that was seen before.
    beyond : array, shape (n,)
        How fast other modes decay at least.
    """

    found: Flags
    pole: ComplexArray
    coefficient: ComplexArray
    start: Array
    error: Array
    beyond: Array

    @classmethod
    def none(cls, count: int) -> LastModes:
        """Return the record of loops of which nothing is known."""
        return cls(
            np.zeros(count, dtype=bool), np.full((MOST, count), -1.0 + 0.0j), np.zeros((MOST, count), dtype=complex),
            np.zeros(count), np.zeros(count), np.ones(count),
        )  # fmt: skip

    def put(self, places: Places, modes: LastModes, start: float) -> None:
        """Enter those that were found."""
        at = places[modes.found]
        self.found[at], self.start[at] = True, start
        self.pole[:, at], self.coefficient[:, at] = modes.pole[:, modes.found], modes.coefficient[:, modes.found]
        self.error[at], self.beyond[at] = modes.error[modes.found], modes.beyond[modes.found]

    @property
    def oscillates(self) -> Flags:
        """Which are an oscillation, which then is all there is."""
        return np.asarray(self.pole[0].imag > 0.0)

    @property
    def size(self) -> Array:
        """What the signals do not exceed."""
        return np.asarray(np.abs(self.coefficient).sum(axis=0))

    def integral(self) -> Array:
        """Return the integrals of the modes from their start on."""
        return np.asarray(np.real(-self.coefficient / self.pole).sum(axis=0))

    def absolute_integral(self) -> Array:
        """Return the integrals of the absolute values."""
        first, _, half = self._half_waves()
        pole, c = self.pole[0], self.coefficient[0]
        decay = np.exp(pole * half)
        before, after = np.abs(np.real((first - c) / pole)), np.abs(np.real(first * (decay - 1.0) / pole))
        return np.where(self.oscillates, before + after / (1.0 - np.abs(decay)), np.abs(self.integral()))

    def square_integral(self) -> Array:
        """Return the integrals of the squares."""
        return self._of_squares(lambda rate: -1.0 / rate)

    def square_moment(self) -> Array:
        """Return the integrals of the squares, weighted with the time."""
        return self._of_squares(lambda rate: 1.0 / rate**2 - self.start / rate)

    def absolute_moment(self) -> Array:
        """Return the integrals of the absolute values, weighted with the time."""
        start, c, pole = self.start, self.coefficient, self.pole
        steady = np.abs(np.real(c * (1.0 / pole**2 - start / pole)).sum(axis=0))
        (first, wait, half), c, pole = self._half_waves(), c[0], pole[0]
        decay = np.exp(pole * half)
        # up to the first zero, then half-waves, each a fixed fraction of the one before
        before = np.abs(np.real(first * ((start + wait) / pole - 1.0 / pole**2) - c * (start / pole - 1.0 / pole**2)))
        area = np.abs(np.real(first * (decay - 1.0) / pole))
        own = np.abs(np.real(first * (decay * (half / pole - 1.0 / pole**2) + 1.0 / pole**2)))
        left = 1.0 - np.abs(decay)
        after = ((start + wait) * area + own) / left + half * area * np.abs(decay) / left**2
        return np.asarray(np.where(self.oscillates, before + after, steady))

    def absolute_change(self) -> Array:
        """Return the integrals of the absolute values of the derivatives."""
        return replace(self, coefficient=self.coefficient * self.pole).absolute_integral()

    def times(self, factor: NDArray[Any]) -> LastModes:
        """Return the modes of signals that are these, multiplied by a transfer function's values at the poles."""
        return replace(self, coefficient=np.where(self.coefficient != 0.0, self.coefficient * factor, 0.0))

    def first_at(self, level: Array) -> Array:
        """Return when those that approach zero steadily from below reach a negative level; ``nan`` for the others."""
        return self._steadily_at(level, (level < 0.0) & (self._now < level))

    def last_outside(self, width: Array, *, one_sided: bool = False) -> Array:
        """Return when the signals are outside (above) a band for the last time; ``nan`` if they are inside."""
        outside = self._now > width if one_sided else np.abs(self._now) > width
        steadily = self._steadily_at(np.copysign(width, self._now), outside)
        return np.where(self.oscillates, self._oscillation_leaves(width, one_sided=one_sided), steadily)

    def summit(self) -> tuple[Array, Array]:
        """Return the value and the time of the first maximum of oscillations, which is their highest."""
        wait = self._wait_for_extremum(2.0)
        height = np.real(self.coefficient[0] * np.exp(self.pole[0] * wait))
        return np.where(self.oscillates & self.found, height, -np.inf), self.start + wait

    @property
    def _now(self) -> Array:
        """The signals where they start."""
        return np.asarray(self.coefficient.real.sum(axis=0))

    def _steadily_at(self, level: Array, chosen: Flags) -> Array:
        """Return when chosen signals without oscillation reach levels between them and zero, others ``nan``."""
        at = np.nonzero(chosen & self.found & ~self.oscillates)[0]
        c, pole, level = self.coefficient[:, at], self.pole[:, at], level[at]
        time = np.full(self.found.size, np.nan)
        later = np.log(c[0].real / level) / -pole[0].real  # the first mode alone is near already
        for _ in range(STEPS):
            modes = c * np.exp(pole * np.maximum(later, 0.0))
            step = (modes.real.sum(axis=0) - level) / (modes * pole).real.sum(axis=0)
            later = np.maximum(later, 0.0) - step
            if not np.any(np.abs(step) > CONVERGED * (1.0 + later)):
                break
        time[at] = self.start[at] + later
        return time

    def _oscillation_leaves(self, width: Array, *, one_sided: bool) -> Array:
        """Return when oscillations leave a band (its upper side) for the last time; ``nan`` if never."""
        turns = 2.0 if one_sided else 1.0
        pole, c, wait = self.pole[0], self.coefficient[0], self._wait_for_extremum(turns)
        apart = turns * np.pi / self._frequency
        height = np.abs(np.real(c * np.exp(pole * wait)))
        with np.errstate(all="ignore"):
            # extrema fall by the same factor from one to the next: the last one outside
            last = np.floor(np.log(height / width) / (-pole.real * apart))
            base = np.where(height > width, wait + np.maximum(last, 0.0) * apart, 0.0)
            value = c * np.exp(pole * base)
            value = np.where((value.real < 0.0) & (not one_sided), -value, value)
            size, phase = np.abs(value) / width, np.angle(value)
            outside = value.real > width
            # ln |value| is concave, so that Newton's method falls to the root from where it were without decay
            turned = np.where(outside, np.arccos(np.minimum(1.0 / size, 1.0)) - phase, 0.0)
            rate = -pole.real / self._frequency
            for _ in range(STEPS):
                excess = np.log(size * np.cos(turned + phase)) - rate * turned
                step = np.where(outside, excess / (np.tan(turned + phase) + rate), 0.0)
                turned = turned + step
                if not np.any(np.abs(step) > CONVERGED):
                    break
            return np.where(outside & self.found, self.start + base + turned / self._frequency, np.nan)

    def _wait_for_extremum(self, turns: float) -> Array:
        """Return how far off an oscillation's next extremum is, or with two half turns its next maximum."""
        slope = np.angle(self.coefficient[0] * self.pole[0])
        return np.asarray(np.mod(0.5 * np.pi - slope, turns * np.pi) / self._frequency)

    @property
    def _frequency(self) -> Array:
        return np.where(self.oscillates, self.pole[0].imag, 1.0)

    def _half_waves(self) -> tuple[ComplexArray, Array, Array]:
        """Return the value of an oscillation at its next zero, how far off that is, and how far apart zeros are."""
        pole, c, frequency = self.pole[0], self.coefficient[0], self._frequency
        # zero is where the phase arg c + w t is an odd multiple of a right angle
        wait = np.mod(0.5 * np.pi - np.angle(c), np.pi) / frequency
        return c * np.exp(pole * wait), wait, np.pi / frequency

    def _of_squares(self, integral: Any) -> Array:
        """Return the sum over all pairs of modes of the integrals of their products, given that of an exponential."""
        total = np.zeros(self.found.size)
        for one, rate in zip(self.coefficient, self.pole, strict=True):
            for two, other in zip(self.coefficient, self.pole, strict=True):
                turning, steady = one * two * integral(rate + other), one * two.conj() * integral(rate + other.conj())
                total += 0.5 * np.real(turning + steady)
        return total

r"""The loop transfer function L = C G in the form that stability and frequency analysis need.

.. math:: L(s) = \frac{N(s)}{D(s)}\, g(s)\, e^{-sL}, \qquad f(s) = D(s) (1 + L(s))

N, D are polynomials and g = 1 for rational plants; for a plant given by a function, g is that function and N/D the
controller. The zeros of the *characteristic function* f are the closed loop's poles, cancelled ones included.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops.controller import PID
from replicate.loops.errors import ImproperLoopError, LoopError
from replicate.loops.frequency_domain.limit_curve import VANISHING, LimitCurve
from replicate.loops.frequency_domain.limit_torus import limit_of
from replicate.loops.numerics import polynomials
from replicate.loops.numerics.polynomials import (
    horner,
    horner_with_slope,
    product,
    roots_of,
    roots_of_difference,
    trimmed,
)
from replicate.loops.plant import Plant
from replicate.loops.plants.sum_plant import SumPlant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

EPS = float(np.finfo(float).eps)
ILL_POSED = 1e-12  # distance of an algebraic loop's gain from -1 that is rounding
ON_AXIS = 1e-6  # imaginary part, relative to the real one, of a simple root that is real
JUST_BEYOND = 1e-9  # relative distance from a corner
MOST_STEPS, STEP = 400, 1.5  # on the way to where |L| is low
LARGEST = 1e70  # of a coefficient: products of four of them must remain numbers


@dataclass(frozen=True)
class LoopTransfer:
    """Numerator, denominator (descending powers of s), dead time and function part of a loop transfer function."""

    num: Array
    den: Array
    dead_time: float
    plant: Plant

    @classmethod
    def of(cls, plant: Plant, controller: PID) -> LoopTransfer:
        """Return the loop transfer function of a plant and a controller's feedback part.

        Raises
        ------
        ImproperLoopError
            If |L| grows without bound at high frequency, or L tends to -1 there in a loop without dead time.
        LoopError
            If a coefficient of L is too large to compute with.
        """
        from replicate.loops.frequency_domain.other_transfers import FunctionTransfer, SumTransfer

        num, den = controller.feedback_polynomials()
        num = _computable(trimmed(num))
        if isinstance(plant, SumPlant):
            return SumTransfer.of_parts(plant, num, den)
        if not plant.is_rational:
            return FunctionTransfer(num, den, plant.dead_time, plant)
        num = _computable(trimmed(product(num, plant.num))) if num.size else num
        den = _computable(product(den, plant.den))
        transfer = LoopTransfer(num, den, plant.dead_time, plant)
        if transfer.num.size > den.size:
            msg = "the loop gain grows without bound at high frequency: filter the derivative or the measurement"
            raise ImproperLoopError(msg)
        if not plant.dead_time and transfer.num.size == den.size and abs(1.0 + transfer.num[0] / den[0]) < ILL_POSED:
            msg = "the loop is not well posed: without dead time L must not tend to -1 at infinite frequency"
            raise ImproperLoopError(msg)
        return transfer

    @property
    def is_polynomial(self) -> bool:
        """Whether the closed loop's poles are the roots of a polynomial: a rational loop without dead time."""
        return self.is_rational and self.dead_time == 0.0

    @property
    def longest_dead_time(self) -> float:
        """The longest of the dead times."""
        return max((part.dead_time for part in self.plant.parts), default=self.dead_time)

    @property
    def open_loop_poles(self) -> ComplexArray:
        """The poles of the open loop's rational part: the zeros of f where L is negligible."""
        return self._roots[1]

    @cached_property
    def _roots(self) -> tuple[ComplexArray, ComplexArray]:
        return roots_of(self.num), roots_of(self.den)

    @property
    def zeros(self) -> ComplexArray:
        """The zeros of L's rational part."""
        return self._roots[0]

    def shifted(self, by: float) -> LoopTransfer:
        """Return L(s + by) of a rational loop: its closed-loop poles are those of L, moved by -by."""
        num = polynomials.shifted(self.num, by) * math.exp(-by * self.dead_time)
        moved = LoopTransfer(num, polynomials.shifted(self.den, by), self.dead_time, self.plant)
        moved.__dict__["_roots"] = self._roots[0] - by, self._roots[1] - by
        return moved

    @property
    def is_rational(self) -> bool:
        """Whether L is a rational function times one dead time."""
        return self.plant.is_rational

    @cached_property
    def closed_loop_roots(self) -> ComplexArray:
        """The zeros of f in a loop without dead time."""
        return roots_of(trimmed(np.asarray(np.polyadd(self.den, self.num), dtype=float)))

    @cached_property
    def _coefficients(self) -> tuple[list[float], list[float]]:
        return self.num.tolist(), self.den.tolist()

    def __call__(self, s: Any) -> ComplexArray:
        """Evaluate L(s) at complex ``s``."""
        num, den = self._coefficients
        if isinstance(s, complex):  # root finders ask for one point after the other
            try:
                return np.asarray(horner(num, s) / horner(den, s) * cmath.exp(-s * self.dead_time))
            except (ZeroDivisionError, OverflowError):
                pass
        s = np.asarray(s, dtype=complex)
        return np.asarray(horner(num, s) / horner(den, s) * np.exp(-s * self.dead_time))

    def without_longest(self, s: ComplexArray) -> ComplexArray:
        """Evaluate L(s) times exp(s longest_dead_time)."""
        return np.asarray(np.polyval(self.num, s) / np.polyval(self.den, s))

    def characteristic(self, s: Any) -> ComplexArray:
        """Evaluate f(s) = D(s) + N(s) g(s) exp(-s dead_time)."""
        num, den = self._coefficients
        s = np.asarray(s, dtype=complex)
        return np.asarray(horner(den, s) + horner(num, s) * np.exp(-s * self.dead_time))

    def characteristic_slope(self, s: ComplexArray) -> ComplexArray:
        """Evaluate f'(s)."""
        return self.characteristic_with_slope(s)[1]

    def characteristic_with_slope(self, s: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Evaluate f(s) and f'(s) together."""
        num, den = self._coefficients
        (n, n_slope), (d, d_slope) = horner_with_slope(num, s), horner_with_slope(den, s)
        delay = np.exp(-s * self.dead_time)
        return np.asarray(d + n * delay), np.asarray(d_slope + (n_slope - self.dead_time * n) * delay)

    def size(self, s: ComplexArray) -> Array:
        """Return the sum of the moduli of f's terms: its rounding error is this times the relative precision."""
        modulus = np.abs(s)
        top = np.polyval(np.abs(self.num), modulus) * np.abs(np.exp(-s * self.dead_time))
        return np.asarray(np.polyval(np.abs(self.den), modulus) + top)

    def log_derivative(self, s: Any) -> ComplexArray:
        """Evaluate L'(s)/L(s), as exact as the plant's own `Plant.log_derivative`."""
        if isinstance(s, complex):
            try:
                return np.asarray(self._log_derivative(s))
            except (ZeroDivisionError, OverflowError):
                pass
        return np.asarray(self._log_derivative(np.asarray(s, dtype=complex)))

    def _log_derivative(self, s: Any) -> Any:
        num, den = self._coefficients
        (n, n_slope), (d, d_slope) = horner_with_slope(num, s), horner_with_slope(den, s)
        return n_slope / n - d_slope / d - self.dead_time

    def with_log_derivative(self, s: complex) -> tuple[complex, complex]:
        """Evaluate L(s) and L'(s)/L(s) together, at one point."""
        if type(self) is LoopTransfer:
            num, den = self._coefficients
            (n, n_slope), (d, d_slope) = horner_with_slope(num, s), horner_with_slope(den, s)
            try:
                return n / d * cmath.exp(-s * self.dead_time), n_slope / n - d_slope / d - self.dead_time
            except (ZeroDivisionError, OverflowError):
                pass
        return complex(self(s)), complex(self.log_derivative(s))

    def log_modulus(self, w: float) -> float:
        """Evaluate log |L(i w)|."""
        return float(np.log(np.abs(complex(self(1j * w)))))

    @cached_property
    def feedthrough(self) -> float:
        """|L| in the limit of infinite frequency (0 for retarded loops)."""
        if self.num.size < self.den.size:
            return 0.0
        return float(abs(self.num[0] / self.den[0])) if self.num.size else 0.0

    @cached_property
    def limit_curve(self) -> LimitCurve:
        """What L(i w) approaches at infinite frequency."""
        if not self.feedthrough:
            return VANISHING
        return limit_of(np.array([self.num[0] / self.den[0]]), np.array([self.dead_time]))

    def off_limit(self, w: float) -> float:
        """Return how far |L| exceeds its limit at most beyond a frequency that `beyond` has returned."""
        return max(float(abs(self(1j * w))) - self.feedthrough, 0.0)

    @property
    def infinite_at_rest(self) -> bool:
        """Whether |L| is infinite at s = 0."""
        return bool(self.den[-1] == 0.0)

    @property
    def pole_at_rest(self) -> bool:
        """Whether s = 0 is a closed-loop pole, as for a zero of the plant there that meets an integrator."""
        return self.is_rational and not self.den[-1] + (self.num[-1] if self.num.size else 0.0)

    @cached_property
    def gain_stationary(self) -> Array:
        """Positive frequencies at which |L(i w)| is stationary, ascending; |L| is monotone beyond the last one."""
        return stationary_frequencies(self.num, self.den)

    @cached_property
    def real_frequencies(self) -> Array:
        """Positive frequencies at which L(i w) is real, ascending (rational, without dead time); for a bound only."""
        mirrored = self.den * (-1.0) ** np.arange(self.den.size - 1, -1, -1)
        product = np.polymul(self.num, mirrored)[::-1]  # N(s) D(-s), ascending: odd powers are imaginary on the axis
        odd = product[1::2]
        signs = (-1.0) ** np.arange(odd.size)
        return _near_positive_axis(np.roots(np.trim_zeros((odd * signs)[::-1], "f")))

    @cached_property
    def gain_crossovers(self) -> Array:
        """All frequencies at which |L(i w)| = 1, ascending."""
        n, d = polynomials.squared_magnitude(self.num), polynomials.squared_magnitude(self.den)
        roots = roots_of_difference(n, d)
        real = roots.real[(roots.real > 0.0) & (np.abs(roots.imag) <= ON_AXIS * np.abs(roots.real))]
        return np.sort([self._polished_crossover(math.sqrt(x)) for x in real.tolist()])

    def _polished_crossover(self, w: float) -> float:
        """Return a gain crossover to rounding, by Newton's method on log |L|: dead times are no part of it."""
        num, den = self._coefficients
        for _ in range(3):
            at = complex(0.0, w)
            (n, n_slope), (d, d_slope) = horner_with_slope(num, at), horner_with_slope(den, at)
            slope = (d_slope / d - n_slope / n).imag if n and d else 0.0
            step = math.log(abs(n / d)) / slope if slope else 0.0
            w -= min(max(step, -0.5 * w), 0.5 * w)
            if abs(step) <= EPS * w:
                break
        return w

    @cached_property
    def corner_frequencies(self) -> ComplexArray:
        """Nonzero poles and zeros of L's rational part: where its frequency response bends."""
        roots = np.concatenate(self._roots)
        return np.asarray(roots[np.abs(roots) > 0.0])

    def beyond(self, level: float) -> float:
        """Return a frequency beyond which |L(i w)| provably stays below ``level`` > `feedthrough`.

        |L| is monotone beyond its last stationary point, so one evaluation is a proof.
        """
        moduli = [*self.gain_stationary.tolist(), *np.abs(self.corner_frequencies).tolist()]
        return self._fall(max(moduli, default=1.0), level)

    def _fall(self, start: float, level: float, ahead: Array | None = None) -> float:
        """Return a frequency w from which on |L| is below a level, as seen at w, or at ``ahead`` times w."""
        w = start * (1.0 + JUST_BEYOND)
        for _ in range(MOST_STEPS):
            gain = float(np.abs(self(complex(0.0, w) if ahead is None else 1j * w * ahead)).max())
            if gain < level:
                return float(w)
            if math.isnan(gain):
                msg = "the plant's function is not finite at high frequency: write it so that it does not overflow"
                raise LoopError(msg)
            w *= STEP
        raise never_falls(level)


def never_falls(level: float) -> ImproperLoopError:
    """Return the error of a loop whose gain stays above a level."""
    return ImproperLoopError(f"the loop gain does not fall below {level:g} at high frequency")


def _computable(coefficients: Array) -> Array:
    """Return the coefficients of L after none is too large."""
    if not all(-LARGEST <= coefficient <= LARGEST for coefficient in coefficients.tolist()):
        largest = float(np.max(np.abs(coefficients)))
        msg = (
            f"the loop gain is too large to compute with: in the plant's own units of gain and time it has the "
            f"coefficient {largest:.3g}; allowed are at most {LARGEST:g}"
        )
        raise LoopError(msg)
    return coefficients


def stationary_frequencies(num: Array, den: Array) -> Array:
    """Return the positive frequencies at which |num/den| is stationary on the imaginary axis, ascending."""
    n, d = polynomials.squared_magnitude(num), polynomials.squared_magnitude(den)
    return _near_positive_axis(
        roots_of_difference(product(polynomials.derivative(n), d), product(n, polynomials.derivative(d)))
    )


def _near_positive_axis(found: ArrayLike) -> Array:
    """Return the square roots of the positive ones among roots in w^2, ascending."""
    # a nearly double root may leave the axis: keep everything close to it, it only makes a bound safer
    roots = np.asarray(found, dtype=complex)
    x = roots.real[(roots.real > 0.0) & (np.abs(roots.imag) <= 0.5 * np.abs(roots.real))]
    return np.sort(np.sqrt(x))

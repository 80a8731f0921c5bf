"""Sensitivity peaks and stability margins of many stable loops at once, polished on the exact transfer function."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.frequency_domain.sensitivity import TIE
from replicate.loops.sweep.frequency_scan import Scan, scan
from replicate.loops.sweep.loop_columns import LoopColumns, column_products
from replicate.loops.sweep.stability_counts import polynomial_roots, squared_magnitude

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Flags = NDArray[np.bool_]
Places = NDArray[np.intp]

STEPS = 30  # most steps of Newton's method
SHORT = 2e-5  # step, of the frequency and of a resonance's width, after which the next value is known to rounding
NEAR_ONE = 0.05  # relative error of |L| at a phase crossover as read from the grid
RIVAL = 0.1  # minima this much higher than the lowest are looked at, too


class FrequencyMetrics:
    """Ms, Mp, gain, phase and delay margin of the stable loops of a block, in the block's unit of time.

    Attributes
    ----------
    doubtful : array, shape (n,)
        Which loops must be asked one by one; grows with the questions.
    """

    def __init__(self, loops: LoopColumns, crossovers: Array) -> None:
        self.loops, self.crossovers = loops, crossovers
        self.doubtful = np.zeros(len(loops), dtype=bool)

    @cached_property
    def _scan(self) -> Scan:
        return scan(self.loops, self.crossovers)

    @cached_property
    def _at_rest(self) -> Array:
        """L(0); ``inf`` with integral action."""
        if not self.loops.den[-1]:
            return np.full(len(self.loops), np.inf)
        return np.asarray(self.loops.num[-1] / self.loops.den[-1])

    @cached_property
    def _distances(self) -> tuple[Array, Array]:
        """Squared distances of L from -1 and from 0 on the grid."""
        real, imag = self._scan.real, self._scan.imag
        size = real * real
        size += imag * imag
        distance = 2.0 * real
        distance += size
        distance += 1.0
        return distance, size

    # ---- peaks -----------------------------------------------------------------------------------------------------

    def ms(self) -> Array:
        """Return max |1/(1 + L)|."""
        return self._sensitivity[0]

    def ms_frequency(self) -> Array:
        """Return where |1/(1 + L)| is largest; of equal peaks the lowest frequency, ``inf`` in the limit."""
        return self._polished(self._sensitivity[1], inverse=False)

    def mp(self) -> Array:
        """Return max |L/(1 + L)|."""
        return self._complementary[0]

    def mp_frequency(self) -> Array:
        """Return where |L/(1 + L)| is largest; as `ms_frequency`."""
        return self._polished(self._complementary[1], inverse=True)

    @cached_property
    def _sensitivity(self) -> tuple[Array, Array]:
        distance, _ = self._distances
        with np.errstate(all="ignore"):
            at_rest = np.where(np.isinf(self._at_rest), 0.0, np.abs(1.0 / (1.0 + self._at_rest)))
        limit = 1.0 / (1.0 - self.loops.feedthrough)
        peak, frequency = self._with_ends(self._peak(distance, inverse=False), at_rest, limit)
        beyond = np.where(self._may_exceed_one_beyond, 1.0 / (1.0 - self._beyond), 1.0)
        self._require_bounded(peak, beyond, limit)
        return peak, frequency

    @cached_property
    def _complementary(self) -> tuple[Array, Array]:
        distance, size = self._distances
        with np.errstate(all="ignore"):
            at_rest = np.where(np.isinf(self._at_rest), 1.0, np.abs(self._at_rest / (1.0 + self._at_rest)))
            ratio = distance / size
        limit = self.loops.feedthrough / (1.0 - self.loops.feedthrough)
        peak, frequency = self._with_ends(self._peak(ratio, inverse=True), at_rest, limit)
        self._require_bounded(peak, self._beyond / (1.0 - self._beyond), limit)
        return peak, frequency

    @staticmethod
    def _with_ends(peak: tuple[Array, Array], at_rest: Array, limit: Array) -> tuple[Array, Array]:
        """Return the highest of peaks and the values at rest and in the limit of infinite frequency."""
        value, frequency = np.maximum(peak[0], at_rest), np.where(at_rest >= peak[0], 0.0, peak[1])
        return np.maximum(value, limit), np.where(limit > value, np.inf, frequency)

    @property
    def _beyond(self) -> Array:
        """A bound below one on |L| beyond the grid; too large where there is none."""
        return np.minimum(self._scan.beyond, 1.0 - 1e-12)

    def _require_bounded(self, peak: Array, beyond: Array, limit: Array) -> None:
        """Leave to the single loop what may be higher beyond the grid."""
        self.doubtful |= ~(beyond <= np.maximum(peak, limit))

    def _peak(self, squares: Array, *, inverse: bool) -> tuple[Array, Array]:
        """Return the inverse root of the minima of |1 + L|^2, or of |1 + 1/L|^2, and where they are, if inside."""
        lowest = squares.min(axis=0)
        valley = squares[1:-1] <= squares[:-2]
        valley &= squares[1:-1] <= squares[2:]
        valley &= squares[1:-1] <= (1.0 + RIVAL) * lowest
        at, column = np.nonzero(valley)
        at += 1
        w = self._scan.w
        best, frequency = lowest.copy(), np.full(lowest.size, np.inf)
        if at.size:
            start = _vertex(w, squares, at, column)
            found, place = _polished_minima(self.loops.take(column), w[at - 1], start, w[at + 1], inverse=inverse)
            np.minimum.at(best, column, found)
            equal = found <= best[column] * (1.0 + 2.0 * TIE)
            np.minimum.at(frequency, column[equal], place[equal])
        return np.asarray(1.0 / np.sqrt(best)), np.where(np.isinf(frequency), np.nan, frequency)

    def _polished(self, frequency: Array, *, inverse: bool) -> Array:
        """Return frequencies of peaks to rounding: their values are, before the frequencies."""
        self.doubtful |= np.isnan(frequency)
        inside = np.nonzero(np.isfinite(frequency) & (frequency > 0.0))[0]
        gradient, curvature, _ = _slopes(self.loops.take(inside), frequency[inside], inverse=inverse)
        polished = frequency.copy()
        polished[inside] -= gradient / curvature
        return polished

    # ---- margins ---------------------------------------------------------------------------------------------------

    @cached_property
    def _lags(self) -> tuple[Array, Array]:
        """Gain crossovers to rounding, and the phase of L above -180 degrees there; ``inf`` where there is none."""
        exists = np.isfinite(self.crossovers)
        place, column = np.nonzero(exists)
        w, part = self.crossovers[place, column], self.loops.take(column)
        value, slope, _ = _jet(part, w)
        step = -np.log(np.abs(value)) / (slope / value).real  # of the size of rounding: the crossovers are roots
        w, value = w + step, value + step * slope
        crossovers, lags = np.full(exists.shape, np.inf), np.full(exists.shape, np.inf)
        crossovers[place, column], lags[place, column] = w, np.mod(np.angle(value) + np.pi, 2.0 * np.pi)
        return crossovers, lags

    def phase_margin(self) -> Array:
        """Return the smallest additional phase lag, in degrees, that makes a loop unstable; ``inf`` if none does."""
        return np.asarray(np.degrees(self._lags[1].min(axis=0, initial=np.inf)))

    def delay_margin(self) -> Array:
        """Return the smallest additional dead time that makes a loop unstable; ``inf`` if none does."""
        crossovers, lags = self._lags
        with np.errstate(invalid="ignore"):
            return np.asarray(np.where(np.isinf(crossovers), np.inf, lags / crossovers).min(axis=0, initial=np.inf))

    def gain_margin(self) -> Array:
        """Return the smallest factor > 1 on L that makes a loop unstable; ``inf`` if none does."""
        real, imag, w = self._scan.real, self._scan.imag, self._scan.w
        crossing = (imag[1:] < 0.0) != (imag[:-1] < 0.0)
        crossing &= (real[1:] + real[:-1]) < 0.0
        before, column = np.nonzero(crossing)
        left, right = imag[before, column], imag[before + 1, column]
        share = left / (left - right)
        size = -(real[before, column] + share * (real[before + 1, column] - real[before, column]))
        # only the largest |L| below one counts, and what is one as far as the grid can say
        largest = np.zeros(len(self.loops))
        np.maximum.at(largest, column, np.where(size < 1.0 - NEAR_ONE, size, 0.0))
        chosen = (size >= (1.0 - 2.0 * NEAR_ONE) * largest[column]) & (size <= 1.0 + NEAR_ONE)
        before, column, share = before[chosen], column[chosen], share[chosen]
        margin = np.full(len(self.loops), np.inf)
        if before.size:
            w_0, w_1 = w[before], w[before + 1]
            value = _polished_crossovers(
                self.loops.take(column), w_0, w_1, w_0 + share * (w_1 - w_0), np.sign(left[chosen])
            )  # fmt: skip
            factor = -1.0 / value.real
            np.minimum.at(margin, column, np.where(factor > 1.0, factor, np.inf))
        with np.errstate(divide="ignore"):
            at_rest = np.where((self._at_rest < 0.0) & (self._at_rest > -1.0), -1.0 / self._at_rest, np.inf)
            tail = 1.0 / self.loops.feedthrough
            margin = np.minimum(margin, np.minimum(at_rest, tail))
            self.doubtful |= self._may_be_real_beyond & (self._scan.beyond * (1.0 - 1e-12) > 1.0 / margin)
        return np.asarray(margin)

    @property
    def _may_be_real_beyond(self) -> Flags:
        """Which curves may be real at a frequency beyond the grid; without dead time the roots of a polynomial say."""
        if self.loops.delay:
            return np.ones(len(self.loops), dtype=bool)
        return self._may_have_roots_beyond(self._turned[1::2])

    @property
    def _may_exceed_one_beyond(self) -> Flags:
        """For which loops |S| may exceed one at a frequency beyond the grid."""
        if self.loops.delay:
            return np.ones(len(self.loops), dtype=bool)
        excess = 2.0 * self._turned[::2]  # (|1 + L|^2 - 1) |D|^2 = |N|^2 + 2 Re(N conj(D))
        size = squared_magnitude(self.loops.num)[::-1]
        excess[: size.shape[0]] += size
        return np.asarray(self._may_have_roots_beyond(excess) | (excess[-1] <= 0.0))

    @property
    def _turned(self) -> Array:
        """N(s) D(-s) at s = i w: real coefficients of w, ascending; the even ones are the real part's."""
        mirrored = self.loops.den * (-1.0) ** np.arange(self.loops.den.size - 1, -1, -1)
        ascending = column_products(self.loops.num, mirrored)[::-1]
        return np.asarray(ascending * ((-1.0) ** (np.arange(ascending.shape[0]) // 2))[:, None])

    def _may_have_roots_beyond(self, rows: Array) -> Flags:
        """Return which polynomials in w^2, ascending coefficients in columns, may have a root beyond the grid."""
        roots, lost = polynomial_roots(rows[::-1])
        near = (roots.real > 0.9 * self._scan.w[-1] ** 2) & (np.abs(roots.imag) <= 0.5 * roots.real)
        return np.asarray(near.any(axis=0) | lost)


def _vertex(w: Array, values: Array, at: Places, column: Places) -> Array:
    """Return where the parabola through three neighbouring points of a valley is lowest."""
    left, middle, right = w[at - 1], w[at], w[at + 1]
    below, above = middle - left, right - middle
    down = (values[at, column] - values[at - 1, column]) / below
    up = (values[at + 1, column] - values[at, column]) / above
    with np.errstate(all="ignore"):
        vertex = 0.5 * (left + middle) - 0.5 * down * (right - left) / (up - down)
    return np.asarray(np.where((vertex > left) & (vertex < right), vertex, middle))


def _jet(loops: LoopColumns, w: Array) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return L(i w) and its first two derivatives in w, one frequency for each loop."""
    s = 1j * w
    n, n_1, n_2 = _taylor(loops.num, s)
    d, d_1, d_2 = _taylor(loops.den[:, None], s)
    inverse = 1.0 / d
    q = n * inverse
    q_1 = (n_1 - q * d_1) * inverse
    q_2 = (n_2 - 2.0 * q_1 * d_1 - q * d_2) * inverse
    delay, turn = loops.delay, np.exp(-loops.delay * s)
    slope, bend = 1j * (q_1 - delay * q), 2.0 * delay * q_1 - q_2 - delay * q
    return np.asarray(q * turn), np.asarray(slope * turn), np.asarray(bend * turn)


def _taylor(coefficients: Array, s: ComplexArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return polynomials in columns and their first two derivatives."""
    value, slope, half_bend = (np.zeros(s.shape, dtype=complex) for _ in range(3))
    for order, row in enumerate(coefficients):
        if order > 1:
            half_bend *= s
            half_bend += slope
        if order:
            slope *= s
            slope += value
        value *= s
        value += row
    return value, slope, np.asarray(2.0 * half_bend)


def _polished_minima(
    loops: LoopColumns, left: Array, start: Array, right: Array, *, inverse: bool
) -> tuple[Array, Array]:
    """Return the minima of |1 + L|^2, or of |1 + 1/L|^2, each between two frequencies, and where they are.

    Newton's method, bracketed.
    """
    low, high, w = left.copy(), right.copy(), start.copy()
    best = np.full(w.size, np.inf)
    moving = np.arange(w.size)
    for _ in range(STEPS):
        part = loops if moving.size == w.size else loops.take(moving)
        at = w[moving]
        gradient, curvature, (offset, slope) = _slopes(part, at, inverse=inverse)
        falling = gradient < 0.0
        low[moving], high[moving] = np.where(falling, at, low[moving]), np.where(falling, high[moving], at)
        with np.errstate(all="ignore"):
            step = -gradient / curvature
        following = at + step
        inside = (curvature > 0.0) & (following > low[moving]) & (following < high[moving])
        following = np.where(inside, following, 0.5 * (low[moving] + high[moving]))
        # where the step is short the parabola's own minimum is exact to the third power of the step
        best[moving] = np.abs(offset) ** 2 + np.where(inside, gradient * step, 0.0)
        w[moving] = following
        with np.errstate(all="ignore"):
            width = np.abs(offset / slope)  # of a resonance: of a narrow one the frequency says nothing
        moving = moving[np.abs(following - at) > SHORT * np.fmin(at, width)]
        if moving.size == 0:
            break
    return best, w


def _slopes(loops: LoopColumns, w: Array, *, inverse: bool) -> tuple[Array, Array, tuple[ComplexArray, ComplexArray]]:
    """Return half the first two derivatives of |1 + L|^2, or of |1 + 1/L|^2, and 1 + L (1 + 1/L) with its slope."""
    value, slope, bend = _jet(loops, w)
    if inverse:
        value, slope, bend = 1.0 / value, -slope / value**2, 2.0 * slope**2 / value**3 - bend / value**2
    offset = 1.0 + value
    gradient = (np.conj(offset) * slope).real
    return gradient, np.abs(slope) ** 2 + (np.conj(offset) * bend).real, (offset, slope)


def _polished_crossovers(loops: LoopColumns, left: Array, right: Array, start: Array, sign: Array) -> ComplexArray:
    """Return L where it is real, each between two frequencies; ``sign`` is that of the imaginary part at the first."""
    low, high, w = left.copy(), right.copy(), start.copy()
    result = np.zeros(w.size, dtype=complex)
    moving = np.arange(w.size)
    for _ in range(STEPS):
        part = loops if moving.size == w.size else loops.take(moving)
        at = w[moving]
        value, slope, bend = _jet(part, at)
        before = np.sign(value.imag) == sign[moving]
        low[moving], high[moving] = np.where(before, at, low[moving]), np.where(before, high[moving], at)
        with np.errstate(all="ignore"):
            step = -value.imag / slope.imag
        following = at + step
        inside = (following >= low[moving]) & (following <= high[moving])
        following = np.where(inside, following, 0.5 * (low[moving] + high[moving]))
        # L at the root itself, one step ahead and with what the bend adds to it
        step = following - at
        bent = np.where(inside, -0.5 * bend.imag * step**2 / slope.imag, 0.0)
        result[moving] = value + (step + bent) * slope + 0.5 * step**2 * bend
        w[moving] = following
        with np.errstate(all="ignore"):
            width = np.abs(slope / bend)
        moving = moving[np.abs(step) > SHORT * np.fmin(at, width)]
        if moving.size == 0:
            break
    return result

"""Gain, phase and delay margins from all crossovers, not the first one met."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from replicate.loops.frequency_domain.frequency_grids import bands_beyond, loop_grid
from replicate.loops.frequency_domain.limit_torus import LimitTorus
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics.bracketed import bracketed_root
from replicate.loops.records import Record

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MORE = 2.5 * np.pi  # rad of the dead time, one full turn and more, so that a crossover below one is always included
SAME = 1e-12  # relative difference of two gain margins that is rounding
NEWTON_STEPS, CONVERGED = 6, 1e-9  # to a crossover, and the last one, relative, after which the next is below rounding
SMALL = 1e-6  # |L| beyond which no crossover without dead time matters


@dataclass(frozen=True, eq=False)
class Margins(Record):
    """The stability margins of a stable loop.

    Attributes
    ----------
    gain
        Smallest factor > 1 on the loop gain that makes the loop unstable; ``inf`` if none does.
    gain_reduction
        Largest factor < 1 that makes it unstable (unstable plants, conditional stability); 0 if none does.
    phase
        Smallest additional phase lag, in degrees, that makes it unstable; ``inf`` if none does.
    delay
        Smallest additional dead time that makes it unstable; ``inf`` if none does.
    phase_crossover, phase_crossover_low, gain_crossover, delay_crossover
        Frequencies that belong to gain, gain_reduction, phase and delay (``nan`` where there is none), rad per
        unit time.
    gain_crossovers
        All frequencies with |L| = 1, ascending.
    phase_crossovers
        Frequencies with arg L = -180 degrees (modulo 360), ascending. With dead time there are infinitely many: these
        are all that matter, up to one full turn of the dead time beyond the last frequency at which |L| reaches one
        half (for a loop whose |L| tends to d > 0, half way between d and one). With several dead times |L| may rise
        again: the gain margin may belong to a later one.

    Examples
    --------
    L = e^{-s}/(2 s) has its phase crossover at pi/2, where its size is 1/pi, and its gain crossover at 1/2, where its
    phase is -90 degrees less half a radian: a phase margin of pi/2 - 1/2, a delay margin of twice that.

    >>> from math import degrees, pi
    >>> from replicate.loops import PI, Loop, Plant
    >>> margins = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.5)).margins()
    >>> round(margins.gain - pi, 12), round(margins.delay - (pi - 1.0), 12)
    (0.0, 0.0)
    >>> round(margins.phase / degrees(pi / 2 - 0.5), 12)
    1.0
    """

    gain: float
    gain_reduction: float
    phase: float
    delay: float
    phase_crossover: float
    phase_crossover_low: float
    gain_crossover: float
    delay_crossover: float
    phase_crossovers: tuple[float, ...]
    gain_crossovers: tuple[float, ...]

    def in_time(self, time: float) -> Margins:
        """Return the margins of the same loop in a unit of time that is ``time`` times smaller."""
        return replace(
            self,
            delay=self.delay * time,
            phase_crossover=self.phase_crossover / time,
            phase_crossover_low=self.phase_crossover_low / time,
            gain_crossover=self.gain_crossover / time,
            delay_crossover=self.delay_crossover / time,
            phase_crossovers=tuple(w / time for w in self.phase_crossovers),
            gain_crossovers=tuple(w / time for w in self.gain_crossovers),
        )


def margins(transfer: LoopTransfer) -> Margins:
    """Return the margins of a stable loop; the caller has checked stability."""
    phase_crossovers = _phase_crossovers(transfer)
    factors = 1.0 / np.abs(transfer(1j * phase_crossovers)) if phase_crossovers.size else np.empty(0)
    above, below = factors > 1.0, factors < 1.0
    gain, gain_at = _extreme(factors[above], phase_crossovers[above], np.argmin, float("inf"))
    reduction, reduction_at = _extreme(factors[below], phase_crossovers[below], np.argmax, 0.0)
    # at infinite frequency a neutral loop loses stability, and an algebraic one its solution, where L tends to -1
    for value in transfer.limit_curve.real_values:
        limit = float(-1.0 / value) if value < 0.0 else float("nan")
        if 1.0 < limit < gain:
            gain, gain_at = limit, float("inf")
        elif reduction < limit < 1.0:
            reduction, reduction_at = limit, float("inf")
    if not transfer.is_rational and np.isfinite(gain):
        gain, gain_at = _lower_beyond(transfer, gain, gain_at)
    curve = transfer.limit_curve
    if isinstance(curve, LimitTorus) and curve.lowest < -(1.0 + SAME) / gain:
        curve.refuse("gain margin")

    w = transfer.gain_crossovers
    lag = np.mod(np.angle(transfer(1j * w)) + np.pi, 2.0 * np.pi) if w.size else np.empty(0)
    phase, phase_at = _extreme(np.degrees(lag), w, np.argmin, float("inf"))
    delay, delay_at = _extreme(lag / w if w.size else lag, w, np.argmin, float("inf"))
    if curve.size >= 1.0:  # with any more dead time the loop is neutral and unstable
        if not curve.reached:
            curve.refuse("delay margin")
        delay, delay_at = 0.0, float("inf")
    return Margins(
        gain, reduction, phase, delay, gain_at, reduction_at, phase_at, delay_at,
        tuple(phase_crossovers.tolist()), tuple(w.tolist()),
    )  # fmt: skip


def _extreme(values: Array, frequencies: Array, select: object, empty: float) -> tuple[float, float]:
    if values.size == 0:
        return empty, float("nan")
    index = int(select(values))  # type: ignore[operator]
    return float(values[index]), float(frequencies[index])


def _phase_crossovers(transfer: LoopTransfer) -> Array:
    """Return all frequencies with L real and negative, up to where |L| only falls."""
    if transfer.num.size == 0:
        return np.empty(0)
    w = loop_grid(transfer, _end(transfer), per_decade=80)
    value = transfer(1j * w)
    exact = w[(value.imag == 0.0) & (value.real < 0.0)]
    found = [_polished(transfer, w, i) for i in _turning_negative(value)]
    roots = np.sort(np.concatenate([np.array(found), exact]))
    roots = roots[transfer(1j * roots).real < 0.0] if roots.size else roots
    # without integral action the curve starts on the real axis, where a pole can pass through s = 0
    starts_negative = bool(transfer.den[-1]) and float(complex(transfer(0.0)).real) < 0.0
    return np.concatenate([[0.0], roots]) if starts_negative else roots


def _end(transfer: LoopTransfer) -> float:
    """Return the end of the band in which all phase crossovers are looked for."""
    if transfer.is_polynomial:
        corners = np.abs(transfer.corner_frequencies)
        return 2.0 * max([*transfer.real_frequencies.tolist(), *corners.tolist()], default=1.0)
    if not transfer.dead_time:
        return transfer.beyond(SMALL)
    return transfer.beyond(0.5 * (1.0 + transfer.feedthrough)) + MORE / transfer.dead_time


def _turning_negative(value: ComplexArray) -> NDArray[np.intp]:
    """Return after which values the curve crosses the negative real axis."""
    turned = value.imag[:-1] * value.imag[1:] < 0.0
    return np.nonzero(turned & (value.real[:-1] + value.real[1:] < 0.0))[0]


def _polished(transfer: LoopTransfer, w: Array, i: int) -> float:
    """Return a phase crossover to rounding, by Newton's method on the phase, or by what brackets it."""
    left, right = float(w[i]), float(w[i + 1])
    at = 0.5 * (left + right)
    for _ in range(NEWTON_STEPS if transfer.is_rational else 0):
        value, turn = transfer.with_log_derivative(complex(0.0, at))
        step = cmath.phase(-value) / turn.real if turn.real else math.nan
        at -= step
        if not left <= at <= right:
            break
        if abs(step) <= CONVERGED * at:
            return at
    return bracketed_root(lambda x: float(complex(transfer(1j * x)).imag), left, right)


def _lower_beyond(transfer: LoopTransfer, gain: float, gain_at: float) -> tuple[float, float]:
    """Return the gain margin and its frequency where |L| may rise again beyond the band of the crossovers."""
    lowest = transfer.limit_curve.lowest
    for start, end in bands_beyond(transfer, _end(transfer)):
        off = transfer.off_limit(start)
        if off <= SAME or lowest - off >= -1.0 / gain:
            break
        w = loop_grid(transfer, end, per_decade=80)
        w = np.append(start, w[w > start])
        value = transfer(1j * w)
        for i in _turning_negative(value):
            if max(abs(value[i]), abs(value[i + 1])) > 1.0 / gain:
                at = _polished(transfer, w, i)
                at_crossover = complex(transfer(1j * at))
                if at_crossover.real < -(1.0 + SAME) / gain:
                    gain, gain_at = -1.0 / at_crossover.real, at
    return gain, gain_at

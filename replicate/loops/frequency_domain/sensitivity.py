r"""Peaks of the sensitivity S = 1/(1+L) and the complementary sensitivity T = L/(1+L).

A peak is found on a grid that resolves every resonance and dead-time rotation and polished by bracketing the root of
the derivative of log|1+L|. The band is cut where :math:`|S| \le 1/(1-|L|)` proves that nothing beyond can exceed the
peak found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from replicate.loops.frequency_domain.frequency_grids import bands_beyond, peak_grid
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer, stationary_frequencies
from replicate.loops.numerics.peaks import FrequencyPeak

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

LOW_GAIN = 0.75  # share of the way down from |L| = 1 to its limit, beyond which few loops have their peak
STEEP = 10.0  # times what a peak stands above its neighbours on the grid: more than polishing adds to it
ROUNDING = 1e-13  # share by which a bound exceeds a peak without meaning it
TIE = 1e-9  # a design at two tangencies makes two peaks equal to within its own convergence


@dataclass(frozen=True)
class _Kind:
    """S or T: what it is at most for an L that is so close to a value, the slope of its logarithm in w, and so on."""

    bound: Callable[[ComplexArray, float], Array]
    slope: Callable[[float], float]
    at_infinite_gain: float
    name: str
    ratio: tuple[Array, Array]  # of the rational part; the magnitude itself if there is no dead time

    def magnitude(self, value: ComplexArray) -> Array:
        """Return the magnitude where L has a value."""
        return self.bound(value, 0.0)


def sensitivity_peak(transfer: LoopTransfer, poles: ComplexArray, center: float = 1.0) -> FrequencyPeak:
    """Return max 1/|center + L| of a stable loop; with center 1 this is Ms.

    For any center >= 1 its inverse is the distance of the Nyquist curve from the point -center. ``poles`` (closed loop)
    show where narrow peaks are.
    """

    def slope(w: float) -> float:
        value, turn = transfer.with_log_derivative(complex(0.0, w))
        return (-1j * value * turn / (center + value)).real

    kind = _Kind(
        lambda value, off: _ratio(1.0, np.abs(center + value) - off),
        slope,
        0.0,
        "sensitivity peak" if center == 1.0 else "closest approach",
        (transfer.den, np.asarray(np.polyadd(center * transfer.den, transfer.num), dtype=float)),
    )
    return _peak(transfer, poles, kind)


def complementary_peak(transfer: LoopTransfer, poles: ComplexArray) -> FrequencyPeak:
    """Return Mp = max |L/(1+L)| of a stable loop."""

    def slope(w: float) -> float:
        value, turn = transfer.with_log_derivative(complex(0.0, w))
        return (1j * turn / (1.0 + value)).real

    closed = (transfer.num, np.asarray(np.polyadd(transfer.den, transfer.num), dtype=float))
    return _peak(
        transfer,
        poles,
        _Kind(
            lambda value, off: _ratio(np.abs(value) + off, np.abs(1.0 + value) - off),
            slope,
            1.0,
            "complementary sensitivity peak",
            closed,
        ),
    )


def _ratio(top: ArrayLike, bottom: Array) -> Array:
    """Return a bound top/bottom, ``inf`` where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(top / np.maximum(bottom, 0.0))


def _peak(transfer: LoopTransfer, poles: ComplexArray, kind: _Kind) -> FrequencyPeak:
    if transfer.num.size == 0:  # no feedback at all
        return FrequencyPeak(float(kind.magnitude(np.zeros(1, dtype=complex))[0]), 0.0)
    if transfer.feedthrough and transfer.is_polynomial:
        return _rational_peak(transfer, poles, kind)
    end = transfer.beyond(1.0 - LOW_GAIN * (1.0 - transfer.feedthrough))
    best = _highest_on(transfer, kind, *_curve(transfer, poles, end))
    # Extend the band until the bound on the rest is below the best peak, or the limit at infinity is the supremum.
    limit = transfer.limit_curve.highest(kind.magnitude)
    for start, stop in bands_beyond(transfer, end):
        if _bound_beyond(transfer, kind, start) <= max(best.value, limit) * (1.0 + ROUNDING):
            break
        best = _highest(best, _highest_on(transfer, kind, *_curve(transfer, poles, stop, start)))
    return _with_ends(transfer, kind, best, limit)


def _bound_beyond(transfer: LoopTransfer, kind: _Kind, w: float) -> float:
    off = transfer.off_limit(w)
    return transfer.limit_curve.highest(lambda value: kind.bound(value, off))


def _rational_peak(transfer: LoopTransfer, poles: ComplexArray, kind: _Kind) -> FrequencyPeak:
    """Return the peak of a loop without dead time whose gain does not vanish at infinite frequency."""
    # beyond its last stationary point the magnitude is monotone and tends to its limit
    stationary = stationary_frequencies(*kind.ratio)
    end = 2.0 * max([*stationary.tolist(), *np.abs(transfer.corner_frequencies).tolist()], default=1.0)
    best = _highest_on(transfer, kind, *_curve(transfer, poles, end))
    return _with_ends(transfer, kind, best, transfer.limit_curve.highest(kind.magnitude))


def _with_ends(transfer: LoopTransfer, kind: _Kind, best: FrequencyPeak, limit: float) -> FrequencyPeak:
    """Return the highest of a peak and the values at rest and in the limit of infinite frequency."""
    at_rest = _at_rest(transfer, kind)
    if at_rest >= best.value:
        best = FrequencyPeak(at_rest, 0.0)
    if limit > best.value:
        if not transfer.limit_curve.reached:
            transfer.limit_curve.refuse(kind.name)
        best = FrequencyPeak(limit, float("inf"))
    return best


def _at_rest(transfer: LoopTransfer, kind: _Kind) -> float:
    if transfer.infinite_at_rest:  # S = 0, T = 1
        return kind.at_infinite_gain
    at_rest = float(kind.magnitude(transfer(np.zeros(1)))[0])
    return at_rest if np.isfinite(at_rest) else 0.0


def _curve(transfer: LoopTransfer, poles: ComplexArray, end: float, start: float = 0.0) -> tuple[Array, ComplexArray]:
    """Return the frequencies of a peak grid and L there; the peaks of S and T of a loop share them."""
    known = transfer.__dict__.setdefault("curves", {})
    key = (start, end, poles.tobytes())
    if key not in known:
        w = peak_grid(transfer, end, poles, start)
        known[key] = w, transfer(1j * w)
    return known[key]  # type: ignore[no-any-return]


def _highest_on(transfer: LoopTransfer, kind: _Kind, w: Array, value: ComplexArray) -> FrequencyPeak:
    def magnitude(w: Array) -> Array:
        return kind.magnitude(transfer(1j * w))

    return highest_peak(magnitude, kind.slope, w, kind.magnitude(value))


def highest_peak(
    magnitude: Callable[[Array], Array], slope: Callable[[float], float], w: Array, known: Array | None = None
) -> FrequencyPeak:
    """Return the highest peak of a magnitude on ascending frequencies, polished between them.

    ``slope(w)`` has the sign of the magnitude's derivative; ``known`` is the magnitude at the frequencies.
    """
    m = magnitude(w) if known is None else known
    inner = np.nonzero((m[1:-1] >= m[:-2]) & (m[1:-1] >= m[2:]))[0] + 1
    # A peak in the first or last interval can hide behind the end point: then the slope there points inwards.
    brackets = [(w[0], w[1], w[0]), (w[-2], w[-1], w[-1])] if w.size > 1 else []
    # polishing gains little on a grid this fine: only the highest few can win, and of these the steep ones
    reach = m[inner] + STEEP * (m[inner] - np.minimum(m[inner - 1], m[inner + 1]))
    inner = inner[reach >= np.max(m[inner], initial=0.0)]
    brackets += [(w[i - 1], w[i + 1], w[i]) for i in inner[np.argsort(-m[inner])][:6]]
    frequencies = [_polish(slope, float(left), float(start), float(right)) for left, right, start in brackets]
    heights = magnitude(np.array(frequencies)).tolist()
    ends = [(float(m[0]), float(w[0])), (float(m[-1]), float(w[-1]))]
    return _highest(*(FrequencyPeak(*peak) for peak in [*ends, *zip(heights, frequencies, strict=True)]))


def _highest(*peaks: FrequencyPeak) -> FrequencyPeak:
    """Return the highest peak; of several that are equal up to rounding the frequency of the lowest."""
    value = max(float(peak) for peak in peaks)
    return FrequencyPeak(value, min(peak.frequency for peak in peaks if float(peak) >= value * (1.0 - TIE)))


def _polish(slope: Callable[[float], float], left: float, middle: float, right: float) -> float:
    if slope(left) > 0.0 > slope(right):
        return float(brentq(slope, left, right, xtol=1e-300, rtol=8.9e-16, maxiter=200))
    return middle

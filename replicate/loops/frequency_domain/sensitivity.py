r"""Peaks of the sensitivity S = 1/(1+L) and the complementary sensitivity T = L/(1+L).

A peak is found on a grid that resolves every resonance and dead-time rotation and polished by bracketing the root of
the derivative of log|1+L|. The band is cut where :math:`|S| \le 1/(1-|L|)` proves that nothing beyond can exceed the
peak found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.loops.frequency_domain.frequency_grids import peak_grid
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer, stationary_frequencies
from replicate.loops.numerics.peaks import FrequencyPeak

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

LOW_GAIN = 0.75  # share of the way down from |L| = 1 to its limit, beyond which few loops have their peak
STEEP = 10.0  # times what a peak stands above its neighbours on the grid: more than polishing adds to it
TIE = 1e-9  # a design at two tangencies makes two peaks equal to within its own convergence


@dataclass(frozen=True)
class _Kind:
    """Magnitude of S or T given L, the slope of its logarithm in w, a bound from |L|, and the ratio that it is."""

    magnitude: Callable[[ComplexArray], Array]
    slope: Callable[[float], float]
    bound: Callable[[float], float]
    at_infinite_gain: float
    ratio: tuple[Array, Array]  # of the rational part; the magnitude itself if there is no dead time


def sensitivity_peak(transfer: LoopTransfer, poles: ComplexArray, center: float = 1.0) -> FrequencyPeak:
    """Return max 1/|center + L| of a stable loop; with center 1 this is Ms.

    For any center >= 1 its inverse is the distance of the Nyquist curve from the point -center. ``poles`` (closed loop)
    show where narrow peaks are.
    """

    def slope(w: float) -> float:
        value = complex(transfer(1j * w))
        return float((-1j * value * complex(transfer.log_derivative(1j * w)) / (center + value)).real)

    kind = _Kind(
        lambda value: np.abs(1.0 / (center + value)),
        slope,
        lambda gain: 1.0 / (center - gain),
        0.0,
        (transfer.den, np.asarray(np.polyadd(center * transfer.den, transfer.num), dtype=float)),
    )
    return _peak(transfer, poles, kind)


def complementary_peak(transfer: LoopTransfer, poles: ComplexArray) -> FrequencyPeak:
    """Return Mp = max |L/(1+L)| of a stable loop."""

    def slope(w: float) -> float:
        value = complex(transfer(1j * w))
        return float((1j * complex(transfer.log_derivative(1j * w)) / (1.0 + value)).real)

    closed = (transfer.num, np.asarray(np.polyadd(transfer.den, transfer.num), dtype=float))
    return _peak(
        transfer,
        poles,
        _Kind(lambda value: np.abs(value / (1.0 + value)), slope, lambda gain: gain / (1.0 - gain), 1.0, closed),
    )


def _peak(transfer: LoopTransfer, poles: ComplexArray, kind: _Kind) -> FrequencyPeak:
    if transfer.num.size == 0:  # no feedback at all
        return FrequencyPeak(kind.bound(0.0), 0.0)
    if transfer.feedthrough and transfer.is_polynomial:
        return _rational_peak(transfer, poles, kind)
    end = transfer.beyond(1.0 - LOW_GAIN * (1.0 - transfer.feedthrough))
    best = _highest_on(transfer, kind, *_curve(transfer, poles, end))
    # Extend the band until the bound on the rest is below the best peak, or the limit at infinity is the supremum.
    limit = kind.bound(transfer.feedthrough)
    for _ in range(40):
        if kind.bound(float(abs(transfer(1j * end)))) <= max(best.value, limit):
            break
        wider = end * 1.5
        best = _highest(best, _highest_on(transfer, kind, *_curve(transfer, poles, wider, start=0.98 * end)))
        end = wider
    return _with_ends(transfer, kind, best, limit)


def _rational_peak(transfer: LoopTransfer, poles: ComplexArray, kind: _Kind) -> FrequencyPeak:
    """Return the peak of a loop without dead time whose gain does not vanish at infinite frequency."""
    # beyond its last stationary point the magnitude is monotone and tends to its limit
    stationary = stationary_frequencies(*kind.ratio)
    end = 2.0 * max([*stationary.tolist(), *np.abs(transfer.corner_frequencies).tolist()], default=1.0)
    best = _highest_on(transfer, kind, *_curve(transfer, poles, end))
    num, den = kind.ratio
    limit = float(abs(num[0] / den[0])) if num.size == den.size else 0.0
    return _with_ends(transfer, kind, best, limit)


def _with_ends(transfer: LoopTransfer, kind: _Kind, best: FrequencyPeak, limit: float) -> FrequencyPeak:
    """Return the highest of a peak and the values at rest and in the limit of infinite frequency."""
    at_rest = _at_rest(transfer, kind)
    if at_rest >= best.value:
        best = FrequencyPeak(at_rest, 0.0)
    if limit > best.value:
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
    found = [FrequencyPeak(float(m[0]), float(w[0])), FrequencyPeak(float(m[-1]), float(w[-1]))]
    # A peak in the first or last interval can hide behind the end point: then the slope there points inwards.
    brackets = [(w[0], w[1], w[0]), (w[-2], w[-1], w[-1])] if w.size > 1 else []
    # polishing gains little on a grid this fine: only the highest few can win, and of these the steep ones
    reach = m[inner] + STEEP * (m[inner] - np.minimum(m[inner - 1], m[inner + 1]))
    inner = inner[reach >= np.max(m[inner], initial=0.0)]
    brackets += [(w[i - 1], w[i + 1], w[i]) for i in inner[np.argsort(-m[inner])][:6]]
    for left, right, start in brackets:
        frequency = _polish(slope, float(left), float(start), float(right))
        found.append(FrequencyPeak(float(magnitude(np.array([frequency]))[0]), frequency))
    return _highest(*found)


def _highest(*peaks: FrequencyPeak) -> FrequencyPeak:
    """Return the highest peak; of several that are equal up to rounding the frequency of the lowest."""
    value = max(float(peak) for peak in peaks)
    return FrequencyPeak(value, min(peak.frequency for peak in peaks if float(peak) >= value * (1.0 - TIE)))


def _polish(slope: Callable[[float], float], left: float, middle: float, right: float) -> float:
    if slope(left) > 0.0 > slope(right):
        return float(brentq(slope, left, right, xtol=1e-300, rtol=8.9e-16, maxiter=200))
    return middle

r"""Between what the responses of all loops run whose gains lie in a box: when they settle, peak, reach a level.

Let :math:`f` be the response of the loop in the middle of the box to something that the gains do not change: the load
response, or the error after a set-point step with full set-point weight. For other gains it satisfies
:math:`f' = f - h * f'` with :math:`h` the impulse response of :math:`P S \Delta C` (see `gain_boxes`). With :math:`y`
the response to a unit load step and any rate :math:`a \ge 0` for which the middle loop decays faster than
:math:`e^{-at}`, let

.. math::

    \eta = |\Delta k| \int e^{at} |\dot y| \, dt + |\Delta k_i| \int e^{at} |y| \, dt
           + |\Delta k_d| \int e^{at} |\ddot y| \, dt .

If :math:`\eta < 1`, all loops of the box are stable, and by the small-gain theorem with exponential weights

.. math::

    |f'(t) - f(t)| \le \frac{\eta}{1 - \eta} \, \max_s e^{as} |f(s)| \; e^{-at} .

The smallest of these bounds for several rates is taken: a large one says more of the end of the response.

References
----------
C. A. Desoer and M. Vidyasagar, *Feedback Systems: Input-Output Properties*, Academic Press, 1975, ch. III and V.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.bounds.intervals import Interval
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant
from replicate.loops.time_domain.piecewise import Piecewise
from replicate.loops.time_domain.signal import Signal

Array = NDArray[np.float64]

_RATES = (0.0, 8.0, 16.0)  # powers of e over a horizon, at whose end a response has decayed to rounding, e^-34
_OWN_ERROR = 1e-6  # relative, more than the error of the weighted integrals
_STEPS = 24  # parts of a piece on which a response is bounded
_FINE = 64  # parts of an interval in which it must not cross a level
_ZOOMS = 3  # into the interval in which a level is reached
_OVER_SAMPLES = 1.09  # a polynomial of degree n is nowhere larger than this times its largest of 4 n Chebyshev samples


@dataclass(frozen=True)
class ResponseBox:
    """A response of all loops of a box: that of the middle one, and how far the others are from it at most.

    Attributes
    ----------
    middle
        The response of the loop in the middle of the box; it ends at zero.
    bounds
        Rates and sizes: no response is farther from it than ``size exp(-rate t)``, for each of them.
    """

    middle: Signal
    bounds: tuple[tuple[float, float], ...]

    def spread(self, t: ArrayLike) -> Array:
        """Return how far from the middle one the responses are at most, at times t."""
        times = np.asarray(t, dtype=float)
        return np.asarray(np.min([size * np.exp(-rate * times) for rate, size in self.bounds], axis=0))

    def between(self, edges: Array) -> tuple[Array, Array]:
        """Return the lower and upper ends of all responses in the intervals between neighbouring times."""
        starts, ends = edges[:-1], edges[1:]
        around = self.spread(starts) + 0.5 * (ends - starts) * self._steepest(starts, ends)
        values = self.middle(0.5 * (starts + ends))
        return values - around, values + around

    def never_settles_between(self, low: float, high: float, level: float, *, one_sided: bool = False) -> bool:
        """Say whether certainly no response stays within a level, for good, from a time in an interval on.

        Parameters
        ----------
        low, high
            The interval; positive times.
        level
            What the response must stay below.
        one_sided
            Whether it may be as far below zero as it likes.

        Examples
        --------
        >>> plant = Plant([1.0], [1.0, 3.0, 3.0, 1.0])
        >>> found = load_responses(plant, GainBox(Interval(0.860, 0.862), Interval(0.459, 0.461)))
        >>> settled = Loop(plant, GainBox(Interval(0.861, 0.861), Interval(0.46, 0.46)).middle).load_step()
        >>> time = settled.settling_time(0.02)
        >>> [found.never_settles_between(factor * time, (factor + 0.01) * time, 0.02) for factor in (0.9, 0.995, 1.1)]
        [True, False, True]
        """
        later = np.linspace(high, max(self.middle.horizon, high), _STEPS * len(self.middle.breaks))[1:]
        values = self.middle(later)
        if np.any((values if one_sided else np.abs(values)) - self.spread(later) > level):
            return True  # outside once more, after the interval
        lower, upper = self.between(np.linspace(low, high, _FINE + 1))
        inside = (upper < level) if one_sided else (upper < level) & (lower > -level)
        outside = (lower > level) if one_sided else (lower > level) | (upper < -level)
        return bool(np.all(inside | outside))

    def trough(self) -> Interval:
        """Return an interval that holds the smallest value of every response."""
        lower, _ = self.between(self._edges())
        lowest = self.middle.trough()
        time = lowest.time if np.isfinite(lowest.time) else self.middle.horizon
        return Interval(float(lower.min()), float(lowest.value + self.spread(time)))

    def first_below(self, level: float) -> Interval:
        """Return an interval that holds the time at which every response is first at a level or below it."""
        edges, low, high = self._edges(), 0.0, np.inf
        for _ in range(_ZOOMS):
            lower, _ = self.between(edges)
            reached = np.nonzero(lower <= level)[0]
            certain = np.nonzero(self.middle(edges) + self.spread(edges) <= level)[0]
            low = float(edges[reached[0]]) if reached.size else np.inf
            high = float(edges[certain[0]]) if certain.size else np.inf
            if not low < high < np.inf:
                break
            edges = np.linspace(low, high, _FINE + 1)
        return Interval(low, high)

    def _edges(self) -> Array:
        breaks = self.middle.breaks
        steps = np.diff(breaks)[:, None] * np.arange(_STEPS) / _STEPS
        return np.append((breaks[:-1, None] + steps).ravel(), breaks[-1])

    def _steepest(self, starts: Array, ends: Array) -> Array:
        """Return a bound on the slope of the middle response in each of some intervals."""
        breaks, sizes = self.middle.breaks, _sizes(self.middle.derivative())
        first = np.clip(np.searchsorted(breaks, starts, side="right") - 1, 0, sizes.size - 1)
        last = np.clip(np.searchsorted(breaks, ends, side="left") - 1, 0, sizes.size - 1)
        return np.array([sizes[a : b + 1].max() for a, b in zip(first, np.maximum(first, last), strict=True)])


@lru_cache(maxsize=4096)
def load_responses(plant: Plant, box: GainBox) -> ResponseBox | None:
    """Return the responses to a unit load step for all controllers of a box; ``None`` where it is too large to tell.

    Parameters
    ----------
    plant
        Any plant; the load enters before it.
    box
        The controllers, without a filter.

    Raises
    ------
    ValueError
        If the box has a filter.
    """
    return _responses(plant, box, Loop.load_step)


@lru_cache(maxsize=4096)
def setpoint_errors(plant: Plant, box: GainBox) -> ResponseBox | None:
    """Return the errors after a unit set-point step with set-point weight 1; else as `load_responses`."""

    def error(loop: Loop) -> Signal:
        step = loop.step()
        coefficients = -step.coefficients
        coefficients[:, 0] += 1.0
        return Signal(step.breaks, coefficients, final=0.0)

    return _responses(plant, box, error)


def _responses(plant: Plant, box: GainBox, response: Callable[[Loop], Signal]) -> ResponseBox | None:
    if box.order:
        msg = "the box has a measurement filter; allowed: none"
        raise ValueError(msg)
    loop = Loop(plant, box.middle)
    try:
        if not loop.is_stable():
            return None
        load, middle = loop.load_step(), response(loop)
    except LoopError:
        return None
    slope = load.derivative()
    bend = slope.derivative()
    bounds = []
    for rate in (power / load.horizon for power in _RATES):
        norms = (
            (box.k.reach, _weighted(slope, rate)),
            (box.ki.reach, _weighted(load, rate)),
            (box.kd.reach, _weighted(bend, rate) + _jumps(slope, rate)),
        )
        gain = sum(reach * norm for reach, norm in norms if reach) * (1.0 + _OWN_ERROR)
        if gain < 1.0:
            largest = float(np.max(_sizes(middle) * np.exp(rate * middle.breaks[1:])))
            bounds.append((rate, gain / (1.0 - gain) * largest * (1.0 + _OWN_ERROR)))
    return ResponseBox(middle, tuple(bounds)) if bounds else None


def _weighted(signal: Piecewise, rate: float) -> float:
    """Return a bound on the integral of ``exp(rate t) |signal|``, by Cauchy and Schwarz on every piece."""
    points, weights = chebyshev.gauss_legendre(signal.degree + 8)
    lengths = np.diff(signal.breaks)
    times = signal.breaks[:-1, None] + 0.5 * lengths[:, None] * (points + 1.0)
    values = signal.coefficients @ chebyshev.basis(points, signal.degree)
    squares = 0.5 * lengths * ((values * np.exp(rate * times)) ** 2 @ weights)
    return float(np.sum(np.sqrt(lengths * squares)))


def _jumps(signal: Piecewise, rate: float) -> float:
    """Return the sum of the jumps of a signal that is zero before t = 0, with their weights."""
    signs = (-1.0) ** np.arange(signal.degree + 1)
    starts, ends = signal.coefficients @ signs, signal.coefficients.sum(axis=1)
    heights = np.abs(starts - np.append(0.0, ends[:-1]))
    return float(np.sum(heights * np.exp(rate * signal.breaks[:-1])))


def _sizes(signal: Piecewise) -> Array:
    """Return a bound on the size of a signal in each of its pieces."""
    points = chebyshev.nodes(4 * max(signal.degree, 1))
    samples = np.abs(signal.coefficients @ chebyshev.basis(points, signal.degree))
    return np.asarray(_OVER_SAMPLES * samples.max(axis=1))

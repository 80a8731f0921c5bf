"""A function of time as an object: a piecewise Chebyshev series.

It is evaluated, differentiated, integrated and searched for extrema and crossings as the piecewise polynomial it is;
nothing is read from a sample grid. Samples serve only to find the pieces worth a root search.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, partial
from typing import Self

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError, NotSettledError
from replicate.loops.numerics import chebyshev, one_series
from replicate.loops.numerics.peaks import Peak
from replicate.loops.set_once import SetOnce

Array = NDArray[np.float64]

# An extremum between two samples of a degree-18 piece exceeds them by far less than this fraction of the
# signal's range.
SAMPLES = 40
MARGIN = 0.02
FLAT = 1e-14  # of the largest value: a piece that moves less is constant to rounding
NOISE = 1e-13  # of the largest value: a move or a jump that is rounding
SAME = 1e-12  # relative distance of two times that are one
BEFORE = 1e-13  # and of a break from the end of a sum that it does not coincide with
NEGLIGIBLE = 1e-17  # of the largest coefficient: one that no value shows


class Piecewise(SetOnce):
    """A function on [0, horizon] as a piecewise Chebyshev series.

    Parameters
    ----------
    breaks : array, shape (pieces + 1,)
        Ascending times of the pieces' ends; kinks and jumps lie only there.
    coefficients : array, shape (pieces, degree + 1)
        Chebyshev coefficients of each piece on its own interval.
    final : float
        The steady-state value that the metrics refer to (``nan`` if there is none).
    stable : callable, optional
        Called when a metric needs to know whether the response settles at all.
    """

    def __init__(
        self,
        breaks: Array,
        coefficients: Array,
        *,
        final: float = float("nan"),
        stable: Callable[[], bool] | None = None,
    ) -> None:
        self.breaks = np.asarray(breaks, dtype=float).view()
        self.coefficients = np.asarray(coefficients, dtype=float).view()
        self.breaks.flags.writeable = self.coefficients.flags.writeable = False
        self.final = float(final)
        self.stable = stable

    def __getstate__(self) -> dict[str, object]:
        """Keep of the loop only whether it is stable."""
        return {**super().__getstate__(), "stable": self.stable and partial(bool, self.stable())}

    # ---- a function -----------------------------------------------------------------------------------------------

    @property
    def horizon(self) -> float:
        """The end of the time axis."""
        return float(self.breaks[-1])

    @property
    def degree(self) -> int:
        """The polynomial degree of the pieces."""
        return int(self.coefficients.shape[1] - 1)

    def __call__(self, t: ArrayLike) -> Array:
        """Evaluate at times ``t`` of any shape; zero before the step, the right-hand value at a jump.

        Raises
        ------
        LoopError
            If a time lies beyond the horizon.
        """
        times = checks.times("the times", t)
        end = self.breaks[-1]
        flat = np.maximum(np.atleast_1d(times).ravel(), -end)  # before the step all times are alike
        if np.isnan(flat).any():
            msg = "a time is not a number (nan)"
            raise LoopError(msg)
        if flat.size and flat.max() > end * (1.0 + SAME):
            msg = f"t = {flat.max():g} lies beyond the response's horizon of {end:g}: compute a longer one"
            raise LoopError(msg)
        index = self._piece_index(flat)
        start = self.breaks[index]
        x = 2.0 * (flat - start) / self._lengths[index] - 1.0
        significant = self._significant
        table = chebyshev.basis(np.clip(x, -1.0, 1.0), significant.shape[0] - 1)
        values = np.zeros_like(flat)
        for polynomial, column in zip(table, significant, strict=True):
            values += polynomial * column[index]
        if flat.size and flat.min() < 0.0:
            values[flat < 0.0] = 0.0
        return np.asarray(values.reshape(times.shape))

    @cached_property
    def _lengths(self) -> Array:
        return np.diff(self.breaks)

    @cached_property
    def _significant(self) -> Array:
        """Coefficients as rows, without the highest orders that no piece needs: evaluation is faster without them."""
        size = np.max(np.abs(self.coefficients), axis=0)
        last = np.nonzero(size > NEGLIGIBLE * size.max(initial=0.0))[0]
        return np.ascontiguousarray(self.coefficients[:, : (last[-1] + 1 if last.size else 1)].T)

    @cached_property
    def _uniform(self) -> float:
        inner = self._lengths[:-1]
        if inner.size and np.ptp(inner) < SAME * inner[0]:
            return float(inner[0])
        return 0.0

    def _piece_index(self, t: Array) -> NDArray[np.intp]:
        last = self.breaks.size - 2
        if self._uniform:
            index = np.clip((t / self._uniform).astype(np.intp), 0, last)
            # a time within rounding of a break belongs to the piece that starts there
            ahead = np.minimum(index + 1, last)
            return np.where((t >= self.breaks[ahead]) & (ahead > index), ahead, index)
        return np.clip(np.searchsorted(self.breaks, t, side="right") - 1, 0, last)

    def derivative(self) -> Self:
        """Return the derivative inside the pieces (jumps at breaks are not differentiated)."""
        coefficients = cheb.chebder(self.coefficients, axis=1) * (2.0 / self._lengths)[:, None]
        return type(self)(self.breaks, coefficients, final=0.0, stable=self.stable)

    def antiderivative(self) -> Self:
        """Return the running integral from t = 0."""
        half = 0.5 * self._lengths
        inner = cheb.chebint(self.coefficients, lbnd=-1.0, axis=1) * half[:, None]
        starts = np.concatenate([[0.0], np.cumsum(self._piece_integrals(self.coefficients))[:-1]])
        inner[:, 0] += starts
        return type(self)(self.breaks, inner, stable=self.stable)

    def delayed(self, delay: float) -> Self:
        """Return the signal shifted to start at t = ``delay`` >= 0, zero before."""
        delay = checks.non_negative("the delay of a response", delay, allowed="a time >= 0")
        if delay == 0.0:
            return self
        zero = np.zeros((1, self.coefficients.shape[1]))
        breaks = np.concatenate([[0.0], self.breaks + delay])
        return type(self)(breaks, np.concatenate([zero, self.coefficients]), final=self.final, stable=self.stable)

    def __add__(self, other: Self) -> Self:
        """Superpose two responses on the common part of their horizons."""
        if not isinstance(other, Piecewise):
            return NotImplemented
        end = min(self.horizon, other.horizon)
        breaks = np.union1d(self.breaks, other.breaks)
        breaks = breaks[breaks < end * (1.0 - BEFORE)]
        keep = np.concatenate([[True], np.diff(breaks) > SAME * breaks[1:]])
        breaks = np.append(breaks[keep], end)
        degree = max(self.degree, other.degree)
        values = self._resampled(breaks, degree) + other._resampled(breaks, degree)
        coefficients = values @ chebyshev.values_to_coefficients(degree).T
        kind = type(other) if isinstance(other, type(self)) else type(self)  # the more particular of the two
        return kind(breaks, coefficients, final=self.final + other.final, stable=self.stable)

    def __mul__(self, factor: float) -> Self:
        """Scale the response."""
        factor = checks.finite("the factor of a response", factor)
        return type(self)(self.breaks, self.coefficients * factor, final=self.final * factor, stable=self.stable)

    __rmul__ = __mul__

    def _resampled(self, breaks: Array, degree: int) -> Array:
        middle = 0.5 * (breaks[1:] + breaks[:-1])
        index = self._piece_index(middle)
        t = middle[:, None] + 0.5 * np.diff(breaks)[:, None] * chebyshev.nodes(degree)
        x = 2.0 * (t - self.breaks[index][:, None]) / self._lengths[index][:, None] - 1.0
        table = chebyshev.basis(np.clip(x, -1.0, 1.0).ravel(), self.degree).reshape(self.degree + 1, *x.shape)
        return np.asarray(np.einsum("kpn,pk->pn", table, self.coefficients[index]))

    # ---- extrema and crossings ------------------------------------------------------------------------------------

    @cached_property
    def _samples(self) -> Array:
        return self.coefficients @ chebyshev.evaluation(self.degree, SAMPLES)

    @property
    def _excess(self) -> float:
        """How far a polynomial may exceed its samples, as a fraction of their range (Ehlich and Zeller, 1964)."""
        degree = min(self.degree, SAMPLES - 4)
        return 0.5 / math.cos(0.5 * math.pi * degree / (SAMPLES - 1)) - 0.5

    def _time(self, piece: int, x: float) -> float:
        return float(self.breaks[piece] + 0.5 * (x + 1.0) * self._lengths[piece])

    def _extreme(self, sign: float) -> Peak:
        samples = sign * self._samples
        highest = samples.max(axis=1)
        scale = float(np.max(np.abs(self._samples)))
        reserve = self._excess * (highest - samples.min(axis=1))
        level = highest.max() - FLAT * scale
        candidates = np.nonzero(highest + reserve >= level)[0]
        # the settled tail of a slow loop is thousands of pieces that are constant to rounding: their samples say it all
        flat = np.ptp(samples[candidates], axis=1) <= FLAT * scale
        tail, candidates = candidates[flat], candidates[~flat]
        found = self._summits(samples, candidates, sign, level - reserve[candidates])
        if tail.size:
            place = int(tail[np.argmax(highest[tail] >= level)])
            found.append((float(highest[place]), self._time(place, -1.0)))
        value = max((value for value, _ in found), default=-np.inf)
        # of values that are one to rounding the first counts
        times = (time for other, time in found if other >= value - FLAT * scale)
        return Peak(sign * value, min(times, default=float("nan")))

    def _summits(
        self, samples: Array, pieces: NDArray[np.intp], sign: float, level: Array
    ) -> list[tuple[float, float]]:
        """Return (sign * value, time) of the maxima in some pieces whose samples reach a level, ends included."""
        part = samples[pieces]
        top = part >= level[:, None]
        top[:, 1:] &= part[:, 1:] >= part[:, :-1]
        top[:, :-1] &= part[:, :-1] >= part[:, 1:]
        rows, places = np.nonzero(top)
        nodes, found = chebyshev.nodes(SAMPLES - 1).tolist(), []
        for row, place in zip(rows.tolist(), places.tolist(), strict=True):
            piece, sampled = int(pieces[row]), float(part[row, place])
            series = (sign * self.coefficients[piece]).tolist()
            x = one_series.maximum(series, nodes[max(place - 1, 0)], nodes[min(place + 1, SAMPLES - 1)])
            reached = one_series.value(series, x)
            # at rounding level the polynomial and its sample differ by nothing
            found.append((max(reached, sampled), self._time(piece, x if reached > sampled else nodes[place])))
        return found

    def peak(self) -> Peak:
        """Return the largest value on [0, horizon]; its ``.time`` is where it is reached."""
        return self._extreme(1.0)

    def trough(self) -> Peak:
        """Return the smallest value on [0, horizon]; its ``.time`` is where it is reached."""
        return self._extreme(-1.0)

    def extrema(self) -> list[Peak]:
        """Return all local extrema inside (0, horizon), in order of time, kinks and jumps at breaks included.

        Of an extremum that lasts, the beginning is returned.
        """
        slopes = self.coefficients @ chebyshev.differentiation(self.degree)
        sampled = slopes @ chebyshev.evaluation(self.degree - 1, SAMPLES)
        turning = (sampled.min(axis=1) <= 0.0) & (sampled.max(axis=1) >= 0.0)
        negligible = NOISE * float(np.max(np.abs(self._samples)))
        turning &= np.ptp(self._samples, axis=1) > negligible
        found: list[Peak] = []
        last = Peak(float(self._samples[0, 0]), 0.0)  # where the last move that counts has ended
        rising: bool | None = None
        for piece in range(self._samples.shape[0]):
            places = np.array([-1.0, 1.0])
            if turning[piece]:
                places = np.unique([-1.0, *chebyshev.real_roots(slopes[piece]), 1.0])
            values = cheb.chebval(places, self.coefficients[piece])
            # the first move is the jump from the piece before
            for value, x in zip(values.tolist(), places.tolist(), strict=True):
                move = value - float(last)
                if abs(move) <= negligible:
                    continue
                if rising is not None and (move > 0.0) != rising:
                    found.append(last)
                rising = move > 0.0
                last = Peak(value, self._time(piece, x))
        return found

    def crossings(self, level: float) -> Array:
        """Return all times at which the response crosses ``level``, jumps included, ascending."""
        level = checks.finite("the level", level)
        times = [time for piece in self._pieces_at(level) for time in self._crossings_in(piece, level)]
        merged = np.sort(np.concatenate([times, self._jumps_across(level)]))
        if merged.size > 1:  # a crossing exactly at a break is found from both sides
            merged = merged[np.concatenate([[True], np.diff(merged) > SAME * merged[1:]])]
        return merged

    def last_crossing(self, level: float) -> float:
        """Return the last time at which the response crosses ``level``, jumps included; 0 if it never does."""
        level = checks.finite("the level", level)
        within = (self._crossings_in(piece, level) for piece in reversed(self._pieces_at(level)))
        last = next((times[-1] for times in within if times), 0.0)
        return max(last, float(self._jumps_across(level).max(initial=0.0)))

    def _pieces_at(self, level: float) -> list[int]:
        """Return the pieces that may cross a level."""
        low, high = self._samples.min(axis=1), self._samples.max(axis=1)
        slack = MARGIN * (high - low)
        return list(np.nonzero((low - slack <= level) & (high + slack >= level) & (high > low))[0].tolist())

    def _crossings_in(self, piece: int, level: float) -> list[float]:
        return [self._time(piece, x) for x in self._crossing_roots(piece, level)]

    def _jumps_across(self, level: float) -> Array:
        """Return the breaks at which the response jumps across a level."""
        ends, starts = self._samples[:-1, -1] - level, self._samples[1:, 0] - level
        negligible = NOISE * float(np.max(np.abs(self._samples)))
        return self.breaks[1:-1][(ends * starts < 0.0) & (np.abs(ends - starts) > negligible)]

    def _crossing_roots(self, piece: int, level: float) -> Array:
        series = self.coefficients[piece].copy()
        series[0] -= level
        return one_series.roots(series, self._samples[piece] - level, MARGIN)

    def first_reach(self, level: float) -> float:
        """Return the first time at which the response is at or beyond ``level``, coming from zero.

        Raises
        ------
        NotSettledError
            If the level is not reached inside the horizon.
        """
        level = checks.finite("the level", level)
        sign = 1.0 if level >= 0.0 else -1.0
        target = sign * level
        samples = sign * self._samples
        slack = MARGIN * np.ptp(samples, axis=1)
        for piece in np.nonzero(samples.max(axis=1) + slack >= target)[0]:
            if samples[piece, 0] >= target:
                return float(self.breaks[piece])
            roots = self._crossing_roots(int(piece), level)
            if roots.size:
                return self._time(int(piece), float(roots[0]))
        msg = f"the response does not reach {level:g} by t = {self.horizon:g}; compute a longer one"
        raise NotSettledError(msg)

    # ---- integral ------------------------------------------------------------------------------------------

    def integral(self) -> float:
        """Return the integral of the signal itself over [0, horizon]."""
        return float(np.sum(self._piece_integrals(self.coefficients)))

    def _piece_integrals(self, coefficients: Array) -> Array:
        order = np.arange(0, coefficients.shape[1], 2)
        return np.asarray(coefficients[:, ::2] @ (2.0 / (1.0 - order**2)) * (0.5 * self._lengths))

"""A time response as an object: piecewise polynomial, exact metrics.

A `Signal` is evaluated, differentiated, integrated and searched for extrema and crossings as the piecewise Chebyshev
series it is; nothing is read from a sample grid. Samples serve only to find the pieces worth a root search.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import ArrayLike, NDArray

from replicate.loops import chebyshev
from replicate.loops.errors import LoopError, NotSettledError, UnstableLoopError

Array = NDArray[np.float64]

# An extremum between two samples of a degree-18 piece exceeds them by far less than this fraction of the
# signal's range.
SAMPLES = 40
MARGIN = 0.02
ROUNDING = 5e-14  # a response that exceeds its final value by less does so by rounding only


class Peak(float):
    """The value of an extremum; a float that also knows where it is.

    Attributes
    ----------
    value : float
        The extremum itself.
    time : float
        When it is reached.
    """

    time: float

    def __new__(cls, value: float, time: float) -> Peak:
        """Return the extremum with its time."""
        peak = super().__new__(cls, value)
        peak.time = time
        return peak

    @property
    def value(self) -> float:
        """The extremum as a plain float."""
        return float(self)

    def __getnewargs__(self) -> tuple[float, float]:  # type: ignore[override]
        return float(self), self.time


class Signal:
    """A response on [0, horizon] as a piecewise Chebyshev series.

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

    Notes
    -----
    Times count from the step, dead time included. Overshoot is a fraction of the final value. Where the final value is
    zero (load responses) bands are absolute, as fractions of the unit step.
    """

    def __init__(
        self,
        breaks: Array,
        coefficients: Array,
        *,
        final: float = float("nan"),
        stable: Callable[[], bool] | None = None,
    ) -> None:
        self.breaks = np.asarray(breaks, dtype=float)
        self.coefficients = np.asarray(coefficients, dtype=float)
        self.final = float(final)
        self.stable = stable

    @classmethod
    def from_pieces(
        cls, length: float, coefficients: Array, until: float, *, final: float, stable: Callable[[], bool] | None = None
    ) -> Signal:
        """Return the signal of equally long pieces, the last one cut at ``until``."""
        pieces = coefficients.shape[0]
        breaks = length * np.arange(pieces + 1)
        if until < breaks[-1]:
            coefficients = np.array(coefficients)
            share = (until - breaks[-2]) / length
            degree = coefficients.shape[1] - 1
            inside = cheb.chebval((chebyshev.nodes(degree) + 1.0) * share - 1.0, coefficients[-1])
            coefficients[-1] = chebyshev.values_to_coefficients(degree) @ inside
            breaks[-1] = until
        return cls(breaks, coefficients, final=final, stable=stable)

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
        times = np.asarray(t, dtype=float)
        flat = np.atleast_1d(times).ravel()
        end = self.breaks[-1]
        if np.isnan(flat).any():
            msg = "a time is not a number (nan)"
            raise LoopError(msg)
        if flat.size and flat.max() > end * (1.0 + 1e-12):
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
        last = np.nonzero(size > 1e-17 * size.max(initial=0.0))[0]
        return np.ascontiguousarray(self.coefficients[:, : (last[-1] + 1 if last.size else 1)].T)

    @cached_property
    def _uniform(self) -> float:
        inner = self._lengths[:-1]
        if inner.size and np.ptp(inner) < 1e-12 * inner[0]:
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

    def derivative(self) -> Signal:
        """Return the derivative inside the pieces (jumps at breaks are not differentiated)."""
        coefficients = cheb.chebder(self.coefficients, axis=1) * (2.0 / self._lengths)[:, None]
        return Signal(self.breaks, coefficients, final=0.0, stable=self.stable)

    def antiderivative(self) -> Signal:
        """Return the running integral from t = 0."""
        half = 0.5 * self._lengths
        inner = cheb.chebint(self.coefficients, lbnd=-1.0, axis=1) * half[:, None]
        starts = np.concatenate([[0.0], np.cumsum(self._piece_integrals(self.coefficients))[:-1]])
        inner[:, 0] += starts
        return Signal(self.breaks, inner, stable=self.stable)

    def delayed(self, delay: float) -> Signal:
        """Return the signal shifted to start at t = ``delay`` >= 0, zero before."""
        if delay == 0.0:
            return self
        zero = np.zeros((1, self.coefficients.shape[1]))
        breaks = np.concatenate([[0.0], self.breaks + delay])
        return Signal(breaks, np.concatenate([zero, self.coefficients]), final=self.final, stable=self.stable)

    def __add__(self, other: Signal) -> Signal:
        """Superpose two responses on the common part of their horizons."""
        end = min(self.horizon, other.horizon)
        breaks = np.union1d(self.breaks, other.breaks)
        breaks = breaks[breaks < end * (1.0 - 1e-13)]
        keep = np.concatenate([[True], np.diff(breaks) > 1e-12 * max(end, 1.0)])
        breaks = np.append(breaks[keep], end)
        degree = max(self.degree, other.degree)
        values = self._resampled(breaks, degree) + other._resampled(breaks, degree)
        coefficients = values @ chebyshev.values_to_coefficients(degree).T
        return Signal(breaks, coefficients, final=self.final + other.final, stable=self.stable)

    def __mul__(self, factor: float) -> Signal:
        """Scale the response."""
        return Signal(self.breaks, self.coefficients * factor, final=self.final * factor, stable=self.stable)

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

    def _time(self, piece: int, x: float) -> float:
        return float(self.breaks[piece] + 0.5 * (x + 1.0) * self._lengths[piece])

    def _piece_extrema(self, piece: int) -> list[tuple[float, float]]:
        """Return (value, time) at the ends and at all stationary points of a piece."""
        series = self.coefficients[piece]
        candidates = np.concatenate([[-1.0], chebyshev.real_roots(cheb.chebder(series)), [1.0]])
        return [
            (float(v), self._time(piece, x)) for x, v in zip(candidates, cheb.chebval(candidates, series), strict=True)
        ]

    def _extreme(self, sign: float) -> Peak:
        samples = sign * self._samples
        highest = samples.max(axis=1)
        margin = MARGIN * max(float(np.ptp(self._samples)), 1e-300)
        # only pieces whose neighbourhood of samples comes close to the top can hold the extremum
        spread = np.minimum(np.max(np.abs(np.diff(samples, axis=1)), axis=1), margin)
        candidates = np.nonzero(highest + spread >= highest.max())[0]
        best = Peak(-np.inf, float("nan"))
        for piece in candidates:
            for value, time in self._piece_extrema(int(piece)):
                if sign * value > best:
                    best = Peak(sign * value, time)
        return Peak(sign * float(best), best.time)

    def peak(self) -> Peak:
        """Return the largest value on [0, horizon]; its ``.time`` is where it is reached."""
        return self._extreme(1.0)

    def trough(self) -> Peak:
        """Return the smallest value on [0, horizon]; its ``.time`` is where it is reached."""
        return self._extreme(-1.0)

    def extrema(self) -> list[Peak]:
        """Return all local extrema inside (0, horizon), in order of time."""
        found: list[Peak] = []
        slopes = self.coefficients @ chebyshev.differentiation(self.degree)
        sampled = slopes @ chebyshev.evaluation(self.degree - 1, SAMPLES)
        changes = np.nonzero((sampled.min(axis=1) <= 0.0) & (sampled.max(axis=1) >= 0.0))[0]
        level = 1e-13 * float(np.max(np.abs(self._samples)))
        for piece in changes:
            if np.ptp(self._samples[piece]) <= level:
                continue
            roots = chebyshev.real_roots(slopes[piece])
            found += [Peak(float(cheb.chebval(x, self.coefficients[piece])), self._time(int(piece), x)) for x in roots]
        return found

    def crossings(self, level: float) -> Array:
        """Return all times at which the response crosses ``level``, jumps included, ascending."""
        low, high = self._samples.min(axis=1), self._samples.max(axis=1)
        slack = MARGIN * (high - low)
        times: list[float] = []
        for piece in np.nonzero((low - slack <= level) & (high + slack >= level) & (high > low))[0]:
            roots = self._crossing_roots(int(piece), level)
            times += [self._time(int(piece), x) for x in roots]
        ends, starts = self._samples[:-1, -1] - level, self._samples[1:, 0] - level
        jumps = np.nonzero(ends * starts < 0.0)[0]
        times += [float(self.breaks[j + 1]) for j in jumps if np.abs(ends[j] - starts[j]) > 1e-13]
        merged = np.sort(np.asarray(times))
        if merged.size > 1:  # a crossing exactly at a break is found from both sides
            merged = merged[np.concatenate([[True], np.diff(merged) > 1e-12 * self.horizon])]
        return merged

    def _crossing_roots(self, piece: int, level: float) -> Array:
        series = self.coefficients[piece].copy()
        series[0] -= level
        return chebyshev.real_roots(series)

    def first_reach(self, level: float) -> float:
        """Return the first time at which the response is at or beyond ``level``, coming from zero.

        Raises
        ------
        NotSettledError
            If the level is not reached inside the horizon.
        """
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

    # ---- step metrics ---------------------------------------------------------------------------------------------

    def _require_stable(self, what: str) -> None:
        if self.stable is not None and not self.stable():
            msg = f"an unstable loop has no {what}"
            raise UnstableLoopError(msg)

    def _require_final(self, what: str) -> None:
        if not np.isfinite(self.final) or self.final == 0.0:
            msg = f"{what} is relative to the final value, which is {self.final:g} here"
            raise LoopError(msg)

    def overshoot(self) -> float:
        """Return (peak - final) / final, as a fraction; 0 when the response never exceeds its final value.

        Raises
        ------
        UnstableLoopError
            If the loop is unstable. LoopError: if the final value is zero.
        """
        self._require_stable("overshoot")
        self._require_final("overshoot")
        peak = self._extreme(1.0 if self.final > 0.0 else -1.0)
        excess = (float(peak) - self.final) / self.final
        return excess if excess > ROUNDING else 0.0

    def settling_time(self, band: float = 0.02) -> float:
        """Return the last time at which the response is further than the band from its final value.

        Parameters
        ----------
        band
            Half-width as a fraction of the final value; absolute where the final value is zero (load response).

        Raises
        ------
        UnstableLoopError
            If the loop is unstable.
        NotSettledError
            If the response is outside the band at the end of its horizon.
        """
        self._require_stable("settling time")
        if not 0.0 < band < np.inf:
            msg = f"the settling band must be a positive fraction, not {band}"
            raise LoopError(msg)
        width = band * (abs(self.final) if self.final else 1.0)
        error = np.abs(self._samples - self.final)
        if error[-1, -1] > width:
            msg = f"the response has not settled within {band:g} of {self.final:g} by t = {self.horizon:g}; compute a longer one"  # noqa: E501
            raise NotSettledError(msg)
        near = error.max(axis=1) + MARGIN * np.ptp(self._samples, axis=1) > width
        for piece in np.nonzero(near)[0][::-1]:
            time = self._last_exit(int(piece), width)
            if time is not None:
                return time
        return 0.0

    def _last_exit(self, piece: int, width: float) -> float | None:
        series = self.coefficients[piece].copy()
        series[0] -= self.final
        if abs(cheb.chebval(1.0, series)) > width:
            return self._time(piece, 1.0)
        crossings = np.concatenate(
            [self._crossing_roots(piece, self.final + width), self._crossing_roots(piece, self.final - width)]
        )
        for x in np.sort(crossings)[::-1]:  # the last root beyond which |error| really was larger
            before = max(-1.0, x - 1e-7)
            if abs(cheb.chebval(before, series)) > width:
                return self._time(piece, float(x))
        return None

    def rise_time(self, low: float = 0.1, high: float = 0.9) -> float:
        """Return the time from first reaching ``low`` to first reaching ``high``, fractions of the final value."""
        self._require_stable("rise time")
        self._require_final("rise time")
        if not 0.0 <= low < high:
            msg = f"the rise time runs from a fraction low >= 0 to a larger one, not from {low} to {high}"
            raise LoopError(msg)
        return self.first_reach(high * self.final) - self.first_reach(low * self.final)

    def delay_time(self, fraction: float = 0.5) -> float:
        """Return the first time at which the response reaches ``fraction`` of its final value, dead time included."""
        self._require_stable("delay time")
        self._require_final("delay time")
        if not fraction >= 0.0:
            msg = f"the delay time belongs to a fraction >= 0 of the final value, not to {fraction}"
            raise LoopError(msg)
        return self.first_reach(fraction * self.final)

    # ---- integrals ------------------------------------------------------------------------------------------------

    def integral(self) -> float:
        """Return the integral of the signal itself over [0, horizon]."""
        return float(np.sum(self._piece_integrals(self.coefficients)))

    def _piece_integrals(self, coefficients: Array) -> Array:
        order = np.arange(0, coefficients.shape[1], 2)
        return np.asarray(coefficients[:, ::2] @ (2.0 / (1.0 - order**2)) * (0.5 * self._lengths))

    @cached_property
    def _error(self) -> Array:
        coefficients = -self.coefficients
        coefficients[:, 0] += self.final
        return coefficients

    def ie(self) -> float:
        """Return the integrated error over [0, horizon].

        For a set-point response the integral of ``final - y``; for a load response, whose final value is zero, that of
        the deviation y itself, so that a unit load step under integral action gives IE = 1/ki.
        """
        self._require_stable("integrated error")
        error = float(np.sum(self._piece_integrals(self._error)))
        return error if self.final else -error

    def ise(self) -> float:
        """Return the integral of the squared error ``(final - y)^2`` over [0, horizon]."""
        self._require_stable("integrated squared error")
        points, weights = chebyshev.gauss_legendre(self.degree + 2)
        values = self._error @ chebyshev.basis(points, self.degree)
        return float(np.sum(values**2 @ weights * (0.5 * self._lengths)))

    def iae(self) -> float:
        """Return the integral of the absolute error ``|final - y|`` over [0, horizon]."""
        return self._absolute_moment(0)

    def itae(self) -> float:
        """Return the integral of ``t |final - y|`` over [0, horizon]."""
        return self._absolute_moment(1)

    def itse(self) -> float:
        """Return the integral of ``t (final - y)^2`` over [0, horizon]."""
        self._require_stable("integrated error")
        points, weights = chebyshev.gauss_legendre(self.degree + 2)
        times = self.breaks[:-1, None] + 0.5 * self._lengths[:, None] * (points + 1.0)
        values = self._error @ chebyshev.basis(points, self.degree)
        return float(np.sum((values**2 * times) @ weights * (0.5 * self._lengths)))

    def _absolute_moment(self, power: int) -> float:
        self._require_stable("integrated absolute error")
        samples = self.final - self._samples
        negligible = np.max(np.abs(samples), axis=1) <= 1e-15 * np.max(np.abs(samples))
        signed = (samples.min(axis=1) - MARGIN * np.ptp(samples, axis=1) < 0.0) & (
            samples.max(axis=1) + MARGIN * np.ptp(samples, axis=1) > 0.0
        )
        half = 0.5 * self._lengths
        weighted = self._error
        for _ in range(power):
            weighted = _times_argument(weighted, self.breaks[:-1] + half, half)
        total = float(np.sum(np.abs(self._piece_integrals(weighted))[~signed]))
        pieces = np.nonzero(signed & ~negligible)[0]
        owners, roots = self._zeros_of_error(pieces, samples)
        # between neighbouring zeros the integral is a difference of the antiderivative
        owners = np.concatenate([pieces, owners, pieces])
        points = np.concatenate([np.full(pieces.size, -1.0), roots, np.full(pieces.size, 1.0)])
        order = np.lexsort((points, owners))
        owners, points = owners[order], points[order]
        running = np.asarray(cheb.chebint(weighted, axis=1), dtype=float)
        values = chebyshev.evaluate(running[owners], points) * half[owners]
        same = owners[1:] == owners[:-1]
        return total + float(np.sum(np.abs(np.diff(values))[same]))

    def _zeros_of_error(self, pieces: NDArray[np.intp], samples: Array) -> tuple[NDArray[np.intp], Array]:
        """Return the zeros of the error in some pieces, as piece numbers and local coordinates.

        Zeros between samples of opposite sign are found all at once; pieces with an extremum so close to zero that it
        may hide two zeros between samples go through the companion matrix.
        """
        part = samples[pieces]
        slopes = np.diff(part, axis=1)
        turns = slopes[:, 1:] * slopes[:, :-1] <= 0.0
        hidden = np.any(turns & (np.abs(part[:, 1:-1]) < MARGIN * np.ptp(part, axis=1)[:, None]), axis=1)
        rows, columns = np.nonzero((part[:, :-1] < 0.0) != (part[:, 1:] < 0.0))
        clear = ~hidden[rows]
        rows, columns = rows[clear], columns[clear]
        nodes = chebyshev.nodes(SAMPLES - 1)
        owners = pieces[rows]
        found = chebyshev.bracketed_roots(self._error[owners], nodes[columns], nodes[columns + 1])
        slow = [(piece, chebyshev.real_roots(self._error[piece])) for piece in pieces[hidden]]
        owners = np.concatenate([owners, *(np.full(roots.size, piece, dtype=np.intp) for piece, roots in slow)])
        return owners, np.concatenate([found, *(roots for _, roots in slow)])


def _times_argument(series: Array, middle: Array, half: Array) -> Array:
    """Multiply Chebyshev series (rows) by their argument t = middle + half x."""
    product = np.zeros((series.shape[0], series.shape[1] + 1))
    product[:, :-1] += series * middle[:, None]
    # x T_k = (T_(k+1) + T_(k-1)) / 2, x T_0 = T_1
    product[:, 1] += half * series[:, 0]
    product[:, 2:] += 0.5 * half[:, None] * series[:, 1:]
    product[:, :-2] += 0.5 * half[:, None] * series[:, 1:]
    return product

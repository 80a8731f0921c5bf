"""A time response and its metrics: overshoot, times and error integrals, read from the piecewise polynomial."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError, NotSettledError, UnstableLoopError
from replicate.loops.numerics import chebyshev
from replicate.loops.numerics.peaks import Peak
from replicate.loops.time_domain.piecewise import MARGIN, Piecewise
from replicate.loops.time_domain.sign_changes import ups_and_downs
from replicate.loops.time_domain.signal_views import SignalViews

Array = NDArray[np.float64]

APPROACH = 1e-12  # of the final value: a response that never exceeds it by more only approaches it
ARRIVAL = 1e-3  # of the final value: no mode decays from there to rounding within one piece
AT_REST = 1e-14  # of the largest value: a piece that deviates less is at rest to rounding
ROUNDING = 5e-14  # a response that exceeds its final value by less does so by rounding only


class Signal(SignalViews, Piecewise):
    """A time response: the piecewise function, and what one asks of a response.

    Parameters
    ----------
    breaks
        Ends of the pieces, increasing, shape (n + 1,).
    coefficients
        Chebyshev coefficients of each piece, shape (n, degree + 1).
    final
        The value that the response approaches; ``nan`` if there is none.
    stable
        Says on request whether the loop is stable; default: it is taken to be.

    Notes
    -----
    Times count from the step, dead time included. Overshoot is a fraction of the final value. Where the final value is
    zero (load responses) bands are absolute, as fractions of the unit step.

    Examples
    --------
    An integrator with unit dead time under unit load, not yet fed back: y = t - 1 from t = 1 to t = 2.

    >>> from replicate.loops import PI, Loop, Plant
    >>> y = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(0.25)).load_step(until=2.0)
    >>> [round(float(value), 12) for value in y([0.5, 1.5, 2.0])]
    [0.0, 0.5, 1.0]
    >>> round(y.peak(), 12), y.peak().time, round(y.integral(), 12)
    (1.0, 2.0, 0.5)
    """

    def peak(self) -> Peak:
        """Return the largest value on [0, horizon]; its ``.time`` is where it is reached.

        The time is ``inf`` where the response only approaches its final value from below: rounding alone would say
        when it is closest. It is zero where the response begins at its final value and never exceeds it.
        """
        highest = super().peak()
        scale = abs(self.final) or float(np.max(np.abs(self._samples)))
        if not np.isfinite(self.final) or abs(highest - self.final) > APPROACH * scale:
            return highest
        error = np.max(np.abs(self._samples - self.final), axis=1)
        at_rest = np.nonzero(error <= APPROACH * scale)[0]
        if at_rest.size and at_rest[0] == 0:
            return Peak(float(self._samples[0, 0]), 0.0)
        arrives = at_rest.size and error[at_rest[0] - 1] > ARRIVAL * scale
        return highest if arrives else Peak(highest.value, float("inf"))

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
        band = checks.settling_band(band)
        width = band * (abs(self.final) if self.final else 1.0)
        error = np.abs(self._samples - self.final)
        if error[-1, -1] > width:
            where = f"within {band:g} of {self.final:g} by t = {self.horizon:g}"
            msg = f"the response has not settled {where}; compute a longer one"
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
        if abs(series.sum()) > width:
            return self._time(piece, 1.0)
        error = self._samples[piece] - self.final
        slack = MARGIN * float(np.ptp(error))
        levels = [level for level in (width, -width) if error.min() - slack <= level <= error.max() + slack]
        crossings = np.concatenate([np.empty(0), *(self._crossing_roots(piece, self.final + x) for x in levels)])
        for x in np.sort(crossings)[::-1]:  # the last root beyond which |error| really was larger
            before = max(-1.0, x - 1e-7)
            if abs(cheb.chebval(before, series)) > width:
                return self._time(piece, float(x))
        return None

    def rise_time(self, low: float = 0.1, high: float = 0.9) -> float:
        """Return the time from first reaching ``low`` to first reaching ``high``, fractions of the final value."""
        self._require_stable("rise time")
        self._require_final("rise time")
        low, high = checks.finite("the rise time's low", low), checks.finite("the rise time's high", high)
        if not 0.0 <= low < high:
            msg = f"the rise time runs from a fraction low >= 0 to a larger one, not from {low} to {high}"
            raise LoopError(msg)
        return self.first_reach(high * self.final) - self.first_reach(low * self.final)

    def delay_time(self, fraction: float = 0.5) -> float:
        """Return the first time at which the response reaches ``fraction`` of its final value, dead time included."""
        self._require_stable("delay time")
        self._require_final("delay time")
        fraction = checks.non_negative(
            "the delay time's fraction", fraction, allowed="a fraction >= 0 of the final value"
        )
        return self.first_reach(fraction * self.final)

    # ---- integrals ------------------------------------------------------------------------------------------------

    @cached_property
    def _error(self) -> Array:
        coefficients = -self.coefficients
        coefficients[:, 0] += self.final
        return coefficients

    @cached_property
    def _moving(self) -> NDArray[np.bool_]:
        """Which pieces deviate from the final value by more than rounding.

        A mode that cancels in the response makes its horizon long: rounding errors would add up over it.
        """
        error = np.max(np.abs(self._samples - self.final), axis=1)
        return np.asarray(~(error <= AT_REST * float(np.max(np.abs(self._samples)))))

    def ie(self) -> float:
        """Return the integrated error over [0, horizon].

        For a set-point response the integral of ``final - y``; for a load response, whose final value is zero, that of
        the deviation y itself, so that a unit load step under integral action gives IE = 1/ki.
        """
        self._require_stable("integrated error")
        error = float(np.sum(self._piece_integrals(self._error)[self._moving]))
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
        half = 0.5 * self._lengths
        weighted = self._error
        for _ in range(power):
            weighted = _times_argument(weighted, self.breaks[:-1] + half, half)
        integrals = weighted @ chebyshev.antidifferentiation(weighted.shape[1] - 1) * half[:, None]
        scales = self._lengths * (self.breaks[1:] if power else 1.0)
        moving = self._moving
        return ups_and_downs(self._error[moving], integrals[moving], scales[moving])


@dataclass(frozen=True)
class Response:
    """Output and control signal of one experiment.

    Attributes
    ----------
    output
        The plant output y.
    control
        The control signal u.
    """

    output: Signal
    control: Signal


def _times_argument(series: Array, middle: Array, half: Array) -> Array:
    """Multiply Chebyshev series (rows) by their argument t = middle + half x."""
    product = np.zeros((series.shape[0], series.shape[1] + 1))
    product[:, :-1] += series * middle[:, None]
    # x T_k = (T_(k+1) + T_(k-1)) / 2, x T_0 = T_1
    product[:, 1] += half * series[:, 0]
    product[:, 2:] += 0.5 * half[:, None] * series[:, 1:]
    product[:, :-2] += 0.5 * half[:, None] * series[:, 1:]
    return product

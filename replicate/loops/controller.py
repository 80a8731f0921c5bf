r"""PI and PID controllers with two degrees of freedom, and the conversions between their forms.

Every controller here is a special case of

.. math::

    u = k (b r_f - y_f) + \frac{k_i}{s} (r_f - y_f) + \frac{k_d s}{1 + s T_d'} (c r_f - y_f), \qquad
    r_f = F_{sp} r, \quad y_f = F_y y

with set-point weights b and c, derivative filter time :math:`T_d'`, measurement filter :math:`F_y`, for example
:math:`1/(1 + s T_f)^n`, and set-point filter :math:`F_{sp}`. The series form with derivative filter is contained
exactly (`PID.series`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.controller_views import ControllerViews
from replicate.loops.errors import LoopError
from replicate.loops.evaluation import quotient, values
from replicate.loops.filters import Filter, checked_filter, filter_polynomials
from replicate.loops.numerics.polynomials import product

ComplexArray = NDArray[np.complex128]
Array = NDArray[np.float64]


@dataclass(frozen=True, repr=False, eq=False)
class PID(ControllerViews):
    """A PID controller in parallel form with two degrees of freedom.

    Parameters
    ----------
    k, ki, kd
        Proportional, integral and derivative gain (kd in units of time, ki in units of 1/time, times k's unit).
    b, c
        Set-point weights of the proportional and the derivative part.
    derivative_filter
        Time constant of the filter on the derivative part alone; 0 is an ideal derivative.
    measurement_filter, measurement_filter_order
        Time constant and order (1 or 2) of the filter 1/(1 + sT)^order on the measurement; time constant 0 is no
        filter. Any other filter is a pair (num, den) of polynomial coefficients in descending powers of s, whose order
        is its own: 1/(1 + sT + (sT)^2/2) is ``((1.0,), (T**2 / 2, T, 1.0))``.
    setpoint_filter
        Time constant of a first-order set-point filter (0: none), or a pair (num, den) of polynomial coefficients in
        descending powers of s.

    Raises
    ------
    LoopError
        If a gain is not a finite real number, a time constant is negative, the filter order is not 1 or 2, or a filter
        given by polynomials is not proper and stable.

    Examples
    --------
    1 + 0.5/s + 2 s at s = 1/2 is 1 + 1 + 1:

    >>> controller = PID(1.0, 0.5, 2.0)
    >>> complex(controller.feedback(0.5))
    (3+0j)
    >>> controller == PID.ideal(1.0, integral_time=2.0, derivative_time=2.0)
    True
    """

    k: float
    ki: float = 0.0
    kd: float = 0.0
    b: float = 1.0
    c: float = 0.0
    derivative_filter: float = 0.0
    measurement_filter: Filter = 0.0
    measurement_filter_order: int = 1
    setpoint_filter: Filter = 0.0

    def __post_init__(self) -> None:
        for name in ("k", "ki", "kd", "b", "c"):
            self._set(name, checks.finite(f"the controller's {name}", getattr(self, name)))
        lag = checks.non_negative(
            "the controller's derivative_filter", self.derivative_filter, allowed="a time constant >= 0"
        )
        self._set("derivative_filter", lag)
        for name in ("measurement_filter", "setpoint_filter"):
            self._set(name, checked_filter(name, getattr(self, name)))
        order = self.measurement_filter_order
        if not np.isscalar(order) or order not in (1, 2):
            msg = f"the order of the measurement filter must be 1 or 2, not {checks.shown(order)}"
            raise LoopError(msg)

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    @classmethod
    def ideal(
        cls,
        gain: float,
        integral_time: float = np.inf,
        derivative_time: float = 0.0,
        *,
        b: float = 1.0,
        c: float = 0.0,
        derivative_filter: float = 0.0,
        measurement_filter: Filter = 0.0,
        measurement_filter_order: int = 1,
        setpoint_filter: Filter = 0.0,
    ) -> PID:
        r"""Return :math:`K (1 + 1/(sT_i) + s T_d)`; ``integral_time=inf`` switches the integral part off.

        Parameters
        ----------
        gain
            K, the proportional gain.
        integral_time, derivative_time
            Ti and Td.
        b, c, derivative_filter, measurement_filter, measurement_filter_order, setpoint_filter
            As for `PID`.
        """
        gain = checks.finite("gain", gain)
        return cls(
            gain,
            gain / _checked_time("integral_time", integral_time),
            gain * checks.finite("derivative_time", derivative_time),
            b=b,
            c=c,
            derivative_filter=derivative_filter,
            measurement_filter=measurement_filter,
            measurement_filter_order=measurement_filter_order,
            setpoint_filter=setpoint_filter,
        )

    @classmethod
    def series(
        cls,
        gain: float,
        integral_time: float,
        derivative_time: float,
        *,
        alpha: float = 0.0,
        b: float = 1.0,
        c: float = 1.0,
    ) -> PID:
        r"""Return the series form :math:`K (1 + 1/(sT_i)) (1 + sT_d)/(1 + s \alpha T_d)` in parallel form.

        With alpha > 0 the parallel form has a derivative filter :math:`\alpha T_d` and the two are the same transfer
        function; b = c = 1 makes the controller act on the error, as a series controller does.

        Parameters
        ----------
        gain
            K, the gain of the series form.
        integral_time, derivative_time
            Ti and Td of the series form.
        alpha
            Time constant of the filter of the lead, as a fraction of Td; 0 for none.
        b, c
            Set-point weights of the parallel form, as for `PID`.

        Examples
        --------
        >>> pid = PID.series(2.0, 4.0, 1.0, alpha=0.1)
        >>> s = 0.3 + 2j
        >>> bool(abs(pid.feedback(s) - 2 * (1 + 1 / (4 * s)) * (1 + s) / (1 + 0.1 * s)) < 1e-14)
        True
        """
        gain, derivative_time = checks.finite("gain", gain), checks.finite("derivative_time", derivative_time)
        lag = checks.non_negative("alpha", alpha) * derivative_time
        integral_time = _checked_time("integral_time", integral_time)
        k = gain * (1.0 + (derivative_time - lag) / integral_time)
        return cls(k, gain / integral_time, gain * derivative_time - k * lag, b=b, c=c, derivative_filter=lag)

    @property
    def integral_time(self) -> float:
        """Ti = k/ki of the ideal form; ``inf`` without integral action."""
        return self.k / self.ki if self.ki else float("inf")

    @property
    def derivative_time(self) -> float:
        """Td = kd/k of the ideal form."""
        return self.kd / self.k if self.k else float("inf")

    def to_series(self) -> tuple[float, float, float]:
        r"""Return (gain, integral time, derivative time) of the series form.

        The series form is :math:`K' (1 + 1/(sT_i'))(1 + sT_d')/(1 + sT_d'')`, its filter the derivative filter of the
        controller.

        Raises
        ------
        LoopError
            If the controller has complex zeros: then no series form exists.

        Examples
        --------
        >>> [round(x, 12) for x in PID.series(2.0, 4.0, 1.0, alpha=0.1).to_series()]
        [2.0, 4.0, 1.0]
        """
        # the numerator (k lag + kd) s^2 + (k + ki lag) s + ki is that of a controller without filter
        k, kd = self.k + self.ki * self.derivative_filter, self.kd + self.k * self.derivative_filter
        ti = k / self.ki if self.ki else float("inf")
        td = kd / k if k else float("inf")
        if ti < 4.0 * td:
            msg = f"no series form: the zeros are complex, Ti = {ti:g} is less than 4 Td = {4 * td:g}"
            raise LoopError(msg)
        factor = 0.5 * (1.0 + np.sqrt(1.0 - 4.0 * td / ti))
        return k * float(factor), ti * float(factor), td / float(factor)

    def feedback_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den), descending powers of s, of the transfer function from -y to u.

        The numerator has one degree more than the denominator for an ideal derivative without measurement filter.
        """
        num, den = np.array([self.k]), np.array([1.0])
        if self.ki:
            num, den = np.array([self.k, self.ki]), np.array([1.0, 0.0])
        if self.kd:
            lag = np.array([self.derivative_filter, 1.0] if self.derivative_filter else [1.0])
            slope = product(np.array([self.kd, 0.0]), den)
            num = product(num, lag)
            slope[slope.size - num.size :] += num
            num, den = slope, product(den, lag)
        filter_num, filter_den = self.measurement_filter_polynomials()
        if filter_den.size > 1 or isinstance(self.measurement_filter, tuple):
            num, den = product(num, filter_num), product(den, filter_den)
        return num, den

    def measurement_filter_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den) of the measurement filter."""
        num, den = filter_polynomials(self.measurement_filter)
        if self.measurement_filter_order == 2 and not isinstance(self.measurement_filter, tuple):
            den = np.asarray(np.polymul(den, den), dtype=float)
        return num, den

    def setpoint_filter_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den) of the set-point filter."""
        return filter_polynomials(self.setpoint_filter)

    def feedback(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from -y to u, measurement filter included.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        num, den = self.feedback_polynomials()
        return values(lambda s: quotient(np.polyval(num, s), np.polyval(den, s)), s)

    def feedforward(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from r to u, set-point filter included.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        num, den = self.setpoint_filter_polynomials()

        def value(s: ComplexArray) -> ComplexArray:
            integral = quotient(self.ki + 0.0 * s, s) if self.ki else 0.0
            derivative = self.kd * self.c * s / (1.0 + s * self.derivative_filter)
            return np.asarray((self.b * self.k + integral + derivative) * np.polyval(num, s) / np.polyval(den, s))

        return values(value, s)


def _checked_time(name: str, value: float) -> float:
    try:
        time = checks.real(value)
    except ValueError:
        time = float("nan")
    if time == 0.0 or np.isnan(time):
        given = checks.shown(value)
        msg = f"the controller's {name} must be a number other than 0 (inf switches the integral part off), not {given}"
        raise LoopError(msg)
    return time


class PI(PID):
    """A PI controller ``u = k (b r - y) + ki * integral(r - y)``, with the optional filters of `PID`.

    Parameters
    ----------
    k, ki
        Proportional and integral gain.
    b
        Set-point weight of the proportional part.
    measurement_filter, measurement_filter_order, setpoint_filter
        As for `PID`.

    Examples
    --------
    With a gain of 2 and an integral time of 4 the feedback 2 + 0.5/s is 3 at s = 1/2:

    >>> controller = PI(2.0, 0.5)
    >>> controller.integral_time
    4.0
    >>> complex(controller.feedback(0.5))
    (3+0j)
    """

    def __init__(
        self,
        k: float,
        ki: float = 0.0,
        b: float = 1.0,
        *,
        measurement_filter: Filter = 0.0,
        measurement_filter_order: int = 1,
        setpoint_filter: Filter = 0.0,
    ) -> None:
        super().__init__(
            k,
            ki,
            0.0,
            b=b,
            measurement_filter=measurement_filter,
            measurement_filter_order=measurement_filter_order,
            setpoint_filter=setpoint_filter,
        )

    @classmethod
    def from_integral_time(cls, gain: float, integral_time: float, b: float = 1.0) -> PI:
        """Return the PI controller ``K (1 + 1/(s Ti))``.

        Parameters
        ----------
        gain
            K, the proportional gain.
        integral_time
            Ti > 0; ``inf`` switches the integral part off.
        b
            Set-point weight of the proportional part.
        """
        gain = checks.finite("gain", gain)
        return cls(gain, gain / _checked_time("integral_time", integral_time), b)

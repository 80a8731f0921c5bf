r"""PI and PID controllers with two degrees of freedom, and the conversions between their forms.

Every controller here is a special case of

.. math::

    u = k (b r_f - y_f) + \frac{k_i}{s} (r_f - y_f) + \frac{k_d s}{1 + s T_d'} (c r_f - y_f), \qquad
    r_f = F_{sp} r, \quad y_f = \frac{y}{(1 + s T_f)^n}

with set-point weights b and c, derivative filter time :math:`T_d'`, measurement filter of order n (0, 1, 2) and
set-point filter :math:`F_{sp}`. The series form with derivative filter is contained exactly (`PID.series`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops.errors import LoopError

ComplexArray = NDArray[np.complex128]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class PID:
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
        Time constant and order (1 or 2) of the filter on the measurement; time constant 0 is no filter.
    setpoint_filter
        Time constant of a first-order set-point filter (0: none), or a pair (num, den) of polynomial coefficients in
        descending powers of s.

    Raises
    ------
    LoopError
        If a gain is not finite, a time constant is negative, the filter order is not 1 or 2, or the set-point filter is
        not proper and stable.
    """

    k: float
    ki: float = 0.0
    kd: float = 0.0
    b: float = 1.0
    c: float = 0.0
    derivative_filter: float = 0.0
    measurement_filter: float = 0.0
    measurement_filter_order: int = 1
    setpoint_filter: float | tuple[tuple[float, ...], tuple[float, ...]] = 0.0

    def __post_init__(self) -> None:
        for name in ("k", "ki", "kd", "b", "c"):
            if not np.isfinite(getattr(self, name)):
                msg = f"the controller's {name} must be a finite number, not {getattr(self, name)}"
                raise LoopError(msg)
        for name in ("derivative_filter", "measurement_filter"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) >= 0.0):
                msg = f"the controller's {name} must be a time constant >= 0, not {getattr(self, name)}"
                raise LoopError(msg)
        _check_setpoint_filter(self.setpoint_filter)
        if self.measurement_filter_order not in (1, 2):
            msg = f"the order of the measurement filter must be 1 or 2, not {self.measurement_filter_order}"
            raise LoopError(msg)

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
        measurement_filter: float = 0.0,
        measurement_filter_order: int = 1,
        setpoint_filter: float | tuple[tuple[float, ...], tuple[float, ...]] = 0.0,
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
        return cls(
            gain,
            gain / _checked_time("integral_time", integral_time),
            gain * derivative_time,
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
        lag = alpha * derivative_time
        k = gain * (1.0 + (derivative_time - lag) / _checked_time("integral_time", integral_time))
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
        r"""Return (gain, integral time, derivative time) of the series form :math:`K' (1 + 1/(sT_i'))(1 + sT_d')`.

        Raises
        ------
        LoopError
            If the controller has a derivative filter, or complex zeros (Ti < 4 Td): then no series form exists.
        """
        if self.derivative_filter:
            msg = "to_series() is defined for controllers without derivative filter"
            raise LoopError(msg)
        ti, td = self.integral_time, self.derivative_time
        if ti < 4.0 * td:
            msg = f"no series form: the zeros are complex, Ti = {ti:g} is less than 4 Td = {4 * td:g}"
            raise LoopError(msg)
        factor = 0.5 * (1.0 + np.sqrt(1.0 - 4.0 * td / ti))
        return self.k * factor, ti * factor, td / factor

    def feedback_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den), descending powers of s, of the transfer function from -y to u.

        The numerator has one degree more than the denominator for an ideal derivative without measurement filter.
        """
        num = np.array([self.k])
        den = np.array([1.0])
        if self.ki:
            num, den = np.polyadd(np.polymul(num, [1.0, 0.0]), [self.ki]), np.array([1.0, 0.0])
        if self.kd:
            lag = np.array([self.derivative_filter, 1.0]) if self.derivative_filter else np.array([1.0])
            num = np.polyadd(np.polymul(num, lag), np.polymul([self.kd, 0.0], den))
            den = np.polymul(den, lag)
        if self.measurement_filter:
            for _ in range(self.measurement_filter_order):
                den = np.polymul(den, [self.measurement_filter, 1.0])
        return np.atleast_1d(num).astype(float), np.atleast_1d(den).astype(float)

    def setpoint_filter_polynomials(self) -> tuple[Array, Array]:
        """Return (num, den) of the set-point filter."""
        if isinstance(self.setpoint_filter, tuple):
            num, den = (np.trim_zeros(np.atleast_1d(np.asarray(p, dtype=float)), "f") for p in self.setpoint_filter)
            return num, den
        if self.setpoint_filter:
            return np.array([1.0]), np.array([float(self.setpoint_filter), 1.0])
        return np.array([1.0]), np.array([1.0])

    def feedback(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from -y to u, measurement filter included.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        s = np.asarray(s, dtype=complex)
        num, den = self.feedback_polynomials()
        return np.asarray(np.polyval(num, s) / np.polyval(den, s))

    def feedforward(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the transfer function from r to u, set-point filter included.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        s = np.asarray(s, dtype=complex)
        num, den = self.setpoint_filter_polynomials()
        integral = self.ki / s if self.ki else 0.0
        derivative = self.kd * self.c * s / (1.0 + s * self.derivative_filter)
        return np.asarray((self.b * self.k + integral + derivative) * np.polyval(num, s) / np.polyval(den, s))


def _check_setpoint_filter(setpoint_filter: object) -> None:
    if not isinstance(setpoint_filter, tuple):
        if not (np.isscalar(setpoint_filter) and np.isreal(setpoint_filter) and 0.0 <= float(setpoint_filter) < np.inf):  # type: ignore[arg-type]
            msg = f"the controller's setpoint_filter must be a time constant >= 0 or (num, den), not {setpoint_filter}"
            raise LoopError(msg)
        return
    try:
        num, den = (np.trim_zeros(np.atleast_1d(np.asarray(part, dtype=float)), "f") for part in setpoint_filter)
    except (TypeError, ValueError):
        num = den = np.empty(0)
    if not (num.size and den.size and np.isfinite(num).all() and np.isfinite(den).all()):
        msg = f"the controller's setpoint_filter must be two non-zero polynomials (num, den), not {setpoint_filter}"
    elif num.size > den.size:
        msg = f"the controller's setpoint_filter must be proper: degree {num.size - 1} over degree {den.size - 1}"
    elif np.any(np.roots(den).real >= 0.0):
        msg = f"the controller's setpoint_filter must be stable: {den.tolist()} has a root with Re s >= 0"
    else:
        return
    raise LoopError(msg)


def _checked_time(name: str, value: float) -> float:
    if value == 0.0 or np.isnan(value):
        msg = f"the controller's {name} must be a number other than 0 (inf switches the integral part off), not {value}"
        raise LoopError(msg)
    return value


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
    """

    def __init__(
        self,
        k: float,
        ki: float = 0.0,
        b: float = 1.0,
        *,
        measurement_filter: float = 0.0,
        measurement_filter_order: int = 1,
        setpoint_filter: float | tuple[tuple[float, ...], tuple[float, ...]] = 0.0,
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
        return cls(gain, gain / _checked_time("integral_time", integral_time), b)

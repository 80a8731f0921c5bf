"""The plant: a rational transfer function times a dead time, or any transfer function analytic for Re s > 0."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike, NDArray

from replicate.loops.errors import LoopError

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


class Plant:
    r"""A single-input, single-output plant :math:`G(s) = G_0(s) e^{-sL}`.

    Parameters
    ----------
    num, den : array_like
        Coefficients of the rational part :math:`G_0`, descending powers of s. It must be proper.
    dead_time : float
        Dead time L >= 0, in the unit of time of the coefficients.

    Raises
    ------
    LoopError
        If the rational part is improper or zero, a coefficient is not finite, or the dead time is negative.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 1.0], dead_time=1.0)
    >>> bool(abs(plant(1j) - np.exp(-1j) / (1 + 1j)) < 1e-15)
    True
    """

    def __init__(self, num: ArrayLike, den: ArrayLike, dead_time: float = 0.0) -> None:
        self.num: Array = np.trim_zeros(np.atleast_1d(np.asarray(num, dtype=float)), "f")
        self.den: Array = np.trim_zeros(np.atleast_1d(np.asarray(den, dtype=float)), "f")
        if self.num.ndim != 1 or self.den.ndim != 1:
            msg = (
                f"the plant's coefficients must be two lists of numbers, not {self.num.shape} / {self.den.shape} arrays"
            )
            raise LoopError(msg)
        self.dead_time = _checked_dead_time(dead_time)
        self.function: Callable[[Any], Any] | None = None
        if self.num.size == 0 or self.den.size == 0:
            msg = "the plant's numerator and denominator must not be zero"
            raise LoopError(msg)
        if not (np.isfinite(self.num).all() and np.isfinite(self.den).all()):
            msg = f"the plant's coefficients must be finite numbers, not {self.num.tolist()} / {self.den.tolist()}"
            raise LoopError(msg)
        if self.num.size > self.den.size:
            msg = f"the plant must be proper: numerator degree {self.num.size - 1} exceeds denominator degree {self.den.size - 1}"  # noqa: E501
            raise LoopError(msg)
        self.num = self.num / self.den[0]
        self.den = self.den / self.den[0]

    @classmethod
    def foptd(cls, gain: float, time_constant: float, dead_time: float) -> Plant:
        r"""Return the first-order plant :math:`K e^{-sL} / (Ts + 1)`; a negative time constant is an unstable one.

        Parameters
        ----------
        gain
            K, the steady-state gain.
        time_constant
            T.
        dead_time
            L >= 0.
        """
        return cls([gain], [time_constant, 1.0], dead_time)

    @classmethod
    def from_control(cls, system: control.TransferFunction | control.StateSpace, dead_time: float = 0.0) -> Plant:
        """Return the plant of a single-input, single-output python-control system, times a dead time.

        Parameters
        ----------
        system
            The system, in continuous time.
        dead_time
            L >= 0.

        Raises
        ------
        LoopError
            If the system is discrete or has several inputs or outputs.
        """
        import control  # takes seconds to import

        transfer = control.tf(system)
        if transfer.ninputs != 1 or transfer.noutputs != 1:
            msg = f"the plant must have one input and one output, not {transfer.ninputs} and {transfer.noutputs}"
            raise LoopError(msg)
        if transfer.dt not in (0, None):
            msg = f"the plant must be in continuous time, not sampled with dt = {transfer.dt}"
            raise LoopError(msg)
        return cls(transfer.num[0][0], transfer.den[0][0], dead_time)

    @classmethod
    def from_function(cls, function: Callable[[Any], Any], dead_time: float = 0.0) -> Plant:
        r"""Return the plant :math:`f(s) e^{-sL}` for any transfer function f analytic for Re s > 0.

        ``function`` must accept complex arrays and not overflow where it is small. Time responses continue it into
        the plane cut along the negative real axis where that is possible (as for :math:`e^{-\\sqrt s}`) and check
        that this is so.

        Parameters
        ----------
        function
            f, for arrays of complex numbers.
        dead_time
            L >= 0.
        """
        plant = cls([1.0], [1.0], dead_time)
        plant.function = function
        return plant

    @property
    def is_rational(self) -> bool:
        """Whether the plant is a rational function times a dead time."""
        return self.function is None

    def delay_free(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the part without dead time at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        if self.function is not None:
            return np.asarray(self.function(s), dtype=complex)
        return np.asarray(np.polyval(self.num, s) / np.polyval(self.den, s))

    def __call__(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G(s), dead time exact, at complex ``s`` of any shape."""
        s = np.asarray(s, dtype=complex)
        return np.asarray(self.delay_free(s) * np.exp(-s * self.dead_time))

    def log_derivative(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G'(s)/G(s), dead time included: exact for rational plants, by a sixth-order difference otherwise.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        s = np.asarray(s, dtype=complex)
        if self.function is None:
            rational = np.polyval(np.polyder(self.num), s) / np.polyval(self.num, s) - np.polyval(
                np.polyder(self.den), s
            ) / np.polyval(self.den, s)
            return np.asarray(rational - self.dead_time)
        h = 2e-3 * np.abs(s)
        g = self.delay_free
        slope = 45 * (g(s + h) - g(s - h)) - 9 * (g(s + 2 * h) - g(s - 2 * h)) + g(s + 3 * h) - g(s - 3 * h)
        return np.asarray(slope / (60 * h * g(s)) - self.dead_time)

    def __neg__(self) -> Plant:
        """Return the plant with its sign changed."""
        if self.function is None:
            return Plant(-self.num, self.den, self.dead_time)
        function = self.function
        return Plant.from_function(lambda s: -function(s), self.dead_time)

    @property
    def integrators(self) -> int:
        """The number of poles at s = 0 (0 for plants given by a function)."""
        if self.function is not None:
            return 0
        return int(self.den.size - np.trim_zeros(self.den, "b").size)

    @property
    def gain(self) -> float:
        """The steady-state gain G(0); ``inf`` for an integrating plant, ``nan`` if a function has no value there."""
        if self.function is not None:
            with np.errstate(all="ignore"):
                at_rest = float(np.real(self.delay_free(0.0)))
            return at_rest if np.isfinite(at_rest) else float("nan")
        return float("inf") if self.integrators else float(self.num[-1] / self.den[-1])

    def poles(self) -> ComplexArray:
        """Return the poles of the rational part (empty for plants given by a function)."""
        return np.asarray(np.roots(self.den), dtype=complex)

    def zeros(self) -> ComplexArray:
        """Return the zeros of the rational part (empty for plants given by a function)."""
        return np.asarray(np.roots(self.num), dtype=complex)

    def state_space(self) -> tuple[Array, Array, Array, float]:
        """Return (A, B, C, D) of the rational part, a balanced companion form.

        Shapes (n, n), (n,), (n,) and scalar.

        Raises
        ------
        LoopError
            If the plant is given by a function.
        """
        if self.function is not None:
            msg = "a plant given by a function has no state-space model"
            raise LoopError(msg)
        order = self.den.size - 1
        padded = np.concatenate([np.zeros(self.den.size - self.num.size), self.num])
        feedthrough = float(padded[0])
        a = np.zeros((order, order))
        b = np.zeros(order)
        c = padded[1:] - feedthrough * self.den[1:]
        if order:
            a[0] = -self.den[1:]
            a[1:, :-1] += np.eye(order - 1)
            b[0] = 1.0
            _, (scale, _) = scipy.linalg.matrix_balance(a, permute=False, separate=True)
            a, b, c = a * scale[None, :] / scale[:, None], b / scale, c * scale
        return a, b, c, feedthrough

    def __repr__(self) -> str:
        if self.function is not None:
            return (
                f"Plant.from_function({getattr(self.function, '__name__', 'function')}, dead_time={self.dead_time:g})"
            )
        return f"Plant({self.num.tolist()}, {self.den.tolist()}, dead_time={self.dead_time:g})"


def _checked_dead_time(dead_time: float) -> float:
    if not (np.isfinite(dead_time) and dead_time >= 0.0):
        msg = f"the dead time must be a finite number >= 0, not {dead_time}"
        raise LoopError(msg)
    return float(dead_time)

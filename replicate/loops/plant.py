"""The plant: a rational transfer function times a dead time, and the ways to make a plant of any kind.

A `Plant` made by its constructor is rational times one dead time. `Plant.from_function` gives a `FunctionPlant`,
`Plant.from_terms`, sums and products give a `SumPlant` where there are several dead times; both are plants, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.evaluation import quotient, values
from replicate.loops.numerics.controller_form import controller_form
from replicate.loops.numerics.polynomials import horner, horner_with_slope, roots_of, taylor
from replicate.loops.plant_views import PlantViews
from replicate.loops.plants.function_resonances import NARROW
from replicate.loops.set_once import SetOnce

if TYPE_CHECKING:
    import control

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


class Plant(PlantViews, SetOnce):
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
        If the rational part is improper or zero, a coefficient is not a finite real number, or the dead time is not a
        finite number >= 0.

    Examples
    --------
    >>> plant = Plant([1.0], [1.0, 1.0], dead_time=1.0)
    >>> bool(abs(plant(1j) - np.exp(-1j) / (1 + 1j)) < 1e-15)
    True
    """

    function: Callable[[Any], Any] | None = None

    def __init__(self, num: ArrayLike, den: ArrayLike, dead_time: float = 0.0) -> None:
        if np.ndim(np.asarray(num, dtype=object)) > 1 or np.ndim(np.asarray(den, dtype=object)) > 1:
            msg = f"the plant's coefficients must be two lists of numbers, not {np.shape(num)} / {np.shape(den)} arrays"
            raise LoopError(msg)
        top = checks.coefficients("the plant's numerator", num)
        bottom = checks.coefficients("the plant's denominator", den)
        if top.size > bottom.size:
            degrees = f"numerator degree {top.size - 1} exceeds denominator degree {bottom.size - 1}"
            msg = f"the plant must be proper: {degrees}"
            raise LoopError(msg)
        with np.errstate(over="ignore", under="ignore"):  # looked for below
            self._set(top / bottom[0], bottom / bottom[0], checks.non_negative("the dead time", dead_time))
        if not (np.isfinite(self.num).all() and np.isfinite(self.den).all() and self.num.any()):
            msg = "the plant's coefficients, divided by the leading one of the denominator, exceed the range of floats"
            raise LoopError(msg)

    def _set(self, num: Array, den: Array, dead_time: float) -> None:
        self.num, self.den, self.dead_time = num, den, dead_time
        num.flags.writeable = den.flags.writeable = False

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
        return Plant([checks.finite("gain", gain)], [checks.finite("time_constant", time_constant), 1.0], dead_time)

    @classmethod
    def from_control(cls, system: control.TransferFunction | control.StateSpace, dead_time: float = 0.0) -> Plant:
        """Return the plant of a single-input, single-output python-control system, times a dead time.

        Coefficients of a state-space model that differ from zero by no more than the rounding of its matrices are zero.

        Parameters
        ----------
        system
            The system, in continuous time.
        dead_time
            L >= 0.

        Raises
        ------
        LoopError
            If the system is neither a transfer function nor a state-space model, is discrete, or has several inputs or
            outputs.
        """
        from replicate.loops.plants.control_systems import polynomials_of

        return Plant(*polynomials_of(system), dead_time)

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

        Raises
        ------
        LoopError
            If ``function`` is not callable.
        """
        from replicate.loops.plants.function_plant import FunctionPlant

        return FunctionPlant(function, dead_time)

    @classmethod
    def from_terms(cls, terms: Iterable[tuple[ArrayLike, ArrayLike, float]]) -> Plant:
        r"""Return the plant :math:`\sum_i N_i(s)/D_i(s)\, e^{-sL_i}` of terms (num, den, dead time).

        Parameters
        ----------
        terms
            For each term the coefficients of N and D, descending powers of s, and its dead time L >= 0.

        Raises
        ------
        LoopError
            If there is no term, a term is not a plant of its own, or the terms cancel.

        Examples
        --------
        The mean of the input over the last unit of time:

        >>> window = Plant.from_terms([([1.0], [1.0, 0.0], 0.0), ([-1.0], [1.0, 0.0], 1.0)])
        >>> bool(abs(window(2j) - (1 - np.exp(-2j)) / 2j) < 1e-15)
        True
        """
        from replicate.loops.plants.sum_plant import sum_of

        given = checks.several("the terms of a plant", terms, "a list of (num, den, dead_time)")
        return sum_of(
            [Plant(*checks.exactly(3, "each term of a plant", term, "(num, den, dead_time)")) for term in given]
        )

    # ---- what kind of plant it is ---------------------------------------------------------------------------------

    @property
    def is_rational(self) -> bool:
        """Whether the plant is a rational function times one dead time."""
        return True

    @property
    def parts(self) -> tuple[Plant, ...]:
        """The rational plants with one dead time each whose sum the plant is; a function has none."""
        return (self,)

    # ---- values ---------------------------------------------------------------------------------------------------

    def delay_free(self, s: ArrayLike) -> ComplexArray:
        """Evaluate the part without (its shortest) dead time at complex ``s``."""
        s = np.asarray(s, dtype=complex)
        return quotient(horner(self.num.tolist(), s), horner(self.den.tolist(), s))

    def __call__(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G(s), dead time exact, at complex ``s`` of any shape: ``inf`` at a pole, ``nan`` at infinity."""
        return values(lambda s: self.delay_free(s) * np.exp(-s * self.dead_time), s)

    def log_derivative(self, s: ArrayLike) -> ComplexArray:
        """Evaluate G'(s)/G(s), dead time included: exact for rational plants, by a sixth-order difference otherwise.

        Parameters
        ----------
        s
            Complex frequencies, any shape.
        """
        s = np.asarray(s, dtype=complex)
        (n, n_slope), (d, d_slope) = (horner_with_slope(part.tolist(), s) for part in (self.num, self.den))
        return np.asarray(n_slope / n - d_slope / d - self.dead_time)

    def taylor(self, s: ComplexArray, order: int) -> ComplexArray:
        """Return the Taylor coefficients of the part without dead time, shape (order + 1, len(s)).

        Parameters
        ----------
        s
            Complex points, shape (n,).
        order
            The highest derivative.
        """
        from replicate.loops.plants.jets import series_quotient

        return series_quotient(taylor(self.num.tolist(), s, order), taylor(self.den.tolist(), s, order))

    # ---- properties -----------------------------------------------------------------------------------------------

    @property
    def integrators(self) -> int:
        """The number of poles at s = 0 (0 for plants given by a function)."""
        return next(n for n, c in enumerate(reversed(self.den.tolist())) if c)

    @property
    def gain(self) -> float:
        """The steady-state gain G(0); ``inf`` for an integrating plant, ``nan`` if a function has no value there."""
        return float("inf") if self.integrators else float(self.num[-1] / self.den[-1])

    @property
    def gain_is_negative(self) -> bool:
        """Whether only a negative integral gain can stabilise the plant: N(0) D(0) with D monic has that sign."""
        return bool(self.num[-1] < 0.0)

    def poles(self) -> ComplexArray:
        """Return the poles of the rational part (empty for plants given by a function)."""
        return self._roots[0].copy()

    def zeros(self) -> ComplexArray:
        """Return the zeros of the rational part (empty for plants given by a function)."""
        return self._roots[1].copy()

    @cached_property
    def _roots(self) -> tuple[ComplexArray, ComplexArray]:
        """Poles and zeros."""
        return roots_of(self.den), roots_of(self.num)

    @property
    def resonances(self) -> ComplexArray:
        """The poles close to the imaginary axis, Im > 0."""
        poles = self.poles()
        return np.asarray(poles[(np.abs(poles.real) < NARROW * np.abs(poles)) & (poles.imag > 0.0)])

    @property
    def corners(self) -> tuple[float, float]:
        """Lowest and highest corner frequency of the part without dead time; one over the dead time if it has none."""
        moduli = np.abs(np.concatenate([self.poles(), self.zeros()]))
        moduli = moduli[moduli > 0.0]
        if moduli.size:
            return float(moduli.min()), float(moduli.max())
        at = 1.0 / self.dead_time if self.dead_time else 1.0
        return at, at

    def state_space(self) -> tuple[Array, Array, Array, float]:
        """Return (A, B, C, D) of the rational part, a balanced companion form.

        Shapes (n, n), (n,), (n,) and scalar.

        Raises
        ------
        LoopError
            If the plant is given by a function.
        """
        a, b, c, feedthrough = controller_form(self.num, self.den)
        if b.size > 1:
            _, _, _, scale, _ = scipy.linalg.lapack.dgebal(a, scale=1, permute=0)
            a, b, c = a * scale[None, :] / scale[:, None], b / scale, c * scale
        return a, b, c, feedthrough

    # ---- algebra --------------------------------------------------------------------------------------------------

    def rescaled(self, time: float, gain: float) -> Plant:
        """Return the plant in another unit of time, its gain divided by ``gain``; exact for powers of two.

        Parameters
        ----------
        time
            The new unit of time, in the old one.
        gain
            The new unit of the gain, in the old one; a negative one changes the sign.
        """
        time, gain = checks.positive("the unit of time", time), checks.nonzero("the unit of gain", gain)
        shift = time ** np.arange(self.den.size, dtype=float)
        offset = self.den.size - self.num.size
        scaled = Plant.__new__(Plant)
        scaled._set(self.num * shift[offset:] / gain, self.den * shift, self.dead_time / time)  # noqa: SLF001  -- its own
        return scaled

    def __neg__(self) -> Plant:
        """Return the plant with its sign changed."""
        return self.rescaled(1.0, -1.0)

    def __mul__(self, other: Plant | float) -> Plant:
        """Return the plants in series, or the plant with its gain multiplied by a number."""
        from replicate.loops.plants.sum_plant import product_of

        if not isinstance(other, Plant):
            return self._times(checks.nonzero("the factor of a plant", other))
        return product_of(self, other)

    __rmul__ = __mul__

    def _times(self, factor: float) -> Plant:
        return Plant(self.num * factor, self.den, self.dead_time)

    def __truediv__(self, divisor: float) -> Plant:
        """Return the plant with its gain divided by a number."""
        return self.rescaled(1.0, checks.nonzero("the divisor of a plant", divisor))

    def __add__(self, other: Plant | float) -> Plant:
        """Return the plants in parallel; a number is a static gain."""
        from replicate.loops.plants.sum_plant import sum_of

        if not isinstance(other, Plant):
            gain = checks.finite("the gain in parallel to a plant", other)
            if not gain:
                return self
            other = Plant([gain], [1.0])
        return sum_of([*self.parts, *other.parts] if self.parts and other.parts else [self, other])

    __radd__ = __add__

    def __sub__(self, other: Plant | float) -> Plant:
        """Return the difference of two plants."""
        return self + (-other)

    def __repr__(self) -> str:
        return f"Plant({self.num.tolist()}, {self.den.tolist()}, dead_time={checks.exact(self.dead_time)})"

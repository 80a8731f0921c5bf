r"""The nu-gap metric between two plants: the largest chordal distance of their frequency responses.

.. math:: \delta_\nu(G_1, G_2) = \sup_\omega
    \frac{|G_1 - G_2|}{\sqrt{1 + |G_1|^2}\sqrt{1 + |G_2|^2}}

if the winding condition holds, and 1 otherwise. With :math:`G_j = B_j/A_j` the condition is that
:math:`B_1(s) B_2(-s) + A_1(s) A_2(-s)` has as many zeros in the right half-plane as the degree of :math:`A_2`, and
none on the axis. A controller with generalised stability margin b > beta around one plant stabilises every plant
closer to it than beta.

Reference: Vinnicombe, "Uncertainty and Feedback" (2001), chapter 3; Panagopoulos, thesis (2000), paper III, section 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain import stability
from replicate.loops.frequency_domain.frequency_grids import plants_grid
from replicate.loops.frequency_domain.gamma_norm import Weight, magnitude_of
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.frequency_domain.sensitivity import highest_peak
from replicate.loops.numerics.peaks import FrequencyPeak
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DECADES = 6  # how far the search goes beyond the corners of the plants, towards both limits
BEYOND = 1e6  # factor by which a frequency beyond it shows the limit


@dataclass(frozen=True)
class WindingCount:
    """The winding condition: right half-plane zeros found, and how many there must be.

    Attributes
    ----------
    found, needed
        Numbers of zeros.
    """

    found: int
    needed: int

    @property
    def fulfilled(self) -> bool:
        """Whether the two numbers agree."""
        return self.found == self.needed


def winding_count(first: Plant, second: Plant) -> WindingCount:
    """Count the right half-plane zeros of B1(s) B2(-s) + A1(s) A2(-s), dead times included.

    Parameters
    ----------
    first, second
        The plants, rational up to their dead times.

    Raises
    ------
    LoopError
        If a plant is not rational up to its dead time.
    """
    _require_rational(first, second)
    if first.dead_time < second.dead_time:  # the condition is symmetric; the count wants a delay, not a prediction
        first, second = second, first
    num = np.asarray(np.polymul(first.num, _mirrored(second.num)), dtype=float)
    den = np.asarray(np.polymul(first.den, _mirrored(second.den)), dtype=float)
    delay = first.dead_time - second.dead_time
    pair = LoopTransfer(num, den, delay, Plant([1.0], [1.0], delay))
    return WindingCount(stability.unstable_poles(pair), second.den.size - 1)


def chordal_distance(first: Plant, second: Plant, w: Array, weight: Weight | None = None) -> Array:
    """Return the chordal distance of two frequency responses at frequencies ``w`` > 0, between 0 and 1.

    ``weight`` multiplies both plants, as it does in `gamma_norm`; default none.

    Parameters
    ----------
    first, second
        The plants.
    w
        Frequencies, in rad per unit of time.
    weight
        Multiplies both plants; default: none.
    """
    w = checks.times("w", w)
    scale = magnitude_of(weight, w)
    g1, g2 = first(1j * w) * scale, second(1j * w) * scale
    return np.asarray(np.abs(g1 - g2) / (np.hypot(1.0, np.abs(g1)) * np.hypot(1.0, np.abs(g2))))


def nu_gap(first: Plant, second: Plant, weight: Weight | None = None) -> FrequencyPeak:
    """Return the nu-gap between two plants, with the frequency at which it is reached.

    Parameters
    ----------
    first, second
        Rational plants with or without dead time.
    weight
        Multiplies both plants; default none. The winding condition does not depend on a positive weight that is
        the magnitude of a function without zeros or poles in the right half-plane; it is checked without it.

    Returns
    -------
    FrequencyPeak
        Between 0 and 1; 1 with the frequency ``nan`` if the winding condition fails.

    Raises
    ------
    LoopError
        If a plant is not rational up to its dead time.

    Examples
    --------
    Two gains: the sine of the angle between the directions (1, 1) and (1, 3).

    >>> round(nu_gap(Plant([1.0], [1.0]), Plant([3.0], [1.0])), 12)
    0.4472135955
    """
    if not winding_count(first, second).fulfilled:
        return FrequencyPeak(1.0, float("nan"))

    def magnitude(w: Array) -> Array:
        return chordal_distance(first, second, w, weight)

    def slope(frequency: float) -> float:
        w = np.array([frequency])
        s = 1j * w
        scale, bend = (np.ones(1), np.zeros(1)) if weight is None else (weight.magnitude(w), weight.log_slope(w))
        values = [plant(s) * scale for plant in (first, second)]
        rates = [1j * plant.log_derivative(s) + bend for plant in (first, second)]
        change = ((values[0] * rates[0] - values[1] * rates[1]) / (values[0] - values[1])).real
        for value, rate in zip(values, rates, strict=True):
            change = change - np.abs(value) ** 2 / (1.0 + np.abs(value) ** 2) * rate.real
        return float(change[0])

    w = plants_grid(first, second, DECADES)
    with np.errstate(divide="ignore", invalid="ignore"):  # identical plants: no slope, and a gap of zero
        best = highest_peak(magnitude, slope, w)
    for frequency, name in ((w[0] / BEYOND, 0.0), (w[-1] * BEYOND, float("inf"))):
        limit = float(magnitude(np.array([frequency]))[0])
        if limit > best.value:
            best = FrequencyPeak(limit, name)
    return FrequencyPeak(min(best.value, 1.0), best.frequency)


def _mirrored(polynomial: Array) -> Array:
    """Return the coefficients of p(-s)."""
    degrees = np.arange(polynomial.size - 1, -1, -1)
    return np.asarray(polynomial * (-1.0) ** degrees)


def _require_rational(*plants: Plant) -> None:
    for plant in plants:
        checks.instance("a plant of the gap", plant, Plant, "a Plant")
        if not plant.is_rational:
            msg = f"the winding condition needs plants that are rational up to a dead time, not {plant!r}"
            raise LoopError(msg)

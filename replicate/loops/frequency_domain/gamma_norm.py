r"""The norm gamma of H-infinity loop shaping, and the generalised stability margin 1/gamma.

With load disturbance l and measurement noise n, a single loop has the closed-loop transfer matrix

.. math:: H = \frac{1}{1 + G G_c} \begin{bmatrix} -G G_c & G W \\ -G_c W^{-1} & 1 \end{bmatrix}

where W is a frequency weight. H has rank one, so its only nonzero singular value is

.. math:: \sigma^2 = \frac{(1 + |G_c/W|^2)(1 + |G W|^2)}{|1 + G G_c|^2}

and gamma is its supremum over all frequencies. The weight that makes it smallest at every frequency is
:math:`|W| = \sqrt{|G_c|/|G|}`; then :math:`\sigma = (1 + |L|)/|1 + L|` depends on the loop transfer function L alone.

References: McFarlane and Glover, IEEE Trans. Automatic Control 37 (1992) 759-769; Panagopoulos, thesis (2000),
paper III, (4) to (12); Vinnicombe, "Uncertainty and Feedback" (2001), chapter 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.frequency_grids import bands_beyond, peak_grid, wide_grid
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.frequency_domain.sensitivity import highest_peak
from replicate.loops.loop import Loop
from replicate.loops.numerics.peaks import FrequencyPeak
from replicate.loops.plant import Plant

Array = NDArray[np.float64]

DECADES = 6  # how far the search goes beyond the corners of the loop, towards both limits
FAR = 1e12  # where a limit at zero or infinite frequency is evaluated, relative to the search band
APART = np.array([1.0, 1.3, 1.7, 2.3])  # places there, at which a weight that has a limit is the same
SAME = 1e-9  # relative difference that is rounding
ROUNDING = 1e-13  # a value this close to a limit is the limit
UNBOUNDED = 1e4  # growth between the end of the band and the limit that means "no bound"


@dataclass(frozen=True)
class Weight:
    """The magnitude of a frequency weight, and its slope d(log |W|)/dw, both over positive frequencies.

    Attributes
    ----------
    magnitude
        |W| over positive frequencies, in rad per unit of time.
    log_slope
        d(log |W|)/dw over the same frequencies.
    """

    magnitude: Callable[[Array], Array]
    log_slope: Callable[[Array], Array]

    @classmethod
    def constant(cls, value: float) -> Weight:
        """Return a constant weight.

        Parameters
        ----------
        value
            |W| > 0.

        Raises
        ------
        LoopError
            If the value is not a positive finite number.
        """
        value = checks.positive("a constant weight", value, allowed="a positive number")
        return cls(lambda w: np.full_like(w, value), np.zeros_like)

    @classmethod
    def balancing(cls, plant: Plant, controller: PID) -> Weight:
        r"""Return :math:`|W| = \sqrt{|G_c|/|G|}`, the weight that makes gamma smallest at every frequency (8).

        Parameters
        ----------
        plant, controller
            G and Gc.
        """
        loop = Loop(plant, controller)

        def magnitude(w: Array) -> Array:
            return np.asarray(np.sqrt(np.abs(controller.feedback(1j * w) / plant(1j * w))))

        def log_slope(w: Array) -> Array:
            # log |Gc| - log |G| = log |L| - 2 log |G|
            s = 1j * w
            return np.asarray(0.5 * (1j * (loop.transfer.log_derivative(s) - 2.0 * plant.log_derivative(s))).real)

        return cls(magnitude, log_slope)


def magnitude_of(weight: Weight | None, w: Array) -> Array:
    """Return |W| at frequencies; 1 without a weight."""
    if weight is None:
        return np.ones_like(w)
    checks.instance("the weight", weight, Weight, "a Weight")
    return weight.magnitude(w)


def singular_value(plant: Plant, controller: PID, w: Array, weight: Weight | None = None) -> Array:
    """Return the nonzero singular value of the closed loop's transfer matrix at frequencies ``w`` > 0.

    Parameters
    ----------
    w : array, any shape
        Frequencies, rad per unit of time.
    weight
        Default: none (W = 1).
    """
    w = checks.times("w", w)
    scale = magnitude_of(weight, w)
    g, gc = plant(1j * w), controller.feedback(1j * w)
    return np.asarray(np.hypot(1.0, np.abs(gc) / scale) * np.hypot(1.0, np.abs(g) * scale) / np.abs(1.0 + g * gc))


def gamma_norm(plant: Plant, controller: PID, weight: Weight | None = None) -> FrequencyPeak:
    r"""Return gamma, the H-infinity norm of the closed loop's transfer matrix, with the frequency of its peak.

    Parameters
    ----------
    plant, controller
        The loop; only the feedback part of the controller counts.
    weight
        `Weight.balancing` for the favourable weight, `Weight.constant`, or any other; default none (W = 1).

    Returns
    -------
    FrequencyPeak
        At least 1; ``inf`` at infinite frequency if the norm is unbounded (an ideal derivative without weight). The
        frequency is 0 or ``inf`` where the supremum is a limit.

    Raises
    ------
    UnstableLoopError
        If the loop is unstable.
    LoopError
        If \|L\| does not vanish at infinite frequency, and what it does there, or the weight, leaves only a bound.

    Examples
    --------
    An integrator under unit feedback: every entry of the matrix is a first-order low- or high-pass.

    >>> from replicate.loops import PI
    >>> plant, controller = Plant([1.0], [1.0, 0.0]), PI(1.0)
    >>> round(gamma_norm(plant, controller), 12)
    1.414213562373
    """
    loop = Loop(plant, controller)
    poles = loop.poles()
    loop.sensitivity_peak()  # raises for an unstable loop
    transfer = loop.transfer

    def magnitude(w: Array) -> Array:
        return singular_value(plant, controller, w, weight)

    def slope(frequency: float) -> float:
        w = np.array([frequency])
        s = 1j * w
        scale, bend = (np.ones(1), np.zeros(1)) if weight is None else (weight.magnitude(w), weight.log_slope(w))
        whole, part = transfer.log_derivative(s), plant.log_derivative(s)
        noise = (np.abs(controller.feedback(s)) / scale) ** 2
        load = (np.abs(plant(s)) * scale) ** 2
        value = transfer(s)
        change = (
            noise / (1.0 + noise) * ((1j * (whole - part)).real - bend)
            + load / (1.0 + load) * ((1j * part).real + bend)
            - (1j * whole * value / (1.0 + value)).real
        )
        return float(change[0])

    def bound(w: Array) -> Array:
        """Return what the magnitude may be whatever the phase of L."""
        value = transfer(1j * w)
        with np.errstate(divide="ignore"):
            return np.asarray(magnitude(w) * np.abs(1.0 + value) / np.maximum(1.0 - np.abs(value), 0.0))

    end = transfer.beyond(0.5 * (1.0 + transfer.feedthrough))
    w = wide_grid(transfer, end, poles, DECADES)
    best = highest_peak(magnitude, slope, w)
    at_rest, at_infinity = (_limit(magnitude, at) for at in (w[0] / FAR, w[-1] * FAR))
    if transfer.limit_curve.delayed.size:
        near, far = end * APART, w[-1] * FAR * APART
        noise = [np.abs(controller.feedback(1j * part)) / magnitude_of(weight, part) for part in (near, far)]
        balanced = bool(np.allclose(noise[0] ** 2, np.abs(transfer(1j * near)), rtol=SAME, atol=0.0))
        at_infinity = _neutral_limit(transfer, far, noise[1], balanced=balanced)
    ahead = np.geomspace(1.0, 10.0**DECADES, 20 * DECADES)
    for start, stop in bands_beyond(transfer, end):
        if np.max(bound(start * ahead)) <= max(best.value, at_infinity) * (1.0 + ROUNDING):
            break
        best = max(best, highest_peak(magnitude, slope, peak_grid(transfer, stop, poles, start)))
    for limit, name in ((at_rest, 0.0), (at_infinity, float("inf"))):
        if np.isfinite(limit) and limit < best.value * (1.0 - ROUNDING):
            continue
        if name > 0.0 and not transfer.limit_curve.reached:
            transfer.limit_curve.refuse("norm gamma")
        grows = not np.isfinite(limit) or limit > UNBOUNDED * best.value
        best = FrequencyPeak(float("inf") if grows else limit, name)
    return best


def _limit(magnitude: Callable[[Array], Array], frequency: float) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        return float(magnitude(np.array([frequency]))[0])


def _neutral_limit(transfer: LoopTransfer, far: Array, gc: Array, *, balanced: bool) -> float:
    """Return the largest singular value at infinite frequency, where L keeps turning, and with it G.

    ``gc`` is |Gc/W| at the frequencies ``far``; with the balancing weight it is sqrt(|L|) everywhere.
    """
    curve, first = transfer.limit_curve, float(gc[0])
    if balanced:
        return curve.highest_anywhere(lambda value: (1.0 + np.abs(value)) / np.abs(1.0 + value))
    if np.allclose(gc, first, rtol=SAME, atol=0.0):
        return curve.highest(
            lambda value: np.hypot(1.0, first) * np.hypot(1.0, np.abs(value) / first) / np.abs(1.0 + value)
        )
    value = transfer(1j * far)
    sizes = np.hypot(1.0, gc) * np.hypot(1.0, np.abs(value) / gc) / np.abs(1.0 + value)
    if np.all(sizes > UNBOUNDED):
        return float("inf")
    msg = "the weight must have a limit at infinite frequency, or be the balancing one, where |L| does not vanish there"
    raise LoopError(msg)


def stability_margin(plant: Plant, controller: PID, weight: Weight | None = None) -> float:
    """Return the generalised stability margin b = 1/gamma, between 0 and 1; 0 for an unstable loop.

    Parameters
    ----------
    plant, controller
        The loop.
    weight
        As for `gamma_norm`.
    """
    if not Loop(plant, controller).is_stable():
        return 0.0
    return 1.0 / gamma_norm(plant, controller, weight).value

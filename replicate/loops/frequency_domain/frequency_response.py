r"""Frequency responses of a loop as data: Bode, Nyquist, and the four transfer functions of its errors.

.. math:: S = \frac{1}{1+L}, \quad T = \frac{L}{1+L}, \quad PS = \frac{P}{1+L}, \quad CS = \frac{C}{1+L}

S is what feedback does to an output disturbance, T to the measurement noise (with the sign changed), PS is the response
of the output to a load at the plant input, CS that of the control signal to noise. The dead time is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import checks
from replicate.loops.errors import LoopError
from replicate.loops.evaluation import quotient, values
from replicate.loops.records import Record

if TYPE_CHECKING:
    from replicate.loops.loop import Loop

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

LARGEST_TURN = 0.7  # rad between neighbouring points, with which the branch of the phase is certain
DEEPEST = 40
AT_REST = 1e-6  # of the lowest corner: where the phase is followed from


@dataclass(frozen=True, eq=False)
class Bode(Record):
    """Magnitude and phase of L(i w).

    Attributes
    ----------
    frequency : array, shape (n,)
        Angular frequencies, rad per unit of time.
    magnitude : array, shape (n,)
        The absolute value of L, not in decibels.
    phase : array, shape (n,)
        In degrees, continuous in the frequency: it goes on below -180.
    """

    frequency: Array
    magnitude: Array
    phase: Array

    @property
    def decibels(self) -> Array:
        """20 log10 of the magnitude."""
        return np.asarray(20.0 * np.log10(self.magnitude))


def bode(loop: Loop, w: ArrayLike) -> Bode:
    """Return magnitude and continuous phase of L at frequencies ``w`` > 0 of any order.

    The phase starts, as w tends to zero, at -90 degrees for each integrator, and 180 degrees lower if L is negative
    there. The turn of the dead time is added exactly; the rest is followed along the axis in steps small enough to be
    unambiguous.

    Raises
    ------
    LoopError
        If a frequency is not a positive finite number.
    """
    frequency = checked_frequencies(w)
    if not frequency.size:
        return Bode(frequency, frequency, frequency)
    value = loop(1j * frequency)
    ordered = np.unique(frequency)
    phase = _continuous_phase(loop, ordered)[np.searchsorted(ordered, frequency)]
    return Bode(frequency, np.abs(value), np.degrees(phase - frequency * loop.plant.dead_time))


def nyquist(loop: Loop, w: ArrayLike) -> ComplexArray:
    """Return L(i w), the points of the Nyquist curve, at frequencies ``w`` > 0."""
    return loop(1j * checked_frequencies(w))


def sensitivity(loop: Loop, s: ArrayLike) -> ComplexArray:
    """Return S(s) = 1/(1 + L)."""
    return values(lambda s: 1.0 / (1.0 + loop(s)), s)


def complementary(loop: Loop, s: ArrayLike) -> ComplexArray:
    """Return T(s) = L/(1 + L), formed so that it is exact where L is large, too."""
    return values(lambda s: 1.0 / (1.0 + _inverse(loop(s))), s)


def load_sensitivity(loop: Loop, s: ArrayLike) -> ComplexArray:
    """Return PS(s) = P/(1 + L) = 1/(1/P + C), from a load at the plant input to the output."""
    return values(lambda s: 1.0 / (_inverse(loop.plant(s)) + loop.controller.feedback(s)), s)


def noise_sensitivity(loop: Loop, s: ArrayLike) -> ComplexArray:
    """Return CS(s) = C/(1 + L), C being the feedback part of the controller with its measurement filter."""
    return values(lambda s: 1.0 / (_inverse(loop.controller.feedback(s)) + loop.plant(s)), s)


def _inverse(value: ComplexArray) -> ComplexArray:
    return quotient(np.ones_like(value), value)


def checked_frequencies(w: ArrayLike) -> Array:
    """Return frequencies as an array; LoopError unless all are positive and finite."""
    try:
        frequency = checks.times("w", w)
    except LoopError:
        frequency = np.array([np.nan])
    if not (np.isfinite(frequency).all() and (frequency > 0.0).all()):
        msg = "frequencies must be positive finite numbers, in rad per unit of time"
        raise LoopError(msg)
    return frequency


def _continuous_phase(loop: Loop, w: Array) -> Array:
    """Return arg(L e^{iwL}) in rad along ascending frequencies, from its limit at low frequency on."""
    start = AT_REST * _lowest_corner(loop, w)
    grid = np.union1d(np.geomspace(min(start, w[0]), w[-1], 400), w)
    value = _without_delay(loop, grid)
    for _ in range(DEEPEST):
        coarse = np.nonzero(np.abs(np.angle(value[1:] / value[:-1])) > LARGEST_TURN)[0]
        if coarse.size == 0:
            break
        middle = np.sqrt(grid[coarse] * grid[coarse + 1])
        grid = np.insert(grid, coarse + 1, middle)
        value = np.insert(value, coarse + 1, _without_delay(loop, middle))
    turns = np.concatenate([[0.0], np.cumsum(np.angle(value[1:] / value[:-1]))])
    phase = _anchor(loop, value[0]) + turns
    return np.asarray(phase[np.searchsorted(grid, w)])


def _without_delay(loop: Loop, w: Array) -> ComplexArray:
    return np.asarray(loop(1j * w) * np.exp(1j * w * loop.plant.dead_time))


def _lowest_corner(loop: Loop, w: Array) -> float:
    corners = [float(w[0]), abs(loop.controller.ki / loop.controller.k) if loop.controller.k else np.inf]
    if loop.plant.is_rational:
        roots = np.abs(np.concatenate([loop.plant.poles(), loop.plant.zeros()]))
        corners += roots[roots > 0.0].tolist()
    return min(corner for corner in corners if corner > 0.0)


def _anchor(loop: Loop, value: complex) -> float:
    """Return the phase at the lowest frequency on the branch that integrators and sign of L prescribe."""
    principal = float(np.angle(value))
    integrators = loop.plant.integrators + (1 if loop.controller.ki else 0)
    expected = -0.5 * np.pi * integrators
    if np.real(value * 1j**integrators) < 0.0:
        expected -= np.pi
    return principal + 2.0 * np.pi * round((expected - principal) / (2.0 * np.pi))

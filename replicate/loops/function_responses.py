r"""Responses of loops around plants given by a function: how long they last, what their transforms say of their ends.

Where the function has no branch point at rest, the slowest of the poles and of the cut's beginning gives the rate of
decay. Else the error falls like a power of time, and its integral over all time is the limit at rest of

.. math:: \frac{y_\infty - s Y(s)}{s} = \frac{y_\infty (1 + CG) - (r F + d) G}{s (1 + CG)} .
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import inversion
from replicate.loops.control_signal import control_signal
from replicate.loops.controller import PID
from replicate.loops.function_plant import limit_of_roots
from replicate.loops.loop_transfer import LoopTransfer
from replicate.loops.pole_starts import begin_of_cut

if TYPE_CHECKING:
    from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

AT_REST = 1e-4  # of the rate of the slowest mode: a cut that begins closer to s = 0 begins there
NEAR, NEARER = 1e-26, 1e-28  # of the loop's unit of frequency: where a limit at rest is taken
AGREE = 1e-12  # relative difference of two values that are one limit,
FITS = 1e-9  # and of two limits of fits
GROWS = 1.1  # factor by which an integral without a limit grows between two frequencies


def pace(poles: ComplexArray) -> float:
    """Return the time constant of the slowest mode, in the loop's units; 1 if it has no mode."""
    return 1.0 / abs(poles[0].real) if poles.size and poles[0].real else 1.0


def decay(transfer: LoopTransfer, poles: ComplexArray) -> float:
    """Return the rate at which responses decay in the end, or 0 if they end like a power of time."""
    begin = begin_of_cut(transfer, 1.0 / pace(poles))
    if begin < AT_REST / pace(poles):
        return 0.0
    return min(begin, abs(poles[0].real)) if poles.size else begin if np.isfinite(begin) else 0.0


def respond(
    transfer: LoopTransfer, controller: PID, poles: ComplexArray, inputs: tuple[float, float], end: float, unit: float
) -> tuple[Array, Array, Array, Array]:
    """Return breaks and Chebyshev coefficients of output and control signal, by inversion.

    Parameters
    ----------
    transfer, controller, poles
        The loop, its controller and its rightmost poles, in the loop's units.
    inputs
        Heights of the steps of set-point and load.
    end
        Horizon.
    unit
        The user's unit of time over the loop's, for messages.
    """
    plant, (setpoint, load) = transfer.plant, inputs
    size = max(abs(setpoint), abs(load)) or 1.0  # the quadrature's tolerance is absolute

    def forward(s: ArrayLike) -> ComplexArray:
        s = np.asarray(s, dtype=complex)
        drive = setpoint / size * controller.feedforward(s) + load / size
        return np.asarray(drive * plant.delay_free(s) / s)

    closed = inversion.ClosedLoop(transfer, forward, poles, unit)
    breaks, y = inversion.respond(closed, end, pace(poles))
    y = y * size
    return breaks, y, *control_signal(controller, breaks, y, setpoint)


def total_error(plant: Plant, controller: PID, setpoint: float, load: float, final: float) -> float:
    """Return the integral of final - y over all time: ``inf`` if it has none, ``nan`` if it cannot be told."""
    if not np.isfinite(final):
        return float("nan")

    def error(at: ArrayLike) -> Array:
        return _error(plant, controller, setpoint, load, final, np.asarray(at, dtype=complex))

    near, nearer = error([NEAR, NEARER])
    if abs(near - nearer) <= AGREE * abs(nearer):
        return float(nearer)
    fitted = [limit_of_roots(error, reach) for reach in (0.1, 0.03)]
    if abs(fitted[0] - fitted[1]) <= FITS * abs(fitted[1]):
        return fitted[1]
    near, nearer = np.abs(error([1e-5, 1e-7]))
    return float("inf") if nearer > GROWS * near else float("nan")


def _error(plant: Plant, controller: PID, setpoint: float, load: float, final: float, s: ComplexArray) -> Array:
    """Return the transform of final - y close to rest; where the set-point is reached, nothing cancels in it."""
    path = plant(s)
    closed = s * (1.0 + controller.feedback(s) * path)
    if final == setpoint:  # y_inf (1 + C G) - r F G = r (1 + (C - F) G)
        top = setpoint * (1.0 + _feedback_less_feedforward(controller, s) * path) - load * path
    else:
        top = final * closed / s - (setpoint * controller.feedforward(s) + load) * path
    return np.asarray((top / closed).real)


def _feedback_less_feedforward(controller: PID, s: ComplexArray) -> ComplexArray:
    """Evaluate C - F from one fraction, in which the integral parts cancel exactly."""
    lag = np.array([controller.derivative_filter, 1.0]) if controller.derivative_filter else np.ones(1)
    below = np.polymul([1.0, 0.0], lag)
    slope = np.array([controller.kd, 0.0, 0.0])

    def parallel(b: float, c: float) -> Array:
        proportional = np.polymul([b * controller.k, controller.ki], lag)
        return np.asarray(np.polyadd(proportional, c * slope), dtype=float)

    (fn, fd), (gn, gd) = controller.measurement_filter_polynomials(), controller.setpoint_filter_polynomials()
    feedback = np.polymul(np.polymul(parallel(1.0, 1.0), fn), gd)
    feedforward = np.polymul(np.polymul(parallel(controller.b, controller.c), gn), fd)
    top = np.asarray(np.polyadd(feedback, -feedforward), dtype=float)
    below = np.polymul(np.polymul(below, fd), gd)
    shared = min(
        polynomial.size - np.trim_zeros(polynomial, "b").size for polynomial in (top, below) if polynomial.any()
    )
    top, below = top[: top.size - shared], below[: below.size - shared]
    return np.asarray(np.polyval(top, s) / np.polyval(below, s))

r"""Responses of loops around plants given by a function: how long they last, what their transforms say of their ends.

Where the function has no branch point at rest, the slowest of the poles and of the cut's beginning gives the rate of
decay. Else the error falls like a power of time, and its integral over all time is the limit at rest of

.. math:: \frac{y_\infty - s Y(s)}{s} = \frac{y_\infty + (y_\infty C - r F - d) G}{s (1 + CG)} .
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops import inversion
from replicate.loops.control_signal import control_signal
from replicate.loops.controller import PID
from replicate.loops.function_plant import limit_of_roots
from replicate.loops.function_poles import begin_of_cut
from replicate.loops.loop_transfer import LoopTransfer

if TYPE_CHECKING:
    from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

AT_REST = 1e-4  # of the rate of the slowest mode: a cut that begins closer to s = 0 begins there
NEAR, NEARER = 1e-130, 1e-140  # of the loop's unit of frequency: where a limit at rest is taken
CANCELS = 1e-3  # share of its parts below which the error's transform has lost digits that matter
LOST = 1e-6  # relative error of the gain of a function that has lost its digits at rest
ROUNDING = 1e-14  # of the parts of a coefficient that cancels
AGREE = 1e-12  # relative difference of two values that are one limit,
FITS = 1e-9  # and of two limits of fits
SAME_POWER, LEAST_POWER = 0.1, 0.02  # relative difference of two exponents that are one, and the least one can see


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

    def forward(s: ArrayLike) -> ComplexArray:
        s = np.asarray(s, dtype=complex)
        drive = setpoint * controller.feedforward(s) + load
        return np.asarray(drive * plant.delay_free(s) / s)

    closed = inversion.ClosedLoop(transfer, forward, poles, pace(poles), unit)
    breaks, y = inversion.respond(closed, end)
    return breaks, y, *control_signal(controller, breaks, y, setpoint)


def total_error(plant: Plant, controller: PID, setpoint: float, load: float, final: float) -> float:
    """Return the integral of final - y over all time: ``inf`` if it has none, ``nan`` if it cannot be told."""
    if not np.isfinite(final):
        return float("nan")
    num, den = _weight(controller, setpoint, load, final)

    def parts(at: ArrayLike) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        s = np.asarray(at, dtype=complex)
        path = plant(s)
        weighted = np.polyval(num, s) / np.polyval(den, s) * path
        return np.full_like(s, final), np.asarray(weighted), s * (1.0 + controller.feedback(s) * path)

    def error(at: ArrayLike) -> Array:
        constant, weighted, closed = parts(at)
        return np.asarray(((constant + weighted) / closed).real)

    constant, weighted, _ = parts([NEAR])
    unlike = abs(constant + weighted)[0] > CANCELS * (abs(constant) + abs(weighted))[0]
    if unlike and _is_at_rest(plant):
        near, nearer = error([NEAR, NEARER])
        if abs(near - nearer) <= AGREE * abs(nearer):
            return float(nearer)
    fitted = [limit_of_roots(error, reach) for reach in (0.1, 0.03)]
    if abs(fitted[0] - fitted[1]) <= FITS * abs(fitted[1]):
        return fitted[1]
    # what falls or grows like one power of s over all of these frequencies does so on the way to rest
    far, near = np.log10(np.abs(error([1e-2, 1e-3, 1e-5, 1e-6]))).reshape(2, 2)
    exponent, nearer = far[0] - far[1], near[0] - near[1]
    if abs(exponent - nearer) > SAME_POWER * abs(nearer) or abs(nearer) < LEAST_POWER:
        return float("nan")
    return 0.0 if nearer > 0.0 else float("inf")


def _is_at_rest(plant: Plant) -> bool:
    """Return whether the function has its limit at rest there, where one that cancels has lost all its digits."""
    gain, there = plant.gain, complex(plant(NEAR))
    return bool(abs(there - gain) <= LOST * abs(gain)) if np.isfinite(gain) else np.isinf(gain)


def _weight(controller: PID, setpoint: float, load: float, final: float) -> tuple[Array, Array]:
    """Return y_inf C - r F - d as one fraction, in which what cancels at rest cancels exactly."""
    lag = np.array([controller.derivative_filter, 1.0]) if controller.derivative_filter else np.ones(1)
    slope = np.array([controller.kd, 0.0, 0.0])

    def parallel(b: float, c: float) -> Array:
        proportional = np.polymul([b * controller.k, controller.ki], lag)
        return np.asarray(np.polyadd(proportional, c * slope), dtype=float)

    (fn, fd), (gn, gd) = controller.measurement_filter_polynomials(), controller.setpoint_filter_polynomials()
    below = np.polymul(np.polymul(np.polymul([1.0, 0.0], lag), fd), gd)
    terms = [
        final * np.polymul(np.polymul(parallel(1.0, 1.0), fn), gd),
        -setpoint * np.polymul(np.polymul(parallel(controller.b, controller.c), gn), fd),
        -load * below,
    ]
    longest = max(term.size for term in terms)
    terms = [np.pad(term, (longest - term.size, 0)) for term in terms]
    top = np.sum(terms, axis=0)
    top[np.abs(top) <= ROUNDING * np.sum(np.abs(terms), axis=0)] = 0.0
    if not top.any():
        return np.zeros(1), np.ones(1)
    shared = min(polynomial.size - np.trim_zeros(polynomial, "b").size for polynomial in (top, below))
    return top[: top.size - shared], below[: below.size - shared]

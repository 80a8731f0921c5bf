r"""Responses of loops around plants given by a function: how long they last, what their transforms say of their ends.

Where the function has no branch point at rest, the slowest of the poles and of the cut's beginning gives the rate of
decay. Else the error falls like a power of time, and its integral over all time is the limit at rest of

.. math:: \frac{y_\infty - s Y(s)}{s} = \frac{y_\infty + (y_\infty C - r F - d) G}{s (1 + CG)} .
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.loops.controller import PID
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.plants.at_rest import slope_at_rest, value_at_rest
from replicate.loops.plants.cut import begin_of_cut
from replicate.loops.time_domain import inversion
from replicate.loops.time_domain.control_signal import control_signal

if TYPE_CHECKING:
    from replicate.loops.plants.function_plant import FunctionPlant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

AT_REST = 1e-4  # of the rate of the slowest mode: a cut that begins closer to s = 0 begins there


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


def total_error(plant: FunctionPlant, controller: PID, setpoint: float, load: float, final: float) -> float:
    """Return the integral of final - y over all time: ``inf`` if it has none, ``nan`` if it cannot be told."""
    if not np.isfinite(final):
        return float("nan")
    gain, k, ki, kd = plant.gain, controller.k, controller.ki, controller.kd
    (m, m_slope), (f, f_slope) = (
        _value_and_slope(*polynomials)
        for polynomials in (controller.measurement_filter_polynomials(), controller.setpoint_filter_polynomials())
    )
    # y_inf C - r F - d at rest, where its integral parts cancel
    weight = final * (k * m + ki * m_slope) - setpoint * (controller.b * k * f + ki * f_slope) - load
    if ki:
        return float((final / gain + weight) / (ki * m))
    bend = final * (k * m_slope + kd * m) - setpoint * (controller.b * k * f_slope + controller.c * kd * f)
    low, _ = plant.corners
    if np.isinf(gain):
        with np.errstate(divide="ignore"):
            return float((final / np.float64(value_at_rest(lambda s: s * plant.delay_free(s), low)) + bend) / (k * m))
    # values at rest cancel, too, and slopes remain
    slope = slope_at_rest(plant.delay_free, low) - plant.dead_time * gain
    return float((bend * gain + weight * slope) / (1.0 + k * m * gain))


def _value_and_slope(num: Array, den: Array) -> tuple[float, float]:
    """Return value and slope at s = 0 of a filter."""
    (rise, value), (lag, scale) = (np.append(np.zeros(2), polynomial)[-2:] for polynomial in (num, den))
    return float(value / scale), float((rise - value / scale * lag) / scale)

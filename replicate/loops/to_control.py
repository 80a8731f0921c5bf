"""Plants, controllers and loops as python-control transfer functions, the dead time as a Padé approximation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant

if TYPE_CHECKING:
    from replicate.loops.loop import Loop

Array = NDArray[np.float64]
Transfer = Any  # control.TransferFunction: python-control publishes no types
Kind = Literal["setpoint", "load", "loop"]


def plant_to_control(plant: Plant, pade: int | None = None) -> Transfer:
    """Return a rational plant as a python-control transfer function.

    Parameters
    ----------
    pade
        Order of the Padé approximation, numerator and denominator; needed if the plant has dead time.

    Raises
    ------
    LoopError
        If the plant is not one rational function, or has dead time and no order >= 1 is given.
    """
    import control

    return control.tf(*_polynomials(plant, pade))


def controller_to_control(controller: PID) -> Transfer:
    """Return the feedback part of a controller, from -y to u, as a transfer function; improper if it is."""
    import control

    num, den = controller.feedback_polynomials()
    return control.tf(num, den)


def loop_to_control(loop: Loop, pade: int | None = None, response: Kind = "setpoint") -> Transfer:
    """Return a closed loop as a transfer function.

    Parameters
    ----------
    pade
        Order of the Padé approximation.
    response
        From the set-point or from a load at the plant input to the output, or the open ``loop`` L.

    Raises
    ------
    LoopError
        As `plant_to_control`; or if the response is none of the three.
    """
    import control

    if response not in {"setpoint", "load", "loop"}:
        msg = f"the response must be setpoint, load or loop, not {response!r}"
        raise LoopError(msg)
    num, den = _polynomials(loop.plant, pade)
    over, under = loop.controller.feedback_polynomials()
    if response == "loop":
        return control.tf(np.polymul(num, over), np.polymul(den, under))
    characteristic = np.polyadd(np.polymul(den, under), np.polymul(num, over))
    if response == "load":
        return control.tf(np.polymul(num, under), characteristic)
    # the same controller acting on r: its denominator without the measurement filter divides that of the feedback
    forward, measured = _feedforward(loop.controller)
    filter_num, filter_den = loop.controller.setpoint_filter_polynomials()
    top = np.polymul(np.polymul(num, forward), np.polymul(measured, filter_num))
    return control.tf(top, np.polymul(characteristic, filter_den))


def _feedforward(controller: PID) -> tuple[Array, Array]:
    """Return the numerator from r to u over the common denominator, and the denominator of the measurement filter."""
    integral = np.array([1.0, 0.0]) if controller.ki else np.array([1.0])
    lag = np.array([controller.derivative_filter, 1.0]) if controller.kd else np.array([1.0])
    proportional = np.polymul(integral, lag) * (controller.b * controller.k)
    slow = controller.ki * lag if controller.ki else np.zeros(1)
    fast = np.polymul([controller.c * controller.kd, 0.0], integral) if controller.kd else np.zeros(1)
    part = np.polyadd(np.polyadd(proportional, slow), fast)
    _, under = controller.feedback_polynomials()
    measured, _ = np.polydiv(under, np.trim_zeros(np.polymul(integral, lag), "f"))
    return np.asarray(part, dtype=float), np.asarray(measured, dtype=float)


def _polynomials(plant: Plant, pade: int | None) -> tuple[Array, Array]:
    import control

    if not plant.is_rational:
        msg = (
            f"only a plant that is one rational function with one dead time becomes a transfer function, not {plant!r}"
        )
        raise LoopError(msg)
    if not plant.dead_time:
        return plant.num, plant.den
    if not isinstance(pade, (int, np.integer)) or pade < 1:
        msg = (
            f"the plant has dead time {plant.dead_time:g}: give the order of its Padé approximation, pade=n with n >= 1"
        )
        raise LoopError(msg)
    num, den = control.pade(plant.dead_time, int(pade))
    return np.asarray(np.polymul(plant.num, num), dtype=float), np.asarray(np.polymul(plant.den, den), dtype=float)

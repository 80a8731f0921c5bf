"""Lambda tuning: the closed loop is given the time constant of choice."""

from __future__ import annotations

from replicate.loops import checks
from replicate.loops.controller import PI
from replicate.loops.plant import Plant
from replicate.loops.tune.models import exact_first_order

SOURCE = "E. B. Dahlin, Instruments and Control Systems 41(6) (1968) 77; K. J. Astrom, T. Hagglund, Advanced PID Control (2006), section 6.5"  # noqa: E501
VALIDITY = "K e^{-Ls}/(Ts+1) and K e^{-Ls}/s with L > 0; slow load responses where T is much longer than tau_cl"


def lambda_(plant: Plant, tau_cl: float | None = None) -> PI:
    r"""Return the PI controller that cancels the lag and gives the closed loop the time constant ``tau_cl``.

    .. math:: K = \frac{T}{K_p (\tau_{cl} + L)}, \qquad T_i = T

    and for an integrating plant :math:`K = (2\tau_{cl} + L)/(K_v (\tau_{cl} + L)^2)`, :math:`T_i = 2\tau_{cl} + L`.

    Parameters
    ----------
    plant
        First order, or integrating, with dead time.
    tau_cl
        Desired closed-loop time constant; by default the lag, for an integrating plant the dead time.

    Raises
    ------
    LoopError
        If the plant is not of first order with dead time, or tau_cl is negative.

    Examples
    --------
    K = 6/(2 (2 + 1)) = 1 with Ti = T:

    >>> controller = lambda_(Plant.foptd(2.0, 6.0, 1.0), tau_cl=2.0)
    >>> controller.k, controller.integral_time
    (1.0, 6.0)
    """
    model = exact_first_order(plant, "lambda tuning")
    L = model.dead_time
    default = L if model.integrators else model.time_constants[0]
    speed = default if tau_cl is None else checks.non_negative("tau_cl", tau_cl, allowed="a time >= 0")
    if model.integrators:
        integral = 2.0 * speed + L
        return PI.from_integral_time(integral / (model.gain * (speed + L) ** 2), integral)
    lag = model.time_constants[0]
    return PI.from_integral_time(lag / (model.gain * (speed + L)), lag)

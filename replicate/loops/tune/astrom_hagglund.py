"""AMIGO: approximate M-constrained integral gain optimisation."""

from __future__ import annotations

from replicate.loops.controller import PI, PID
from replicate.loops.plant import Plant
from replicate.loops.tune.models import exact_first_order
from replicate.loops.tune.rule_files import first_order_rules

SOURCE = "K. J. Astrom, T. Hagglund, J. Process Control 14 (2004) 635"
VALIDITY = "K e^{-Ls}/(Ts+1) and K e^{-Ls}/s with L > 0; PID is conservative for L/(L+T) below 0.3"


def amigo(plant: Plant, *, derivative: bool = False) -> PI | PID:
    r"""Return the AMIGO controller of a first-order or integrating plant with dead time.

    .. math::

        K = \frac{0.15}{K_p} + \Bigl(0.35 - \frac{LT}{(L+T)^2}\Bigr) \frac{T}{K_p L}, \qquad
        T_i = 0.35 L + \frac{13 L T^2}{T^2 + 12 L T + 7 L^2}

    and with ``derivative``

    .. math::

        K = \frac{1}{K_p}\Bigl(0.2 + 0.45 \frac{T}{L}\Bigr), \quad T_i = \frac{0.4 L + 0.8 T}{L + 0.1 T} L, \quad
        T_d = \frac{0.5 L T}{0.3 L + T}

    with set-point weight b = 0 where the lag dominates, L <= T, else 1. Integrating plants are the limits.

    Parameters
    ----------
    plant
        First order, or integrating, with dead time.
    derivative
        Whether the controller is a PID.

    Raises
    ------
    LoopError
        If the plant is not of first order with dead time.

    References
    ----------
    K. J. Åström and T. Hägglund, "Revisiting the Ziegler-Nichols step response method for PID control", J. Process
    Control 14 (2004) 635-650.

    Examples
    --------
    With K = T = L = 1: 0.15 + 0.35 - 1/4 = 0.25, and 0.35 + 13/20 = 1.

    >>> controller = amigo(Plant.foptd(1.0, 1.0, 1.0))
    >>> round(controller.k, 12), round(controller.integral_time, 12)
    (0.25, 1.0)
    """
    model = exact_first_order(plant, "AMIGO")
    L = model.dead_time
    if derivative and model.integrators:
        return PID.ideal(0.45 / (model.gain * L), 8.0 * L, 0.5 * L, b=0.0)
    if derivative:
        T = model.time_constants[0]
        gain = (0.2 + 0.45 * T / L) / model.gain
        integral = (0.4 * L + 0.8 * T) / (L + 0.1 * T) * L
        return PID.ideal(gain, integral, 0.5 * L * T / (0.3 * L + T), b=0.0 if L <= T else 1.0)
    rule = first_order_rules()["amigo-integrator" if model.integrators else "amigo"]
    gains = rule.evaluate(K=model.gain, L=L, **({} if model.integrators else {"tau": model.time_constants[0]}))
    return PI.from_integral_time(float(gains.kp), float(gains.ti))

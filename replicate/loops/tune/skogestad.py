"""SIMC, Skogestad's internal model control rules."""

from __future__ import annotations

from replicate.loops import checks
from replicate.loops.controller import PI, PID
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant
from replicate.loops.tune.models import half_rule, lag_model
from replicate.loops.tune.rule_files import first_order_rules

SOURCE = "S. Skogestad, J. Process Control 13 (2003) 291, eqs. (23)-(25) and table 1"
VALIDITY = "plants with real lags, integrators and dead time; tau_c >= 0, and tau_c = L for a good trade-off"


def simc(plant: Plant, tau_c: float | None = None, *, derivative: bool = False) -> PI | PID:
    r"""Return the SIMC controller for a desired closed-loop time constant.

    .. math:: K = \frac{T_1}{k (\tau_c + L)}, \qquad T_i = \min(T_1, 4 (\tau_c + L)), \qquad T_d = T_2

    in series form. A plant of higher order is reduced by the half rule to one lag, or to two with ``derivative``.
    Integrating plants are the limit T1 to infinity; a double integrator needs derivative action and always has it.

    Parameters
    ----------
    plant
        Gain, real lags, integrators and dead time, as for `lag_model`.
    tau_c
        Desired closed-loop time constant; by default the dead time of the reduced model.
    derivative
        Whether the controller is a PID.

    Raises
    ------
    LoopError
        If tau_c is negative, tau_c + L is zero, or the plant is not made of real lags.

    References
    ----------
    S. Skogestad, "Simple analytic rules for model reduction and PID controller tuning", J. Process Control 13 (2003)
    291-309.

    Examples
    --------
    >>> controller = simc(Plant.foptd(2.0, 10.0, 1.0), tau_c=1.0)
    >>> controller.k, controller.integral_time
    (2.5, 8.0)
    """
    double = lag_model(plant).integrators == 2
    model = half_rule(plant, 2 if derivative or double else 1)
    chosen = model.dead_time if tau_c is None else checks.non_negative("tau_c", tau_c, allowed=">= 0")
    if chosen + model.dead_time <= 0.0:
        msg = f"tau_c must be >= 0, and > 0 for a plant without dead time, not {tau_c}"
        raise LoopError(msg)
    speed = chosen + model.dead_time
    lags = model.time_constants
    if double:
        return PID.series(1.0 / (model.gain * 4.0 * speed**2), 4.0 * speed, 4.0 * speed)
    rules, symbols = first_order_rules(), {"K": model.gain, "L": model.dead_time, "tau_c": chosen}
    if model.integrators:
        gains = rules["simc-integrator"].evaluate(**symbols)
    elif lags:
        gains = min(
            (rules[id].evaluate(**symbols, tau=lags[0]) for id in ("simc", "simc-slow")), key=lambda one: one.ti
        )
    else:  # a dead time alone: the limit of small T1 is an integrating controller
        return PI(0.0, 1.0 / (model.gain * speed))
    gain, integral = float(gains.kp), float(gains.ti)
    second = lags[1 - model.integrators :]
    if derivative and second:
        return PID.series(gain, integral, second[0])
    return PI.from_integral_time(gain, integral)

"""Every rule of `classical_rules.toml`, applied to a plant."""

from __future__ import annotations

from replicate.loops.controller import PI
from replicate.loops.errors import LoopError
from replicate.loops.plant import Plant
from replicate.loops.tune.models import exact_first_order
from replicate.loops.tune.rule_files import PRINTED, classical_rules

SOURCE = "each record of classical_rules.toml names its own"
VALIDITY = "K e^{-Ls}/(Ts+1) with L > 0; each record names the range of L/T"


def by_name(plant: Plant, rule: str, variant: str = PRINTED) -> PI:
    """Return the PI controller of a classical rule.

    Parameters
    ----------
    plant
        First order with dead time.
    rule
        Its id: ``ziegler-nichols``, ``cohen-coon``, ``itae-setpoint``, ``ise-setpoint``.
    variant
        Another form of it that is in use, where there is one.

    Raises
    ------
    LoopError
        If there is no such rule, or the plant is not K e^{-Ls}/(Ts + 1) with dead time.

    Examples
    --------
    Ziegler and Nichols: 0.9 T/(K L) and, as most books print it, 3 L.

    >>> controller = by_name(Plant.foptd(1.0, 2.0, 0.9), "ziegler-nichols")
    >>> round(controller.k, 12), round(controller.integral_time, 12)
    (2.0, 2.7)
    """
    rules = classical_rules(variant)
    if rule not in rules:
        msg = f"there is no classical rule {rule!r}; allowed are {', '.join(rules)}"
        raise LoopError(msg)
    model = exact_first_order(plant, rules[rule].name)
    if model.integrators:
        msg = f"{rules[rule].name} is made for K e^{{-Ls}}/(Ts+1), not for an integrating plant"
        raise LoopError(msg)
    gains = rules[rule].evaluate(K=model.gain, tau=model.time_constants[0], L=model.dead_time)
    return PI.from_integral_time(float(gains.kp), float(gains.ti))

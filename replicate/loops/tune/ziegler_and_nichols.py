"""Ziegler and Nichols' two methods."""

from __future__ import annotations

import math
from typing import Literal

from replicate.loops.controller import PI, PID
from replicate.loops.errors import LoopError
from replicate.loops.loop import Loop
from replicate.loops.plant import Plant
from replicate.loops.tune.models import direction, exact_first_order
from replicate.loops.tune.rule_files import classical_rules

SOURCE = "J. G. Ziegler, N. B. Nichols, Trans. ASME 64 (1942) 759"
VALIDITY = "0.1 < L/T < 1; a decay ratio of 1/4 was the aim, so the loops ring"

Kind = Literal["P", "PI", "PID"]

#: The PI rules are records of `classical_rules.toml`. Step response: K in units of T/(K L), Ti and Td in units of L.
STEP: dict[str, tuple[float, float, float]] = {"P": (1.0, math.inf, 0.0), "PID": (1.2, 2.0, 0.5)}
#: Stability limit: K in units of the ultimate gain, Ti and Td in units of the ultimate period.
ULTIMATE: dict[str, tuple[float, float, float]] = {"P": (0.5, math.inf, 0.0), "PID": (0.6, 0.5, 0.125)}


def ziegler_nichols(plant: Plant, kind: Kind = "PI", *, method: Literal["step", "ultimate"] = "step") -> PI | PID:
    """Return the Ziegler-Nichols controller, by the step response or by the stability limit.

    Parameters
    ----------
    plant
        As the method demands.
    kind
        ``P``, ``PI`` or ``PID`` (ideal form).
    method
        ``step`` for a first-order or integrating plant with dead time, whose steepest tangent is exact; ``ultimate``
        for any plant that proportional control brings to the limit of stability.

    Raises
    ------
    LoopError
        If the plant does not suit the method, or kind or method is another word.

    Examples
    --------
    Of the step response: 1.2 T/(K L), 2 L and L/2.

    >>> controller = ziegler_nichols(Plant.foptd(1.0, 5.0, 2.0), "PID")
    >>> controller.k, controller.integral_time, controller.derivative_time
    (3.0, 4.0, 1.0)
    """
    if kind not in {"P", "PI", "PID"} or method not in {"step", "ultimate"}:
        msg = f"kind must be P, PI or PID and method step or ultimate, not {kind!r} and {method!r}"
        raise LoopError(msg)
    if method == "ultimate":
        unit, period = ultimate(plant)
        rule, symbols = classical_rules("ultimate-gain"), {"Ku": unit, "Tu": period}
    else:
        model = exact_first_order(plant, "the step response method")
        period = model.dead_time
        lag = model.time_constants[0] if model.time_constants else 1.0  # of an integrator only gain/lag counts
        unit = lag / (model.gain * period)
        rule, symbols = classical_rules("original"), {"K": model.gain, "tau": lag, "L": period}
    if kind == "PI":
        gains = rule["ziegler-nichols"].evaluate(**symbols)
        return PI.from_integral_time(float(gains.kp), float(gains.ti))
    gain, integral, derivative = (STEP if method == "step" else ULTIMATE)[kind]
    if kind == "P":
        return PI(gain * unit)
    return PID.ideal(gain * unit, integral * period, derivative * period)


def ultimate(plant: Plant) -> tuple[float, float]:
    """Return gain and period at which proportional control brings a stable or integrating plant to its limit.

    Parameters
    ----------
    plant
        Any stable or integrating plant.

    Raises
    ------
    LoopError
        If no small gain stabilises the plant, or no large one makes it unstable.

    Examples
    --------
    An integrator with unit dead time: the phase is -180 degrees at pi/2, where 1/w is 2/pi.

    >>> gain, period = ultimate(Plant([1.0], [1.0, 0.0], dead_time=1.0))
    >>> round(gain / (math.pi / 2), 12), round(period, 12)
    (1.0, 4.0)
    """
    static = plant.gain
    size = 1e-3 / abs(static) if math.isfinite(static) and static else _gain_at_corner(plant)
    gain = math.copysign(size, direction(plant))
    loop = Loop(plant, PI(gain))
    if loop.is_stable():
        margins = loop.margins()
        if math.isfinite(margins.gain) and margins.phase_crossover > 0.0:
            return gain * margins.gain, 2.0 * math.pi / margins.phase_crossover
    msg = f"no gain brings {plant!r} from stability to its limit: it has no ultimate gain"
    raise LoopError(msg)


def _gain_at_corner(plant: Plant) -> float:
    """Return a small gain for an integrating plant: 1e-3 over |G| where its dead time or its lags begin to count."""
    times = [plant.dead_time, *(1.0 / abs(p) for p in plant.poles() if p)]
    slowest = max(time for time in times if time) if any(times) else 1.0
    return 1e-3 / abs(complex(plant(1j / slowest)))

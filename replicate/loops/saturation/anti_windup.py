r"""What limits of the control signal make of a controller: modes, in each of which the loop is linear.

The controller computes the *command* v; the plant gets the control signal :math:`u = \min(\max(v, l), h)`. The integral
part I = ki * (integral of the error) obeys

.. math::

    \dot I = k_i e \quad (\text{none}), \qquad
    \dot I = k_i e + \frac{u - v}{T_t} \quad (\text{back-calculation}), \qquad
    \dot I = \begin{cases} 0 & v \ne u,\ (v - u) k_i e > 0 \\ k_i e & \text{else}\end{cases} \quad (\text{clamping})

Clamping is discontinuous where v meets a limit. When the held integral part lets v fall back and the running one drives
it out again, v stays on the limit (Filippov's solution, to which every implementation with a short sampling time
tends): a mode of its own, *sliding*.

References
----------
K. J. Åström and T. Hägglund, "Advanced PID Control" (2006), section 3.5: back-calculation and its tracking time.
A. F. Filippov, "Differential Equations with Discontinuous Righthand Sides" (1988).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from replicate.loops import checks
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.time_domain.chain import Chain
from replicate.loops.time_domain.piece_flow import Row

Array = NDArray[np.float64]
AntiWindup = Literal["none", "back-calculation", "clamping"]
Kind = Literal["free", "limited", "held", "sliding"]


@dataclass(frozen=True)
class Mode:
    """One of the ways in which a limited loop is linear.

    Attributes
    ----------
    kind
        ``free`` (u = v), ``limited`` (u at a limit, the integral part runs on), ``held`` (u at a limit, the integral
        part constant) or ``sliding`` (v stays on the limit).
    side
        1 at the upper limit, -1 at the lower one, 0 if free.
    """

    kind: Kind
    side: int = 0


FREE = Mode("free")


@dataclass(frozen=True)
class LimitedController:
    """The command as a signal of the chain, its limits, and what the integral part does beyond them."""

    chain: Chain
    command: Row
    limits: tuple[float, float]
    anti_windup: AntiWindup
    tracking_time: float

    def limit(self, mode: Mode) -> float:
        """Return the value of u in a mode that is not free."""
        return self.limits[1] if mode.side > 0 else self.limits[0]

    @property
    def integrator(self) -> int | None:
        """The index of the integral part among the states; None if there is none."""
        found = np.nonzero(self.chain.wx[2])[0]
        return int(found[0]) if found.size and self.command.x[found[0]] else None

    @property
    def integral_rate(self) -> Row:
        """The rate of the integral part, ki e, as a signal of the chain."""
        index = self.integrator
        assert index is not None  # noqa: S101  -- asked for in modes of clamping only, which has an integral part
        weight = float(self.command.x[index])
        return Row(self.chain.a[index] * weight, self.chain.b[index] * weight, float(self.chain.e[index]) * weight)

    def chain_in(self, mode: Mode, setpoint: float) -> tuple[Chain, Row]:
        """Return chain and command in a mode, the set-point's value and the limit's included (their unit is 1)."""
        a, b, e = np.array(self.chain.a), np.array(self.chain.b), self.chain.e * setpoint
        row = Row(self.command.x, self.command.v, self.command.r * setpoint)
        index = self.integrator
        if index is not None and mode.kind in {"held", "sliding"}:
            a[index], b[index], e[index] = 0.0, 0.0, 0.0
        elif index is not None and mode.kind == "limited" and self.anti_windup == "back-calculation":
            pull = 1.0 / (self.tracking_time * float(self.command.x[index]))
            a[index] -= pull * row.x
            b[index] -= pull * row.v
            e[index] += pull * (self.limit(mode) - row.r)
        return replace(self.chain, a=a, b=b, e=e), row


def checked_limits(limits: object) -> tuple[float, float]:
    """Return the limits (low, high) as floats.

    Raises
    ------
    LoopError
        If they are not two real numbers (infinite ones allowed), low < high, that enclose 0.
    """
    try:
        low, high = (checks.real(limit) for limit in limits)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        low = high = float("nan")
    if not (low <= 0.0 <= high and low < high):
        allowed = "two numbers (low, high), low < high, with 0, the control signal at rest, between them"
        msg = f"the limits must be {allowed}, not {checks.shown(limits)}"
        raise LoopError(msg)
    return low, high


def checked_anti_windup(anti_windup: object, tracking_time: object, controller: PID) -> tuple[AntiWindup, float]:
    r"""Return the scheme and the tracking time; by default Ti, or the geometric mean of Ti and Td.

    Raises
    ------
    LoopError
        If the scheme is none of the three, or the tracking time is not a number > 0, not needed, or has no default.
    """
    if anti_windup not in get_args(AntiWindup):
        known = ", ".join(get_args(AntiWindup))
        msg = f"anti_windup must be one of {known}, not {checks.shown(anti_windup)}"
        raise LoopError(msg)
    if tracking_time is not None:
        if anti_windup != "back-calculation":
            msg = f"tracking_time belongs to anti_windup='back-calculation', not to {anti_windup!r}"
            raise LoopError(msg)
        return anti_windup, checks.positive("tracking_time", tracking_time, allowed="a time > 0")
    if anti_windup != "back-calculation" or not controller.ki:
        return anti_windup, float("inf")  # type: ignore[return-value]
    integral_time, derivative_time = controller.integral_time, controller.derivative_time if controller.kd else 0.0
    default = (integral_time * derivative_time) ** 0.5 if derivative_time > 0.0 else integral_time
    if not default > 0.0:
        msg = f"tracking_time has no default for Ti = {integral_time:g}: give a time > 0"
        raise LoopError(msg)
    return anti_windup, float(default)

"""A PID design: the gains, what limits them, and how the search for them ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.design.nyquist_constraints import Kind

Status = Literal["optimal", "not-polished", "no-controller", "unbounded"]

MESSAGES: dict[str, str] = {
    "optimal": "the optimality conditions hold to rounding and all constraints were verified on all frequencies",
    "not-polished": "a feasible and stable point was found, but the optimality system did not converge to it",
    "no-controller": "no stabilising controller that satisfies the constraints was found",
    "unbounded": "the integral gain can be raised without limit: nothing in the plant bounds its bandwidth",
}
LIFTED = "; constraints=() lifts those on the shape of the Nyquist curve, and asks for the circle alone"


@dataclass(frozen=True)
class ActiveConstraint:
    """A constraint that limits the design: its kind, the frequency at which it touches, and its multiplier.

    The multiplier is the relative growth of ki per unit by which the constraint is relaxed.
    """

    kind: Kind
    frequency: float
    multiplier: float


@dataclass(frozen=True)
class PIDDesign:
    """A PID controller and how it came about.

    Attributes
    ----------
    k, ki, kd, b
        Gains and set-point weight (by `pid_setpoint_weight`); ``nan`` if there is no controller.
    frequency
        Where the Nyquist curve touches the circle (the lowest frequency, if several).
    active
        The active constraints with frequencies and multipliers.
    status, message
        What happened, as a word and as a sentence.
    shaped
        Whether not only the circle was asked for.
    """

    k: float
    ki: float
    kd: float
    b: float
    frequency: float
    active: tuple[ActiveConstraint, ...]
    status: Status
    shaped: bool = False

    @property
    def message(self) -> str:
        """The status as a sentence."""
        lifted = LIFTED if self.shaped and self.status == "no-controller" else ""
        return MESSAGES[self.status] + lifted

    @property
    def gains(self) -> NDArray[np.float64]:
        """The gains (k, ki, kd)."""
        return np.array([self.k, self.ki, self.kd])

    @property
    def integral_time(self) -> float:
        """Ti = k/ki."""
        return self.k / self.ki

    @property
    def derivative_time(self) -> float:
        """Td = kd/k."""
        return self.kd / self.k

    @property
    def controller(self) -> PID:
        """The controller itself, with ideal derivative of the measurement."""
        return PID(self.k, self.ki, self.kd, b=self.b)

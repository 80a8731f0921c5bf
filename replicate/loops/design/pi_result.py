"""A PI design: the gains, where the Nyquist curve touches the circle, and how the search for them ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from replicate.loops.controller import PI

Status = Literal["optimal", "no-controller", "unbounded"]

MESSAGES: dict[str, str] = {
    "optimal": "the largest integral gain that satisfies the constraint with a stable loop was found and verified",
    "no-controller": "no stabilising PI controller satisfies the constraint",
    "unbounded": "the integral gain can be raised without limit",
}


@dataclass(frozen=True)
class PIDesign:
    """A PI controller and how it came about.

    Attributes
    ----------
    k, ki, b
        Gains and set-point weight (by `setpoint_weight`); ``nan`` if the status is not ``optimal``.
    frequency
        Where the Nyquist curve touches the circle (the lower one of two).
    frequencies
        All tangency frequencies: one in the smooth case, two at a corner.
    case
        ``smooth`` or ``corner``.
    status, message
        What happened, as a word and as a sentence.
    solutions
        All stable local solutions that satisfy the constraint everywhere, largest ki first.
    """

    k: float
    ki: float
    b: float
    frequency: float
    frequencies: tuple[float, ...]
    case: str
    status: Status
    solutions: tuple[PIDesign, ...] = ()

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return MESSAGES[self.status]

    @property
    def integral_time(self) -> float:
        """Ti = k/ki."""
        return self.k / self.ki

    @property
    def controller(self) -> PI:
        """The controller itself."""
        return PI(self.k, self.ki, self.b)

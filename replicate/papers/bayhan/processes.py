"""The three processes of the paper, their controllers, and how specifications are read.

The paper's symbols: ``K``, ``tau``, ``L`` are gain, time constant and dead time of the process (1), (2);
``a`` is the free parameter of the pole assignment, ``tau_cl`` that of the IMC rule.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal

from replicate.loops import PI, Loop, Plant, Signal
from replicate.loops.tune import PRINTED, TuningRule, load_rules
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.pole_assignment import Dominance, assign, dominance

RULES = ("PA", "ZN", "CC", "IMC", "ISE", "IAE", "IAESPC", "ITSE", "ITSESPC", "ITAE", "ITAESPC")
SPECIFICATIONS = ("overshoot", "settling_time", "delay_time", "rise_time")

Convention = Literal["Kp/Ti", "1/Ti"]


@dataclass(frozen=True)
class Process:
    """A first-order process with dead time and the free parameters that the paper chooses for it."""

    title: str
    K: float
    tau: float
    L: float
    a: float
    tau_cl: float

    @property
    def plant(self) -> Plant:
        """The process G(s), dead time exact."""
        return Plant.foptd(gain=self.K, time_constant=self.tau, dead_time=self.L)  # (1), (2)

    @property
    def symbols(self) -> Mapping[str, float]:
        """What the formulas of Table 1 need."""
        return {"K": self.K, "tau": self.tau, "L": self.L, "tau_cl": self.tau_cl}

    def pole_assignment(self, a: float | None = None) -> PI:
        """Return the controller of (21) and (22), for another ``a`` than the paper's if given."""
        gains = assign(self.K, self.L, self.tau, self.a if a is None else a)
        return PI(k=float(gains.Kp), ki=float(gains.Ki))

    def dominance(self, a: float | None = None) -> Dominance:
        """Return the two margins of condition (27)."""
        return dominance(self.K, self.L, self.tau, self.a if a is None else a)


EXAMPLE_41 = Process("Example 4.1", K=1.0, tau=1.0, L=1.0, a=0.85, tau_cl=0.06)
# The paper gives no tau_cl for Example 4.2; that of Example 4.1 is kept. No number of Table 3 depends on it.
EXAMPLE_42 = Process("Example 4.2", K=1.0, tau=0.1, L=0.5, a=0.3, tau_cl=0.06)
PT326 = Process("PT326", K=0.875, tau=0.62, L=0.43, a=1.3, tau_cl=0.3)


@cache
def competing_rules(variant: str = PRINTED) -> Mapping[str, TuningRule]:
    """Return the ten rules of Table 1 in the given variant."""
    return load_rules(paper.folder() / "tuning_rules.toml", variant)


def controllers(process: Process, convention: Convention = "Kp/Ti", variant: str = PRINTED) -> dict[str, PI]:
    """Return the controller of every rule.

    Parameters
    ----------
    convention
        How a competing rule's integral time becomes an integral gain: ``Kp/Ti`` is equation (3); ``1/Ti`` is
        what the printed tables turn out to be computed with. The pole assignment gives Ki directly.
    variant
        Which form of Table 1: ``printed``, ``corrected`` or ``authors``.
    """
    found = {"PA": process.pole_assignment()}
    for id, rule in competing_rules(variant).items():
        gains = rule.evaluate(**process.symbols)
        ki = gains.ki if convention == "Kp/Ti" else 1.0 / gains.ti  # (3)
        found[id] = PI(k=float(gains.kp), ki=float(ki))
    return found


def trials(process: Process, rules: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Return plant and controller of each rule as printed, for readers to try out."""
    found = controllers(process)
    return {rule: (process.plant.notation(), found[rule].notation()) for rule in rules}


@cache
def exact_step(process: Process, k: float, ki: float) -> Signal | None:
    """Return the unit step response, dead time exact; ``None`` if the loop is unstable."""
    loop = Loop(process.plant, PI(k=k, ki=ki))
    return loop.step() if loop.is_stable() else None


def specifications(process: Process, controller: PI) -> dict[str, float]:
    """Return overshoot (a fraction) and 2 % settling, 50 % delay and 10-90 % rise time of the exact response.

    Times count from the step and include the dead time. All are ``nan`` if the loop is unstable.
    """
    response = exact_step(process, controller.k, controller.ki)
    if response is None:
        return dict.fromkeys(SPECIFICATIONS, math.nan)
    overshoot = response.overshoot()
    return {
        # The response is known to about 1e-15; what is left below this is rounding, not overshoot.
        "overshoot": overshoot if overshoot > 1e-12 else 0.0,
        "settling_time": response.settling_time(band=0.02),
        "delay_time": response.delay_time(0.5),
        "rise_time": response.rise_time(0.1, 0.9),
    }

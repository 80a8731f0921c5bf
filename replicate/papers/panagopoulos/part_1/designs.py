"""The designs of paper I: one call of `design_pi` for each plant and Ms, and the set-point weight by two rules.

The text evaluates the set-point weight (25) at the peak of the complementary sensitivity (24). The numbers it prints
were evaluated at w0, the peak of the sensitivity, with the true Mp. Both rules are here, as ``w_mp`` and ``w_0``.
"""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits.extrema import largest
from replicate.loops import PI, FrequencyPeak, Loop, PIDesign, Signal, design_pi, setpoint_weight
from replicate.papers.panagopoulos.part_1.plants import PLANTS

Array = NDArray[np.float64]
WeightRule = Literal["w_mp", "w_0"]

BOUNDS = (1.4, 1.6, 1.8, 2.0)  # the values of Ms in Table 1
SIX = ("G1", "G2", "G3", "G4", "G5", "G6")


@cache
def design(plant: str, ms: float) -> PIDesign:
    """Return the design for a plant of `PLANTS`, with all its solutions."""
    found = design_pi(PLANTS[plant], ms=ms)
    if found.status != "optimal":
        msg = f"{plant}, Ms = {ms:g}: {found.message}"
        raise ValueError(msg)
    return found


@cache
def loop(plant: str, ms: float, solution: int = 0) -> Loop:
    """Return the loop of a design; its controller has b = 1."""
    found = design(plant, ms).solutions[solution]
    return Loop(PLANTS[plant], PI(found.k, found.ki))


@cache
def complementary_peak(plant: str, ms: float, solution: int = 0) -> FrequencyPeak:
    """Return Mp of a design."""
    return loop(plant, ms, solution).complementary_peak()


@cache
def weight(plant: str, ms: float, rule: WeightRule, solution: int = 0) -> float:
    """Return the set-point weight (25), at w_mp as (24) says or at w0."""
    found = design(plant, ms).solutions[solution]
    if rule == "w_mp":
        return found.b
    peak = complementary_peak(plant, ms, solution).value
    return setpoint_weight(PLANTS[plant], found.k, found.ki, at=(found.frequency, peak))


def controller(plant: str, ms: float, rule: WeightRule, solution: int = 0) -> PI:
    """Return the controller of a design with its set-point weight."""
    found = design(plant, ms).solutions[solution]
    return PI(found.k, found.ki, weight(plant, ms, rule, solution))


@cache
def load_response(plant: str, ms: float) -> Signal:
    """Return the output after a unit load step at the plant's input, until it has died out."""
    return loop(plant, ms).load_step()


def setpoint_peak(plant: str, ms: float, b: float) -> float:
    """Return M_sp (6), the largest |G_sp| (5) of a design with any set-point weight; at rest |G_sp| is 1."""
    found = design(plant, ms)

    def gain(log_w: Array) -> Array:
        s = 1j * np.exp(log_w)
        value = loop(plant, ms)(s)
        return np.asarray(np.abs((found.ki + s * b * found.k) / (found.ki + s * found.k) * value / (1.0 + value)))

    grid = np.log(found.frequency) + np.log(np.geomspace(1e-2, 10.0, 301))
    return max(1.0, largest(gain, grid, gain(grid))[1])

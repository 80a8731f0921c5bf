"""The loop of several exercises: a lag with dead time under PI control."""

from __future__ import annotations

from replicate.exhibits.variants import Inputs
from replicate.loops import PI, Loop, Plant
from replicate.teaching.drawing_numbers import number


def lag_loop(inputs: Inputs) -> Loop:
    """Return the loop of the inputs ``K``, ``T``, ``L`` of the process and ``k``, ``ki`` of the controller."""
    K, T, L = (number(inputs, name) for name in ("K", "T", "L"))
    return Loop(Plant.foptd(gain=K, time_constant=T, dead_time=L), PI(number(inputs, "k"), number(inputs, "ki")))

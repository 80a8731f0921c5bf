"""Time responses of loops with rational plants: by equal pieces where few are enough, else by pieces that adapt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.plant import Plant
from replicate.loops.time_domain import adaptive_steps, method_of_steps

Array = NDArray[np.float64]


def responses(
    plant: Plant, controllers: Sequence[PID], until: float, *, setpoint: float, load: float, unit: float = 1.0
) -> list[tuple[Array, Array, Array]]:
    """Return (breaks, output, control signal) for each controller; they may differ in k, ki, kd and b.

    Output and control signal are Chebyshev coefficients, shape (pieces, degree + 1); the last break is ``until``.
    ``unit`` is the unit of time in the user's, for messages.

    Raises
    ------
    LoopError
        If the controllers differ in more than their gains, or a response grows out of range.
    """
    if plant.is_rational:
        found = method_of_steps.respond(plant, controllers, until, setpoint=setpoint, load=load, unit=unit)
        if found is not None:
            return found
    return [adaptive_steps.respond(plant, c, until, setpoint=setpoint, load=load, unit=unit) for c in controllers]


def held(breaks: Array, output: Array, control: Array, until: float) -> tuple[Array, Array, Array]:
    """Return a response that has come to rest with one piece more, in which it stays where it is, up to ``until``."""
    if breaks[-1] >= until:
        return breaks, output, control
    rest = np.zeros((2, 1, output.shape[1]))
    rest[:, 0, 0] = output[-1].sum(), control[-1].sum()  # the values at the end of the last piece
    return np.append(breaks, until), np.concatenate([output, rest[0]]), np.concatenate([control, rest[1]])

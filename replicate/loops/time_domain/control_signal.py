"""The control signal that belongs to an output: the controller, filters included, driven by a piecewise polynomial."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.polynomial import chebyshev as cheb
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant
from replicate.loops.time_domain.chain import build_chain, gains
from replicate.loops.time_domain.method_of_steps import DEGREE, piece_map

Array = NDArray[np.float64]

RESOLVED = 1e-13  # size of the last coefficients, relative to the largest of the signal, of a piece that is resolved


def control_signal(controller: PID, breaks: Array, output: Array, setpoint: float) -> tuple[Array, Array]:
    """Return breaks and Chebyshev coefficients of u for an output and a set-point step at t = 0, at rest before.

    Impulses (an ideal derivative of the set-point step) are not part of it.

    Parameters
    ----------
    controller
        With or without filters.
    breaks, output
        The output as a piecewise Chebyshev series, shapes (pieces + 1,) and (pieces, degree + 1).
    setpoint
        Height of the set-point step.
    """
    bare = controller.kd and not controller.derivative_filter and not controller.measurement_filter
    # an ideal derivative of the output itself is not part of the chain
    driven = replace(controller, kd=0.0) if bare else controller
    # the output is the input of a static plant
    chain = build_chain(Plant([1.0], [1.0]), driven, integral=bool(driven.ki), derivative=bool(driven.kd))
    g = gains(driven)
    points = DEGREE + 1
    to_coefficients = chebyshev.values_to_coefficients(DEGREE)
    pieces = zip(breaks[:-1], breaks[1:], output, strict=True)
    pending = [(left, right, series, np.inf) for left, right, series in pieces][::-1]
    x = chain.start * setpoint
    ends, control, largest = [0.0], [], abs(setpoint * float(np.max(np.abs(g[:2]))))
    while pending:
        left, right, series, before = pending.pop()
        fixed = piece_map(chain, float(right - left))
        inputs = np.concatenate([cheb.chebval(chebyshev.nodes(DEGREE), series), x, [setpoint]])
        u = to_coefficients @ (np.tensordot(g, fixed.basis, 1) @ inputs)
        largest = max(largest, float(np.max(np.abs(u))))
        remaining = float(np.max(np.abs(u[-2:]))) / largest if largest else 0.0
        # halving no longer helps once the tail is the rounding error of the output
        if remaining > RESOLVED and remaining < 0.25 * before:
            middle = 0.5 * (left + right)
            pending += [
                (middle, right, chebyshev.restricted(series, 0.0, 1.0), remaining),
                (left, middle, chebyshev.restricted(series, -1.0, 0.0), remaining),
            ]
            continue
        if bare:
            slope = cheb.chebder(series) * (2.0 / (right - left))
            u[: slope.size] -= controller.kd * slope[:points]
        ends.append(float(right))
        control.append(u)
        x = fixed.state @ inputs
    return np.array(ends), np.array(control)

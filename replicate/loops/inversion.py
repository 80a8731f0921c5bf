r"""Time responses of loops around plants given by a function, by contour inversion of the closed loop's transform.

.. math:: y(t) = \frac{1}{2\pi i} \int_\Gamma e^{st} Y(s)\, ds

The contour is a hyperbola that opens to the left, so that :math:`e^{st}` decays along it. It must leave every closed-loop
pole on its left: the winding of 1 + L along it is counted, and the flattest hyperbola that passes is taken. The integrand
is analytic near the contour, so the trapezoidal rule converges exponentially; it is refined until two successive sets of
quadrature points agree.

Reference: Weideman and Trefethen, "Parabolic and hyperbolic contours for computing the Bromwich integral",
Math. Comp. 76 (2007).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops import chebyshev
from replicate.loops.errors import LoopError
from replicate.loops.loop_transfer import LoopTransfer

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

OPENINGS = (0.62, 0.45, 0.3, 0.2, 0.12, 0.07, 0.04)  # rad by which the contour's arms lean to the left of vertical
DEGREE = 18
TOLERANCE = 1e-13
RESOLVED = 5e-13
FIRST = 1e-3  # length of the first piece, in time scales
GROWTH = 1.35
KINKS = 12


def respond(
    transfer: LoopTransfer, transform: Callable[[Any], ComplexArray], until: float, start: float, time_scale: float
) -> tuple[Array, Array]:
    """Return (breaks, Chebyshev coefficients) of the inverse transform on [0, until]; zero before ``start``.

    Parameters
    ----------
    transform
        Y(s) of a response that is continuous for t > start, for complex arrays.
    time_scale
        Time constant of the slowest mode. Pieces grow geometrically from a small fraction of it, because such responses
        start infinitely flat and end in an algebraic tail; pieces that are not resolved are halved.

    Raises
    ------
    LoopError
        If no contour leaves all closed-loop poles on its left, or the quadrature does not converge.
    """
    end = until - start
    edges = [0.0, min(end, FIRST * time_scale)]
    while edges[-1] < end:
        edges.append(min(end, GROWTH * edges[-1]))
    if transfer.dead_time:  # the response is smooth only between multiples of the dead time, ever smoother later
        kinks = transfer.dead_time * np.arange(1, KINKS)
        edges = sorted({*edges, *kinks[kinks < end].tolist()})
    pending = [(left, right) for left, right in zip(edges[:-1], edges[1:], strict=True)][::-1]
    to_coefficients = chebyshev.values_to_coefficients(DEGREE)
    lefts: list[float] = []
    pieces: list[Array] = []
    largest = float(np.abs(transform(1.0 / time_scale)) / time_scale)  # the response's size, before any piece is known
    while pending:
        left, right = pending.pop()
        t = 0.5 * (left + right) + 0.5 * (right - left) * chebyshev.nodes(DEGREE)
        series = to_coefficients @ _invert(transfer, transform, t, start)
        largest = max(largest, float(np.max(np.abs(series))))
        if np.max(np.abs(series[-2:])) > RESOLVED * largest and right - left > 1e-6 * time_scale:
            middle = 0.5 * (left + right)
            pending += [(middle, right), (left, middle)]
            continue
        lefts.append(left)
        pieces.append(series)
    breaks = np.append(lefts, end)
    coefficients = np.array(pieces)
    if start:
        breaks = np.concatenate([[0.0], breaks + start])
        coefficients = np.concatenate([np.zeros((1, DEGREE + 1)), coefficients])
    return breaks, coefficients


def _invert(transfer: LoopTransfer, transform: Callable[[Any], ComplexArray], t: Array, start: float) -> Array:
    later = t[t > 0.0]
    result = np.zeros_like(t)
    if later.size == 0:
        return result
    longest = float(later.max())
    shortest = max(float(later.min()), 0.02 * longest)
    for opening in OPENINGS:
        for scale in (3.0 / longest, 9.0 / longest):
            contour = _Contour(scale, opening)
            if contour.passes(transfer, shortest):
                values = _refined(contour, transform, later, shortest, start)
                if values is not None:
                    result[t > 0.0] = values
                    return result
    msg = "no contour passes to the right of all closed-loop poles: the loop is unstable or too lightly damped to invert"
    raise LoopError(msg)


def _refined(
    contour: _Contour, transform: Callable[[Any], ComplexArray], t: Array, shortest: float, start: float
) -> Array | None:
    """Return the response at times ``t``, or None if the quadrature does not converge on this contour."""
    reach = contour.reach(shortest)
    previous: Array | None = None
    for count in (60, 120, 240, 480, 960, 1920, 3840):
        # midpoint rule on the upper arm; the lower one is its conjugate
        step = reach / count
        theta = step * (np.arange(count) + 0.5)
        s, ds = contour(theta)
        with np.errstate(all="ignore"):
            weights = transform(s) * np.exp(s * start) * ds * step / np.pi
        weights = np.where(np.isfinite(weights), weights, 0.0)
        values = np.imag(np.exp(np.outer(t, s)) @ weights)
        if previous is not None and np.max(np.abs(values - previous)) <= TOLERANCE * max(1.0, float(np.max(np.abs(values)))):
            return np.asarray(values)
        previous = values
    return None


class _Contour:
    """The hyperbola s = scale (1 + sin(i theta - opening')) with arms leaning ``opening`` to the left of vertical."""

    def __init__(self, scale: float, opening: float) -> None:
        self.scale = scale
        self.opening = opening

    def __call__(self, theta: Array) -> tuple[ComplexArray, ComplexArray]:
        argument = 1j * theta - self.opening
        return self.scale * (1.0 + np.sin(argument)), self.scale * 1j * np.cos(argument)

    def reach(self, shortest: float) -> float:
        """Return the parameter at which exp(s t) has decayed below rounding for the shortest time."""
        depth = 40.0 / (self.scale * shortest * np.sin(self.opening)) + 2.0 / np.sin(self.opening)
        return float(np.arccosh(max(depth, 2.0)))

    def passes(self, transfer: LoopTransfer, shortest: float) -> bool:
        """Whether no closed-loop pole whose mode has not yet decayed lies to the right of the contour.

        The argument of 1 + L is followed around the region between the upper arm, cut where exp(s t) has decayed, the
        vertical line above its tip, and the vertical line through the contour's vertex.
        """
        arm, _ = self(np.linspace(0.0, self.reach(shortest), 3000))
        vertex, tip = arm[0].real, arm[-1]
        top = max(2.0 * tip.imag, 2.0 * transfer.beyond(0.1))
        along = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 1500)])
        up = tip + 1j * (top - tip.imag) * along
        bridge = np.linspace(tip.real, vertex, 200) + 1j * top
        back = vertex + 1j * top * along[::-1]
        path = np.concatenate([arm, up, bridge, back])
        with np.errstate(all="ignore"):
            value = 1.0 + transfer(path)
        if not np.isfinite(value).all():
            return False
        return abs(float(np.sum(np.angle(value[1:] / value[:-1])))) < 1.0

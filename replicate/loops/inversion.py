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
SHORTEST = 1e-4  # first piece, as a fraction of the horizon: responses such as exp(-sqrt s) start infinitely flat


def respond(
    transfer: LoopTransfer, transform: Callable[[Any], ComplexArray], until: float, start: float
) -> tuple[Array, Array]:
    """Return (breaks, Chebyshev coefficients) of the inverse transform on [0, until]; zero before ``start``.

    Parameters
    ----------
    transform
        Y(s) of a response that is continuous for t > start, for complex arrays.

    Raises
    ------
    LoopError
        If no contour leaves all closed-loop poles on its left, or the quadrature does not converge.
    """
    first = SHORTEST * (until - start)
    growth = 1.35
    edges = [0.0]
    while edges[-1] < until - start:
        edges.append(min(until - start, edges[-1] + (first if len(edges) == 1 else (growth - 1.0) * max(edges[-1], first))))
    breaks = np.array(edges)
    nodes = chebyshev.nodes(DEGREE)
    values = np.empty((breaks.size - 1, DEGREE + 1))
    for j in range(breaks.size - 1):
        t = 0.5 * (breaks[j] + breaks[j + 1]) + 0.5 * (breaks[j + 1] - breaks[j]) * nodes
        values[j] = _invert(transfer, transform, t, start)
    values[0, 0] = 0.0
    coefficients = values @ chebyshev.values_to_coefficients(DEGREE).T
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
        scale = 3.0 / longest
        contour = _Contour(scale, opening)
        if not contour.passes(transfer):
            contour = _Contour(scale * 3.0, opening)
            if not contour.passes(transfer):
                continue
        values = _refined(contour, transform, later, shortest, start)
        result[t > 0.0] = values
        return result
    msg = "no contour passes to the right of all closed-loop poles: the loop is unstable or too lightly damped to invert"
    raise LoopError(msg)


def _refined(
    contour: _Contour, transform: Callable[[Any], ComplexArray], t: Array, shortest: float, start: float
) -> Array:
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
    msg = "the contour quadrature did not converge"
    raise LoopError(msg)


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

    def passes(self, transfer: LoopTransfer) -> bool:
        """Whether no closed-loop pole lies to the right of the contour."""
        s, _ = self(np.linspace(0.0, self.reach(1e-3 / self.scale), 4000))
        with np.errstate(all="ignore"):
            value = 1.0 + transfer(s)
        value = value[np.isfinite(value)]
        turn = float(np.sum(np.angle(value[1:] / value[:-1])))
        # On the real axis the argument is 0; far out 1 + L -> 1. Each pole to the right would add a full turn on both arms.
        return abs(turn + float(np.angle(value[0])) - float(np.angle(value[-1]))) < 1.0 and abs(np.angle(value[-1])) < 1.0

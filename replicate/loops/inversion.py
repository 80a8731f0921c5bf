r"""Time responses of loops around plants given by a function, by contour inversion of the closed loop's transform.

.. math:: y(t) = \frac{1}{2\pi i} \int_\Gamma e^{st} Y(s)\, ds

The contour is a hyperbola that opens to the left, so that :math:`e^{st}` decays along it. It must leave every
closed-loop pole on its left: the winding of 1 + L along it is counted, and the flattest hyperbola that passes is taken.
The integrand is analytic near the contour, so the trapezoidal rule converges exponentially; it is refined until two
successive sets of quadrature points agree.

Reference: Weideman and Trefethen, "Parabolic and hyperbolic contours for computing the Bromwich integral",
Math. Comp. 76 (2007).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
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
RESIDUE_POINTS = 64
TOLERANCE = 1e-13
RESOLVED = 5e-13
FIRST = 1e-3  # length of the first piece, in time scales
GROWTH = 1.35
SHORT = 1e-6  # length of a piece, in time scales, that is not halved
SHORTEST = 1e-14  # length of a piece, in time scales, that is not halved at a kink: a power of t starts without a scale
SPAN = 0.02  # smallest ratio of two times for which one contour serves
KINKS = 12
MOST_EXPANDED = 25  # dead times up to which it is, if the closed loop cannot be inverted there
EXPANDED = 5  # dead times during which the response is summed up delay by delay


@dataclass(frozen=True)
class ClosedLoop:
    """What is inverted: the response ``forward exp(-s dead_time) / (1 + L)`` and where its poles are.

    Attributes
    ----------
    forward
        The open response without the dead time, drive times plant over s, for complex arrays.
    poles
        The rightmost closed-loop poles with Im > 0. They are counted: whether these are all is checked.
    """

    transfer: LoopTransfer
    forward: Callable[[Any], ComplexArray]
    poles: ComplexArray

    def closed(self, s: Any) -> ComplexArray:
        """Evaluate the response's transform without the dead time of its first path."""
        return np.asarray(self.forward(s) / (1.0 + self.transfer(s)))

    def path(self, trips: int) -> Callable[[Any], ComplexArray]:
        """Return the transform, without dead time, of the part that has been around the loop ``trips`` times."""
        controller = self.transfer.num, self.transfer.den

        def around(s: ComplexArray) -> ComplexArray:
            gain = np.polyval(controller[0], s) / np.polyval(controller[1], s)
            return np.asarray(self.forward(s) * (-gain * self.transfer.plant.delay_free(s)) ** trips)

        return around

    def residue(self, pole: complex) -> complex:
        """Return the residue of the closed transform at a pole, by Cauchy's integral."""
        others = [abs(pole - q) for q in self.poles if q != pole]
        radius = 0.3 * min([abs(pole), 2.0 * pole.imag, *others])
        turn = np.exp(2j * np.pi * np.arange(RESIDUE_POINTS) / RESIDUE_POINTS)
        return complex(np.mean(self.closed(pole + radius * turn) * radius * turn))


def respond(loop: ClosedLoop, until: float, time_scale: float) -> tuple[Array, Array]:
    """Return (breaks, Chebyshev coefficients) of the response on [0, until]; zero during the dead time.

    Parameters
    ----------
    time_scale
        Time constant of the slowest mode. Pieces grow geometrically from a small fraction of it, because such
        responses start infinitely flat and end in an algebraic tail; pieces that are not resolved are halved.

    Raises
    ------
    LoopError
        If no contour separates the known poles from all others, or the quadrature does not converge.
    """
    start = loop.transfer.dead_time
    end = until - start
    if end <= 0.0:
        return np.array([0.0, until]), np.zeros((1, DEGREE + 1))
    edges = [0.0, min(end, FIRST * time_scale)]
    while edges[-1] < end:
        edges.append(min(end, GROWTH * edges[-1]))
    if start:  # the response is smooth only between multiples of the dead time, ever smoother later
        kinks = start * np.arange(1, KINKS)
        edges = sorted({*edges, *kinks[kinks < end].tolist()})
    starts = {0.0, *(start * np.arange(KINKS)).tolist()}  # where the response may start like a broken power of time
    pending = list(pairwise(edges))[::-1]
    to_coefficients = chebyshev.values_to_coefficients(DEGREE)
    lefts: list[float] = []
    pieces: list[Array] = []
    # the response's size, before any piece is known
    largest = float(np.abs(loop.closed(1.0 / time_scale)) / time_scale)
    while pending:
        left, right = pending.pop()
        t = 0.5 * (left + right) + 0.5 * (right - left) * chebyshev.nodes(DEGREE)
        series = to_coefficients @ _values(loop, t)
        largest = max(largest, float(np.max(np.abs(series))))
        if (
            np.max(np.abs(series[-2:])) > RESOLVED * largest
            and right - left > (SHORTEST if left in starts else SHORT) * time_scale
        ):
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


def _values(loop: ClosedLoop, t: Array) -> Array:
    """Return the response at times within one piece, counted from the end of the first dead time."""
    delay = loop.transfer.dead_time
    middle = float(t[t.size // 2])
    if not delay or middle > EXPANDED * delay:
        try:
            return _invert(loop.closed, t, loop)
        except LoopError:
            if not delay or middle > MOST_EXPANDED * delay:
                raise
    # after n dead times the loop has been gone around n times at most: a finite sum without closed-loop poles
    parts = [_invert(loop.path(n), t - n * delay, None) for n in range(int(middle / delay) + 1)]
    return np.asarray(np.sum(parts, axis=0))


def _invert(transform: Callable[[Any], ComplexArray], t: Array, loop: ClosedLoop | None) -> Array:
    """Invert a transform at times t; with a loop, its poles to the right of the contour are added as residues."""
    result = np.zeros_like(t)
    left = t > 1e-14 * max(float(t.max()), 0.0)
    while left.any():  # one contour serves times that differ by no more than a factor
        longest = float(t[left].max())
        group = left & (t >= SPAN * longest)
        result[group] = _invert_group(transform, t[group], loop)
        left &= ~group
    return result


def _invert_group(transform: Callable[[Any], ComplexArray], t: Array, loop: ClosedLoop | None) -> Array:
    longest, shortest = float(t.max()), float(t.min())
    for opening in OPENINGS:
        for scale in (3.0 / longest, 9.0 / longest):
            contour = _Contour(scale, opening)
            outside = contour.poles_to_the_right(loop, shortest) if loop else np.empty(0, dtype=complex)
            if outside is None:
                continue
            values = _refined(contour, transform, t, shortest)
            if values is None:
                continue
            if loop:
                for pole in outside:
                    values = values + 2.0 * (loop.residue(complex(pole)) * np.exp(pole * t)).real
            return values
    raise LoopError(_why_not(transform, shortest))


def _why_not(transform: Callable[[Any], ComplexArray], shortest: float) -> str:
    """Say why no contour inverts a transform."""
    contour = _Contour(3.0 / shortest, OPENINGS[0])
    s, _ = contour(np.linspace(0.0, contour.reach(shortest), 200))
    with np.errstate(all="ignore"):
        wrong = s[~np.isfinite(transform(s))]
    if wrong.size:
        return f"the plant's function is not finite at s = {wrong[0]:.3g}: write it so that it does not overflow"
    return (
        "no contour inverts the response: the loop is too lightly damped, "
        "or the plant's function falls too slowly at high frequency"
    )


def _refined(contour: _Contour, transform: Callable[[Any], ComplexArray], t: Array, shortest: float) -> Array | None:
    """Return the integral along the contour at times ``t``, or None if the quadrature does not converge on it."""
    reach = contour.reach(shortest)
    previous: Array | None = None
    for count in (60, 120, 240, 480, 960, 1920, 3840):
        # midpoint rule on the upper arm; the lower one is its conjugate
        step = reach / count
        theta = np.asarray(step * (np.arange(count) + 0.5), dtype=float)
        s, ds = contour(theta)
        with np.errstate(all="ignore"):
            weights = transform(s) * ds * step / np.pi
        weights = np.where(np.isfinite(weights), weights, 0.0)
        values = np.imag(np.exp(np.outer(t, s)) @ weights)
        size = max(1.0, float(np.max(np.abs(values))))
        if previous is not None and np.max(np.abs(values - previous)) <= TOLERANCE * size:
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

    def poles_to_the_right(self, loop: ClosedLoop, shortest: float) -> ComplexArray | None:
        """Return the known closed-loop poles to the right of the contour, or None if they are not all there are.

        The argument of 1 + L is followed around the region between the upper arm, cut where exp(s t) has decayed, the
        vertical line above its tip, and the vertical line through the contour's vertex: each pole inside adds a turn.
        """
        transfer = loop.transfer
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
            return None
        turns = round(abs(float(np.sum(np.angle(value[1:] / value[:-1])))) / (2.0 * np.pi))
        inside = [pole for pole in loop.poles if pole.imag > 0.0 and _encloses(path, complex(pole))]
        return np.array(inside, dtype=complex) if len(inside) == turns else None


def _encloses(path: ComplexArray, point: complex) -> bool:
    offsets = np.append(path, path[0]) - point
    return abs(float(np.sum(np.angle(offsets[1:] / offsets[:-1])))) > np.pi

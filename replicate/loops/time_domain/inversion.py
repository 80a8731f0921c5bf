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
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

OPENINGS = (0.62, 0.45, 0.3, 0.2, 0.12, 0.07, 0.04)  # rad by which the contour's arms lean to the left of vertical
DEGREE = 18
RESIDUE_POINTS = 64
CIRCLE = 0.3  # radius of a circle around a pole, of the distance of the next one
SMALL = 0.1  # |L| beyond the bandwidth
NOW = 1e-14  # of the latest time: one that is zero to rounding
SCALES = (3.0, 9.0)  # of a contour, over the latest time
DECAYED = 40.0  # exponent at the end of a contour's arm: exp(-40) is rounding
FAR = 1e3  # of the last corner: how far left a function is followed to see whether it grows like exp(-s T),
STEADY = 0.2  # and the relative change of the rate of growth that such a one has at most
TOLERANCE = 1e-13  # difference of two quadratures that agree, of the response's size,
RESOLVED = 5e-13  # and size of the last coefficients of a piece that is resolved
FIRST = 1e-3  # length of the first piece, in time scales
GROWTH = 1.35
SHORT = 1e-6  # length of a piece that is not halved, in time scales or in times since the last kink,
SHORTEST = 1e-14  # and at a kink, in shortest times: a power of t starts without a scale
ARM = 3000  # points of the contour's upper arm along which poles are counted
ALONG = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 1500)])  # shares of a side, dense at its start
SPAN = 0.02  # smallest ratio of two times for which one contour serves
KINKS = 12
MOST_EXPANDED = 25  # dead times up to which it is, if the closed loop cannot be inverted there
NEXT, ROUGH = 1e-7, 1e-12  # relative distance of neighbours, and a change of slope between them that is rounding
EXPANDED = 5  # dead times during which the response is summed up delay by delay


@dataclass(frozen=True)
class ClosedLoop:
    """What is inverted: the response ``forward exp(-s dead_time) / (1 + L)`` and where its poles are.

    Attributes
    ----------
    forward
        The open response without the dead time, drive times plant over s, for complex arrays.
    poles
        The rightmost closed-loop poles with Im >= 0. They are counted: whether these are all is checked.
    time_scale
        Time constant of the slowest mode.
    unit
        The user's unit of time over the loop's, for messages.
    """

    transfer: LoopTransfer
    forward: Callable[[Any], ComplexArray]
    poles: ComplexArray
    time_scale: float
    unit: float

    def closed(self, s: Any) -> ComplexArray:
        """Evaluate the response's transform without the dead time of its first path."""
        return np.asarray(self.forward(s) / (1.0 + self.transfer(s)))

    @cached_property
    def size(self) -> float:
        """The response's size, before any piece is known."""
        return float(np.abs(self.closed((1.0 + 1.0j) / self.time_scale)) / self.time_scale)

    @cached_property
    def shortest(self) -> float:
        """The shortest time in which anything happens: of the slowest mode, or one over the bandwidth."""
        return min(self.time_scale, 1.0 / self.bandwidth)

    @cached_property
    def bandwidth(self) -> float:
        """A frequency beyond which |L| is small."""
        return self.transfer.beyond(SMALL)

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
        radius = CIRCLE * min([abs(pole), *([2.0 * pole.imag] if pole.imag else []), *others])
        turn = np.exp(2j * np.pi * np.arange(RESIDUE_POINTS) / RESIDUE_POINTS)
        return complex(np.mean(self.closed(pole + radius * turn) * radius * turn))


def respond(loop: ClosedLoop, until: float) -> tuple[Array, Array]:
    """Return (breaks, Chebyshev coefficients) of the response on [0, until]; zero during the dead time.

    Pieces grow geometrically from a small fraction of the loop's time scale, because such responses start infinitely
    flat and end in an algebraic tail; pieces that are not resolved are halved.

    Raises
    ------
    LoopError
        If no contour separates the known poles from all others, or the quadrature does not converge.
    """
    start = loop.transfer.dead_time
    end = until - start
    if end <= 0.0:
        return np.array([0.0, until]), np.zeros((1, DEGREE + 1))
    edges = [0.0, min(end, FIRST * loop.time_scale)]
    while edges[-1] < end:
        edges.append(min(end, GROWTH * edges[-1]))
    if start:  # the response is smooth only between multiples of the dead time, ever smoother later
        kinks = start * np.arange(1, KINKS)
        edges = sorted({*edges, *kinks[kinks < end].tolist()})
    starts = start * np.arange(KINKS) if start else np.zeros(1)  # where it may start like a broken power of time
    pending = list(pairwise(edges))[::-1]
    to_coefficients = chebyshev.values_to_coefficients(DEGREE)
    lefts: list[float] = []
    pieces: list[Array] = []
    largest = loop.size
    while pending:
        left, right = pending.pop()
        t = 0.5 * (left + right) + 0.5 * (right - left) * chebyshev.nodes(DEGREE)
        series = to_coefficients @ _values(loop, t, largest)
        largest = max(largest, float(np.max(np.abs(series))))
        since = left - float(starts[starts <= left][-1])
        least = SHORT * min(loop.time_scale, since) if since else SHORTEST * loop.shortest
        if np.max(np.abs(series[-2:])) > RESOLVED * largest and right - left > least:
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


def _values(loop: ClosedLoop, t: Array, size: float) -> Array:
    """Return the response, of some size, at times within one piece, counted from the end of the first dead time."""
    delay = loop.transfer.dead_time
    middle = float(t[t.size // 2])
    if not delay or middle > EXPANDED * delay:
        values = _invert(loop.closed, t, size, loop)
        if values is not None:
            return values
        if not delay or middle > MOST_EXPANDED * delay:
            raise LoopError(_why_not(loop, loop.closed, t))
    # after n dead times the loop has been gone around n times at most: a finite sum without closed-loop poles
    total = np.zeros_like(t)
    for n in range(int(middle / delay) + 1):
        part = _invert(loop.path(n), t - n * delay, size, None)
        if part is None:
            raise LoopError(_why_not(loop, loop.path(n), t))
        total += part
    return total


def _invert(transform: Callable[[Any], ComplexArray], t: Array, size: float, loop: ClosedLoop | None) -> Array | None:
    """Invert a transform at times t, or return None if no contour does.

    With a loop, its poles to the right of the contour are added as residues.
    """
    result = np.zeros_like(t)
    left = t > NOW * max(float(t.max()), 0.0)
    while left.any():  # one contour serves times that differ by no more than a factor
        longest = float(t[left].max())
        group = left & (t >= SPAN * longest)
        values = _invert_group(transform, t[group], size, loop)
        if values is None:
            return None
        result[group] = values
        left &= ~group
    return result


def _invert_group(
    transform: Callable[[Any], ComplexArray], t: Array, size: float, loop: ClosedLoop | None
) -> Array | None:
    longest, shortest = float(t.max()), float(t.min())
    for opening in OPENINGS:
        for scale in SCALES:
            contour = _Contour(scale / longest, opening)
            outside = contour.poles_to_the_right(loop, shortest) if loop else np.empty(0, dtype=complex)
            if outside is None:
                continue
            values = _refined(contour, transform, t, shortest, size)
            if values is None:
                continue
            if loop:
                for pole in outside.tolist():
                    pair = 2.0 if pole.imag else 1.0
                    values = values + pair * (loop.residue(pole) * np.exp(pole * t)).real
            return values
    return None


def _why_not(loop: ClosedLoop, transform: Callable[[Any], ComplexArray], t: Array) -> str:
    """Say why no contour inverts a transform at times ``t``."""
    hidden = _hidden_dead_time(loop.transfer.plant)
    if hidden:
        return (
            f"the plant's function holds a dead time of about {hidden * loop.unit:.2g}: "
            "take it out and give it as dead_time, or several as a sum of plants"
        )
    shortest = float(t[t > 0.0].min())
    paths = [_Contour(SCALES[0] / shortest, opening).around(loop, shortest) for opening in OPENINGS]
    s = np.concatenate(paths)
    with np.errstate(all="ignore"):
        wrong = s[~np.isfinite(transform(s))]
    if wrong.size:
        at = f"{wrong[0] / loop.unit:.3g}"
        return f"the plant's function is not finite at s = {at}: write it so that it does not overflow"
    lost = _where_digits_are_lost(loop.transfer.plant, s)
    if lost:
        return (
            f"the plant's function loses its digits at |s| = {lost / loop.unit:.3g}: write it so that nothing cancels"
        )
    return (
        "no contour inverts the response: the loop is too lightly damped, "
        "or the plant's function falls too slowly at high frequency"
    )


def _hidden_dead_time(plant: Plant) -> float:
    """Return the dead time T of a function that grows to the left as exp(-s T) does, else 0."""
    low, high = plant.corners
    size = np.geomspace(low, FAR * high, 60)
    left = size * np.exp(0.9j * np.pi)
    with np.errstate(all="ignore"):
        growth = np.log(np.abs(plant.delay_free(left))) / -left.real
    growth = growth[np.isfinite(growth)]
    # powers and roots of s grow more slowly: their rate falls
    last = growth[-4:]
    steady = last.size == 4 and float(np.ptp(last)) < STEADY * float(np.abs(last).max())
    return float(last[-1]) if steady and last[-1] > 0.0 else 0.0


def _where_digits_are_lost(plant: Plant, s: ComplexArray) -> float:
    """Return the largest modulus, of points below the lowest corner, at which the function is rough; 0 if at none."""
    slow = s[np.abs(s) < plant.corners[0]]
    with np.errstate(all="ignore"):
        before, here, after = (plant.delay_free(slow * (1.0 + NEXT * step)) for step in (-1.0, 0.0, 1.0))
        rough = np.abs(before - 2.0 * here + after) > ROUGH * np.abs(here)
    return float(np.max(np.abs(slow[rough]), initial=0.0))


def _refined(
    contour: _Contour, transform: Callable[[Any], ComplexArray], t: Array, shortest: float, size: float
) -> Array | None:
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
        size = max(size, float(np.max(np.abs(values))))
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
        depth = DECAYED / (self.scale * shortest * np.sin(self.opening)) + 2.0 / np.sin(self.opening)
        return float(np.arccosh(max(depth, 2.0)))

    def poles_to_the_right(self, loop: ClosedLoop, shortest: float) -> ComplexArray | None:
        """Return the known closed-loop poles to the right of the contour, or None if they are not all there are.

        The argument of 1 + L is followed from the contour's vertex along the upper arm, cut where exp(s t) has decayed,
        up, to the right, and down to the real axis. With its mirror image this path is closed: a pair inside adds two
        half turns, a real pole one.
        """
        path = self.around(loop, shortest)
        tip = path[ARM - 1]
        with np.errstate(all="ignore"):
            value = 1.0 + loop.transfer(path)
        if not np.isfinite(value).all():
            return None
        half_turns = round(abs(float(np.sum(np.angle(value[1:] / value[:-1])))) / np.pi)
        known = np.array(loop.poles, dtype=complex)
        inside = known[(known.real > np.where(known.imag < tip.imag, self.left_end(known.imag), tip.real))]
        return inside if half_turns == np.sum(np.where(inside.imag > 0.0, 2, 1)) else None

    def around(self, loop: ClosedLoop, shortest: float) -> ComplexArray:
        """Return the points of that path, those of the arm first."""
        arm, _ = self(np.linspace(0.0, self.reach(shortest), ARM))
        tip = arm[-1]
        top = max(2.0 * tip.imag, 2.0 * loop.bandwidth)
        up = tip + 1j * (top - tip.imag) * ALONG
        bridge = np.linspace(tip.real, top, 400) + 1j * top
        down = top + 1j * top * ALONG[::-1]
        return np.concatenate([arm, up, bridge, down])

    def left_end(self, height: Array) -> Array:
        """Return the real part of the point of the upper arm at an imaginary part."""
        rise = np.hypot(1.0, height / (self.scale * np.cos(self.opening)))
        return np.asarray(self.scale * (1.0 - np.sin(self.opening) * rise))

"""Closed-loop poles of loops with dead time, all of them and multiple ones, too.

Candidates (`replicate.loops.closed_loop_poles.pole_starts`) are polished by Newton's method on the exact characteristic
function. They only say where to look: what is returned satisfies f(s) = 0 to rounding, and the argument principle says
whether it is complete.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.closed_loop_poles.function_poles import (
    function_starts,
    missing_unstable,
    poles_at_controller_zeros,
)
from replicate.loops.closed_loop_poles.pole_starts import asymptotic_starts, generator_eigenvalues
from replicate.loops.closed_loop_poles.proven_pole import polished_poles
from replicate.loops.closed_loop_poles.zero_search import Box, Zero, zero_in_circle, zeros_in_box
from replicate.loops.controller import PID
from replicate.loops.errors import LoopError
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.frequency_domain.stability import argument_change
from replicate.loops.plant import Plant
from replicate.loops.plants.cut import has_cut

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

NEWTON_STEPS = 40
SOON = 8  # steps after which a simple zero has been found to rounding
SETTLED = 1e-12  # relative size of the step at such a zero: what is left is rounding
ARRIVED = 1e-6  # and at a multiple one
SPARE = 3  # zeros that are found besides those asked for before the others are given up
MOST_STARTS = 24
EPS = float(np.finfo(float).eps)
CLOSE = 0.03  # distance, relative to the modulus, of points that may be one multiple pole
STALLED = 1e-8  # size of f, relative to its terms, near a zero that Newton's method cannot reach
NOISE = 200.0  # rounding errors of f, in units of eps times its terms, within which it is zero
FEW = 4  # poles, up to which the discretisation alone has always been enough
STRIP, MOST_STRIPS = (
    0.7,
    12,
)  # width of a strip in which further poles are looked for, in units of 1/L, and their number
MOST = 10_000  # poles that may be asked for
MOST_TURNS = 3000.0  # rad of the longest dead time up to which poles are counted,
MANY_TURNS = 30_000.0  # and where more than a few are asked for
TIE = 1e-9  # relative difference of real parts that are equal
SAME = 1e-8  # relative distance of two poles that are one,
ONE = 1e-13  # and of points that are one to rounding, as those around a multiple pole are not
REAL, REAL_OF_FUNCTION = 1e-10, 1e-9  # imaginary part, relative to the modulus, of a pole that is real
AT_REST = 1e-9  # of the largest modulus: a pole at s = 0
SPREAD = 1e-9  # relative distance at which the parts of a multiple zero are set apart
BEHIND = 1e-6  # relative distance of the next pole to the left that lets a line pass between
AFTER, FARTHEST = 0.05, 0.2  # distance of a line after the last pole found, and the largest of one between two poles
BELOW = 0.0123  # share of a box's height by which it reaches below the real axis, where no edge meets a zero
CROWDED = 0.98  # |L| on a line from which on a neutral loop may have infinitely many poles there
SMALL, BEYOND = 0.9, (1.01, 1.1)  # |L| from which on there is no pole, and how far a box reaches beyond, up and right
SLOWEST = 1e-6  # of a box's height: where a path along it is dense at the real axis
CIRCLE, CLEAR, HALF_CLEAR = 0.1, 0.7, 0.4  # radius of a circle around a multiple pole: of its modulus, of what is clear
LARGEST_STEP = 0.3  # of Newton's method, relative to the modulus, so that s = 0 is not jumped over
ROUNDED, TINY = 4e-16, 1e-300  # last relative step, and a modulus that is none


def rightmost_poles(plant: Plant, controller: PID, transfer: LoopTransfer, count: int = 1) -> ComplexArray:
    """Return the rightmost closed-loop poles, sorted by descending real part, Im >= 0 (a pair counts once).

    A multiple pole is returned once; of equal real parts the lowest frequency comes first. A static loop has none, and
    a loop around a plant given by a function may have none off its cut.

    Raises
    ------
    LoopError
        If no pole of a rational loop is found.
    """
    if transfer.is_polynomial and (simple := _simple(transfer)) is not None:
        return np.array(simple[:count], dtype=complex)
    starts = _starts(plant, controller, transfer, count)
    if starts.size == 0 and (transfer.is_polynomial or transfer.num.size == 0):  # a static loop
        return starts
    if plant.parts:
        starts = starts[np.argsort(-starts.real)][: 4 * count + MOST_STARTS]
    starts = starts.real + 1j * np.abs(starts.imag)
    polished, converged = _newton(transfer, starts, count)
    # a multiple root has no slope for Newton: there the eigenvalue is as good as it gets
    points = np.where(converged, polished, starts) if transfer.is_polynomial else polished[converged]
    if not plant.parts:
        points = np.append(points, _stalled(transfer, polished[~converged]))
    if transfer.pole_at_rest:  # Newton's steps are relative to s
        points = np.append(points[np.abs(points) > AT_REST * np.abs(points).max(initial=0.0)], 0.0)
    found = _ordered(_distinct(transfer, points, count))
    if not plant.parts:
        others = np.concatenate([missing_unstable(transfer, found), poles_at_controller_zeros(transfer)])
        found = _merged(found, others.tolist())
    elif found and not transfer.is_polynomial and transfer.num.size:
        found = _completed(transfer, found, count)
    if not found and plant.parts:
        msg = "no closed-loop pole was found"
        raise LoopError(msg)
    return np.array(found[:count], dtype=complex)


def _starts(plant: Plant, controller: PID, transfer: LoopTransfer, count: int) -> ComplexArray:
    """Return where Newton's method looks for poles."""
    if transfer.is_polynomial:
        return transfer.closed_loop_roots
    if transfer.num.size == 0:  # no feedback: what is left are the poles of the open loop
        return transfer.open_loop_poles
    if not plant.parts:
        return function_starts(transfer, count)
    starts = generator_eigenvalues(plant, controller, transfer, count)
    return starts if count <= FEW else np.concatenate([starts, asymptotic_starts(transfer, count)])


def _simple(transfer: LoopTransfer) -> list[complex] | None:
    """Return the poles of a loop without dead time if they are simple and far from each other, not at s = 0."""
    roots = transfer.closed_loop_roots
    apart = np.abs(roots[:, None] - roots)
    np.fill_diagonal(apart, np.inf)
    if not (apart > CLOSE * np.abs(roots)).all():
        return None
    upper = [root for root in roots.tolist() if root.imag >= 0.0]
    found = polished_poles(transfer, upper)
    return _ordered(found) if len(found) == len(upper) else None


def merged(first: ComplexArray, second: ComplexArray, count: int) -> ComplexArray:
    """Return the rightmost of two sets of poles in the order of `rightmost_poles`, equal ones once."""
    return np.array(_merged(first.tolist(), second.tolist())[:count], dtype=complex)


def _ordered(poles: list[complex]) -> list[complex]:
    """Return poles by descending real part; of equal ones the lowest frequency first."""
    ordered: list[complex] = []
    left = sorted(poles, key=lambda p: (-p.real, p.imag))
    while left:
        tied = [p for p in left if left[0].real - p.real <= TIE * abs(left[0].real)]
        first = min(tied, key=lambda p: p.imag)
        left.remove(first)
        ordered.append(first)
    return ordered


def _distinct(transfer: LoopTransfer, points: ComplexArray, count: int) -> list[complex]:
    """Return each pole once: points that are one to rounding become one, near ones the multiple pole they are."""
    found: list[complex] = []
    points = points.real + 1j * np.abs(points.imag)  # on its way to the real axis Newton's method may cross it
    # a pair that is one double pole shows only one of its two
    close = points[(points.imag > 0.0) & (2.0 * points.imag <= CLOSE * np.abs(points))]
    points = np.concatenate([points, close.conj()])
    ordered = [complex(p) for p in points[np.argsort(-points.real)]]
    while ordered and len(found) < 2 * count + MOST_STARTS:
        first = ordered.pop(0)
        near = [p for p in ordered if abs(p - first) <= CLOSE * abs(first)]
        pole = complex(first.real, abs(first.imag))
        if near and max(abs(p - first) for p in near) > ONE * abs(first):
            others = [abs(p - first) for p in [*found, *ordered] if p not in near]
            multiple = _multiple(transfer, first, near, min(others, default=np.inf))
            if multiple is not None:
                pole = multiple
                ordered = [p for p in ordered if p not in near]
        if abs(pole.imag) < REAL * abs(pole):
            pole = complex(pole.real, 0.0)
        if not transfer.plant.parts and pole.imag < REAL_OF_FUNCTION * abs(pole) and pole.real <= 0.0:
            if has_cut(transfer, np.abs([pole]))[0]:
                continue
            pole = complex(pole.real, 0.0)
        if all(abs(pole - other) > SAME * abs(pole) for other in found):
            found.append(pole)
    return found


def _multiple(transfer: LoopTransfer, first: complex, near: list[complex], clear: float) -> complex | None:
    """Return the multiple pole that neighbouring points are to rounding, or None if they are poles of their own.

    ``clear`` is the distance of the next point that is not one of them.
    """
    spread = max(abs(p - first) for p in near)
    radius = max(min(HALF_CLEAR * clear, CIRCLE * abs(first)), 2.0 * spread)
    if radius > CLEAR * clear:
        return None
    zero = zero_in_circle(transfer.characteristic, transfer.characteristic_slope, first, radius)
    if zero is None or zero.order < 2:
        return None
    at = np.array([zero.place])
    size = transfer.size(at)[0]
    return zero.place if abs(complex(transfer.characteristic(at)[0])) <= NOISE * EPS * size else None


def _stalled(transfer: LoopTransfer, points: ComplexArray) -> ComplexArray:
    """Return the multiple poles near which Newton's method has stalled for want of digits of the function."""
    found: list[complex] = []
    for point in points[np.isfinite(points) & (points.real < 0.0)].tolist():
        value = transfer.characteristic(np.array([point]))
        if abs(complex(value[0])) <= STALLED * transfer.size(np.array([point]))[0]:
            zero = zero_in_circle(transfer.characteristic, transfer.characteristic_slope, point, CIRCLE * abs(point))
            if zero is not None and zero.order >= 2:
                found.append(zero.place)
    return np.array(found, dtype=complex)


def _completed(transfer: LoopTransfer, found: list[complex], count: int) -> list[complex]:
    """Return the poles with those that are missing to the right of the last one asked for.

    All poles to the right of a vertical line are counted along it. The line lies between two poles found; where it is
    too long to be followed, fewer are counted, and the rest is found strip after strip to the left.
    """
    few = min(count, len(found))
    line, expected = _line_after(transfer, found, few), None
    while few and (expected := _count_right_of(transfer, line, few)) is None:
        few //= 2
        line = _line_after(transfer, found, few) if few else line
    if expected is None:
        return found
    right, left = [p for p in found if p.real > line], [p for p in found if p.real <= line]
    if expected != sum(2 if p.imag else 1 for p in right):
        top, edge = _reach(transfer, line)
        zeros = _zeros_in(transfer, Box(line, edge, -BELOW * top, top))
        if zeros is None:
            return found
        # a multiple zero is where its parts are, as far as they were told apart
        places = [zero.place * (1.0 + SPREAD * n) for zero in zeros for n in range(zero.order)]
        right = _distinct(transfer, np.array(places, dtype=complex), count)
    if few < count and not transfer.feedthrough:
        right = _extended(transfer, right, line, count)
    return _merged(right, left)


def _line_after(transfer: LoopTransfer, found: list[complex], count: int) -> float:
    """Return the real part of a vertical line to the left of so many poles, and to the right of the next."""
    last = found[count - 1].real
    after = [p.real for p in found[count:] if p.real < last - BEHIND * abs(last)]
    line = 0.5 * (last + after[0]) if after else last - AFTER * abs(last)
    # the nearer the line is to the poles, the lower the frequencies up to which it has to be followed
    return max(line, last - FARTHEST * max(abs(last), 1.0 / _longest(transfer)))


def _extended(transfer: LoopTransfer, found: list[complex], right: float, count: int) -> list[complex]:
    """Return all poles to the right of a line with more to its left, until there are as many as asked for."""
    for _ in range(MOST_STRIPS):
        line = right - STRIP / _longest(transfer)
        if len(found) >= count or _count_right_of(transfer, line, count) is None:
            break
        top, _ = _reach(transfer, line)
        zeros = _zeros_in(transfer, Box(line, right, -BELOW * top, top))
        if zeros is None:
            break
        places = np.array([zero.place for zero in zeros], dtype=complex)
        found = _merged(found, _distinct(transfer, places, len(zeros)))
        right = line
    return found


def _zeros_in(transfer: LoopTransfer, box: Box) -> list[Zero] | None:
    return zeros_in_box(transfer.characteristic, transfer.characteristic_slope, box, turning=_longest(transfer))


def _merged(first: list[complex], second: list[complex]) -> list[complex]:
    """Return two lists of poles as one, equal ones once, in order."""
    return _ordered([*first, *(p for p in second if all(abs(p - q) > SAME * abs(p) for q in first))])


def _longest(transfer: LoopTransfer) -> float:
    return max(part.dead_time for part in transfer.plant.parts) or 1.0


def _reach(transfer: LoopTransfer, line: float) -> tuple[float, float]:
    """Return the height and the right end of a rectangle that holds all poles to the right of a vertical line."""
    growth = float(np.exp(-min(line, 0.0) * _longest(transfer)))
    level = max(SMALL, 0.5 * (1.0 + transfer.feedthrough * growth)) / growth
    top = BEYOND[0] * transfer.beyond(level) + abs(line)
    return top, max(top, BEYOND[1] * abs(line))


def _count_right_of(transfer: LoopTransfer, line: float, asked: int) -> int | None:
    """Return the number of zeros of f with Re s > line, of which so many are asked for; None if it cannot be said."""
    growth = float(np.exp(-min(line, 0.0) * _longest(transfer)))
    if transfer.feedthrough * growth >= CROWDED:
        return None
    top, edge = _reach(transfer, line)
    if top * _longest(transfer) > (MOST_TURNS if asked <= FEW else MANY_TURNS):
        return None
    box = Box(line, edge, -0.0, top)
    steps = max(64, int(4.0 * top * _longest(transfer)))
    up = np.unique(np.concatenate([np.linspace(0.0, top, steps), np.geomspace(SLOWEST * top, top, 64)]))
    path = np.concatenate([
        np.linspace(edge, edge + 1j * top, 64), np.linspace(edge + 1j * top, box.left + 1j * top, 96)[1:],
        box.left + 1j * up[::-1][1:],
    ])  # fmt: skip
    # f is real on the real axis, so the upper half of the contour turns by half of the whole
    turn = argument_change(transfer.characteristic, path)
    return None if turn is None else round(turn / np.pi)


def _newton(transfer: LoopTransfer, s: ComplexArray, count: int) -> tuple[ComplexArray, NDArray[np.bool_]]:
    """Polish zeros of the characteristic function by Newton's method with limited steps, all at once.

    Returns the points and whether each has converged; a multiple zero stops at the root of the rounding error. A point
    that is still far from a zero when enough others have converged to the right of it is not followed any longer.
    """
    s = np.array(s, dtype=complex)
    step = np.full(s.shape, np.inf, dtype=complex)
    with np.errstate(all="ignore"):
        for done in range(NEWTON_STEPS):
            moving = (np.abs(step) > ROUNDED * np.abs(s)) & np.isfinite(s) & (s != 0.0)
            if done >= SOON:
                settled = np.abs(step) <= SETTLED * np.abs(s)
                reals = np.sort(s.real[settled])
                left = reals[-count - SPARE] if reals.size >= count + SPARE else -np.inf
                moving &= ~settled & (s.real > left)
            if not moving.any():
                break
            at = s[moving]
            value, slope = transfer.characteristic_with_slope(at)
            change = value / slope
            change *= np.minimum(1.0, LARGEST_STEP * np.maximum(np.abs(at), TINY) / np.abs(change))
            # a plant's pole that the controller cancels has no value: the step before it is the last
            known = np.isfinite(change) | ~(np.abs(step[moving]) <= ARRIVED * np.abs(at))
            step[moving] = np.where(known, change, ROUNDED * at)
            s[moving] = np.where(known, at - change, at)
    return s, np.isfinite(s) & (s != 0.0) & (np.abs(step) <= ARRIVED * np.abs(s))

r"""All zeros of an analytic function in a rectangle, by the argument principle; multiple zeros as the means they are.

The number of zeros inside a contour is the winding of f along it. A rectangle is halved until each part holds one zero,
which Newton's method finds, or zeros so close that they are one multiple zero to rounding, whose place is the mean

.. math:: \frac{1}{2\pi i m} \oint s \frac{f'(s)}{f(s)}\, ds .

Reference: Delves and Lyness, "A numerical method for locating the zeros of an analytic function", Math. Comp. 21
(1967).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from replicate.loops.frequency_domain.stability import argument_change

ComplexArray = NDArray[np.complex128]
Function = Callable[[ComplexArray], ComplexArray]

CIRCLE_POINTS = 64
WHOLE = 1e-3  # distance of a count of zeros from a whole number, unless one lies near the circle
LARGEST_STEP = 0.3  # of Newton's method, relative to the modulus, so that s = 0 is not jumped over
ARRIVED, STEPS = 1e-14, 60  # its last relative step, and their number
EDGE_POINTS = 24
PER_RADIAN = 3.0  # points of an edge for each rad that the argument may turn
SMALLEST = 1e-9  # size of a rectangle, relative to the modulus, in which several zeros are one
CUTS = (0.5, 0.4837, 0.5309, 0.4511)  # where a rectangle is cut; the next one if a zero lies on the cut


@dataclass(frozen=True)
class Zero:
    """A zero and its multiplicity."""

    place: complex
    order: int


@dataclass(frozen=True)
class Box:
    """A rectangle of the complex plane."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def middle(self) -> complex:
        """Its middle."""
        return complex(0.5 * (self.left + self.right), 0.5 * (self.bottom + self.top))

    @property
    def size(self) -> float:
        """Its longer side."""
        return max(self.right - self.left, self.top - self.bottom)

    def halves(self, share: float) -> tuple[Box, Box]:
        """Return the two parts into which a cut across the longer side divides it."""
        if self.right - self.left >= self.top - self.bottom:
            cut = self.left + share * (self.right - self.left)
            return Box(self.left, cut, self.bottom, self.top), Box(cut, self.right, self.bottom, self.top)
        cut = self.bottom + share * (self.top - self.bottom)
        return Box(self.left, self.right, self.bottom, cut), Box(self.left, self.right, cut, self.top)


def zeros_in_box(f: Function, slope: Function, box: Box, turning: float = 0.0) -> list[Zero] | None:
    """Return all zeros in a rectangle, or None if one lies on its edge.

    Parameters
    ----------
    f, slope
        The function and its derivative.
    box
        The rectangle.
    turning
        How fast the argument of f may turn along an edge, rad per unit of length.
    """
    count = count_in_box(f, box, turning)
    if count is None:
        return None
    found: list[Zero] = []
    pending = [(box, count)]
    while pending:
        part, inside = pending.pop()
        if inside <= 0:
            continue
        if inside == 1:
            place = newton(f, slope, part.middle)
            if place is not None and _contains(part, place):
                found.append(Zero(place, 1))
                continue
        if part.size < SMALLEST * abs(part.middle):
            found.append(Zero(part.middle, inside))
            continue
        for share in CUTS:
            halves = part.halves(share)
            counts = [count_in_box(f, half, turning) for half in halves]
            if None not in counts:
                pending += [(half, number) for half, number in zip(halves, counts, strict=True) if number]
                break
        else:
            found.append(Zero(part.middle, inside))
    return found


def count_in_box(f: Function, box: Box, turning: float = 0.0) -> int | None:
    """Return the number of zeros in a rectangle, or None if one lies on its edge; see `zeros_in_box`."""
    corners = [
        complex(box.left, box.bottom), complex(box.right, box.bottom),
        complex(box.right, box.top), complex(box.left, box.top), complex(box.left, box.bottom),
    ]  # fmt: skip
    path = np.concatenate(
        [np.linspace(a, b, max(EDGE_POINTS, int(PER_RADIAN * turning * abs(b - a))))[:-1] for a, b in pairwise(corners)]
    )
    turn = argument_change(f, np.append(path, corners[0]))
    return None if turn is None else round(turn / (2.0 * np.pi))


def zero_in_circle(f: Function, slope: Function, center: complex, radius: float) -> Zero | None:
    """Return the mean of the zeros in a circle and their number, or None if there is none or one near its edge."""
    turn = np.exp(2j * np.pi * (np.arange(CIRCLE_POINTS) + 0.5) / CIRCLE_POINTS)
    s = center + radius * turn
    ratio = slope(s) / f(s) * radius * turn
    count = float(np.mean(ratio).real)
    order = round(count)
    if order < 1 or abs(count - order) > WHOLE:
        return None
    return Zero(center + complex(np.mean((s - center) * ratio)) / order, order)


def newton(f: Function, slope: Function, start: complex) -> complex | None:
    """Return the zero to which Newton's method leads, or None if it does not converge."""
    s = np.array([start], dtype=complex)
    for _ in range(STEPS):
        with np.errstate(all="ignore"):
            step = f(s) / slope(s)
        if not np.isfinite(step[0]):
            return None
        s = s - step * min(1.0, LARGEST_STEP * abs(s[0] / step[0]) if step[0] else 1.0)
        if abs(step[0]) <= ARRIVED * abs(s[0]):
            return complex(s[0])
    return None


def _contains(box: Box, s: complex) -> bool:
    return box.left <= s.real <= box.right and box.bottom <= s.imag <= box.top

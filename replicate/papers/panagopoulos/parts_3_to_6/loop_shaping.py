r"""Paper III: the plant of its examples, the gamma contour, and the circle that encloses it.

The gamma contour is the set of points L with (1 + \|L\|)/\|1 + L\| = gamma; a Nyquist curve outside it has
\|S\| + \|T\| <= gamma.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.exhibits.extrema import largest, smallest
from replicate.loops import PI, Circle, PIDesign, Plant, Weight, design_pi

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PROCESS = Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0])  # (9): 1/(s+1)^4
TRUE_PROCESS = Plant([1.0], [4.0, 4.0, 1.0])  # Example 2: 1/(2s+1)^2
M = 2.0  # the combined circle of Example 1
PRINTED = PI(k=0.76, ki=0.36)  # the controller of Example 1 as the paper states it
CONTOURS = (2.0, 2.3, 2.6, 3.0, 4.0, 6.0, 8.0, 10.0)  # Figure 5


@cache
def design() -> PIDesign:
    """Return the PI design of Example 1, unrounded."""
    return design_pi(PROCESS, ms=M, mp=M)


def favourable_weight(controller: PI = PRINTED) -> Weight:
    """Return the weight (8) of Example 1."""
    return Weight.balancing(PROCESS, controller)


def combined_circle(m: float) -> Circle:
    """Return the combined circle of equal bounds on both sensitivities (section 3)."""
    return Circle.of(ms=m, mp=m)


def m_of_gamma(gamma: ArrayLike) -> Array:
    """Return the M whose combined circle encloses the gamma contour (13)."""
    gamma = np.asarray(gamma, dtype=float)
    q = np.sqrt(gamma**2 - 1.0)
    return np.asarray((gamma**2 + 2.0 * q) / (2.0 + 2.0 * q))


def gamma_of_m(m: ArrayLike) -> Array:
    """Return the gamma that the combined M-circle guarantees (14)."""
    m = np.asarray(m, dtype=float)
    return np.asarray(np.sqrt(4.0 * m**2 - 4.0 * m + 2.0))


def gamma_at(loop: ArrayLike) -> Array:
    """Return (1 + |L|)/|1 + L| at values of the loop transfer function (12)."""
    loop = np.asarray(loop, dtype=complex)
    return np.asarray((1.0 + np.abs(loop)) / np.abs(1.0 + loop))


class Contour(NamedTuple):
    """The points of the contour that the right half of Figure 5 marks, as signed coordinates.

    A is where the contour crosses the unit circle; B and D are its ends on the real axis, C the centre of the
    combined circle through A.
    """

    phase_of_a: float  # radians, upper half-plane
    ob: float
    od: float
    oc: float
    ac: float


def contour_points(gamma: float) -> Contour:
    """Return the marked points of the contour by the formulas of section 4."""
    square = gamma**2
    return Contour(
        phase_of_a=float(np.arccos((2.0 - square) / square)),
        ob=-(gamma + 1.0) / (gamma - 1.0),
        od=-(gamma - 1.0) / (gamma + 1.0),
        oc=square / (2.0 - square),
        ac=2.0 * float(np.sqrt((square - 1.0) / (square - 2.0) ** 2)),
    )


def _branches(gamma: float) -> list[Callable[[float], complex]]:
    """Return the upper half of the contour as two functions of a parameter from 0, at A, to 1, at D and at B."""
    start = contour_points(gamma).phase_of_a

    def point(u: float, sign: float) -> complex:
        phase = start + (np.pi - start) * u**2
        c = (gamma**2 * np.cos(phase) - 1.0) / (gamma**2 - 1.0)
        outer = -c + np.sqrt(max(c**2 - 1.0, 0.0)) if u > 0.0 else 1.0
        return complex(outer**sign * np.exp(1j * phase))

    return [lambda u: point(u, -1.0), lambda u: point(u, 1.0)]


def distances(gamma: float, circle: Circle) -> tuple[float, float]:
    """Return how near to the centre of a circle the contour comes, and how far from it, as parts of its radius."""
    grid = np.linspace(0.0, 1.0, 101)
    near, far = [], []
    for branch in _branches(gamma):

        def distance(u: float, branch: Callable[[float], complex] = branch) -> float:
            return abs(branch(u) + circle.center) / circle.radius

        near.append(smallest(distance, grid)[1])
        far.append(largest(distance, grid)[1])
    return min(near), max(far)


def enclosed_area(gamma: float) -> float:
    """Return the area inside the contour."""
    from scipy.integrate import quad

    start = contour_points(gamma).phase_of_a

    def slice_(phase: float) -> float:
        # r^2 of the outer branch less that of the inner one, whose product is one: r + 1/r = -2c
        c = (gamma**2 * np.cos(phase) - 1.0) / (gamma**2 - 1.0)
        return float(-4.0 * c * np.sqrt(max(c**2 - 1.0, 0.0)))

    # both halves, each half of the integral of r^2; the root vanishes at A
    return float(quad(lambda u: 2.0 * u * (np.pi - start) * slice_(start + (np.pi - start) * u**2), 0.0, 1.0)[0])


def contour(gamma: float, points: int = 721) -> ComplexArray:
    """Return the closed contour, shape (4 * points - 3,), from A over D, conj(A) and B back to A.

    The print of r(phi) shows the "-1" after the root's argument; it belongs under the root:
    r = -c +- sqrt(c^2 - 1) with c = (gamma^2 cos(phi) - 1)/(gamma^2 - 1), since the product of both radii is one.
    """
    start = contour_points(gamma).phase_of_a
    # equal steps of the square root of the distance in phase: the branches meet at A with a vertical tangent
    phase = start + (np.pi - start) * np.linspace(0.0, 1.0, points) ** 2
    c = (gamma**2 * np.cos(phase) - 1.0) / (gamma**2 - 1.0)
    root = np.sqrt(np.maximum(c**2 - 1.0, 0.0))
    root[0] = 0.0  # c = -1 at A; its rounding error would come out as its square root
    inner, outer = 1.0 / (-c + root), -c + root
    turn = np.exp(1j * phase)
    upper_in, upper_out = inner * turn, outer * turn
    return np.concatenate([upper_in, upper_in[-2::-1].conj(), upper_out.conj()[1:], upper_out[-2::-1]])

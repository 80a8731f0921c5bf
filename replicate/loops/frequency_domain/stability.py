r"""Stability by the argument principle, never by a Pade model.

For the characteristic function :math:`f = D (1 + L)` with D of degree n and |L| finally below one, the number
Z of zeros in the open right half-plane follows from the continuous change of its argument along the imaginary axis,

.. math:: \Delta_{0\to\infty} \arg f(i\omega) = (n - 2 Z) \frac{\pi}{2}.

Between two gain crossovers 1 + L cannot encircle the origin where |L| < 1, nor 1 + 1/L where |L| > 1. As
f = D (1 + L) = N e^{-sL} (1 + 1/L) and the arguments of D, N and the dead time are known in closed form, the gain
crossovers of a rational loop alone decide, however many turns its dead time makes in between. For other plants the
argument is followed on a grid that is refined where it turns fast.

Reference: Michiels and Niculescu, "Stability, Control, and Computation for Time-Delay Systems" (2014), chapter 1.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from replicate.loops.errors import ImproperLoopError
from replicate.loops.frequency_domain.frequency_grids import loop_grid
from replicate.loops.frequency_domain.limit_torus import LimitTorus
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics.bracketed import bracketed_root

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

LARGEST_TURN = 0.8  # rad between neighbouring points; anything below pi/2 identifies the branch
ON_AXIS = 1e-14  # relative distance from the axis at which a root is on it to rounding
DEEPEST = 60  # bisections of one interval before a zero is taken to lie on the axis
TOUCHING = 1e-13  # |1 + L| at a gain crossover at which a pole is on the axis to rounding
CLOSED_FORM = 3  # coefficients of D up to which the crossovers are roots of a quadratic in w^2
APART = 1e-3  # relative distance of crossovers that are not a double root
PER_DECADE = 30  # of the grid on which gain crossovers are checked
BAND = 1e3  # factor by which it goes beyond the corners on both sides
ARC_POINTS = 33
UNDAMPED = 1e-12  # damping of a function's pole that is on the axis to rounding,
BESIDE = 1e-8  # and the radius of the path around it, both relative to its modulus


def unstable_poles(transfer: LoopTransfer) -> int:
    """Return the number of closed-loop poles with Re s >= 0; a pole on the axis counts as unstable.

    Raises
    ------
    ImproperLoopError
        If the loop is of neutral type with |L| >= 1 at infinite frequency and dead time: it then has infinitely many
        unstable poles.
    LoopError
        If it cannot be said whether it has them: with dead times of which only some have a common measure.
    """
    if transfer.feedthrough >= 1.0 and not transfer.is_polynomial:
        if isinstance(transfer.limit_curve, LimitTorus):
            transfer.limit_curve.refuse("number of unstable poles")
        why = f"|L| tends to {transfer.feedthrough:g} >= 1 at infinite frequency"
        msg = f"{why}: the loop has infinitely many unstable poles"
        raise ImproperLoopError(msg)
    if transfer.is_polynomial:
        roots = transfer.closed_loop_roots
        return int(np.sum(roots.real >= -ON_AXIS * np.abs(roots)))
    if transfer.is_rational:
        return _from_crossovers(transfer)
    if transfer.pole_at_rest:
        return 1
    end = transfer.beyond(0.5 * (1.0 + transfer.feedthrough))
    w = loop_grid(transfer, end)
    axis = np.asarray(1j * w[1:], dtype=complex)
    # f is real on the positive real axis: around s = 0, where it may branch, and up the imaginary axis
    around = w[0] * np.exp(0.5j * np.pi * np.linspace(0.0, 1.0, ARC_POINTS))
    along = axis if transfer.plant.parts else _beside_poles(axis, transfer.plant.resonances)
    turn = argument_change(transfer.characteristic, np.concatenate([around, along]))
    if turn is None:
        return 1  # a zero on the axis itself
    poles = transfer.open_loop_poles
    # arg D from the last point to infinity, root by root
    remainder = float(np.sum(0.5 * np.pi - np.angle(1j * w[-1] - poles)))
    closing = -float(np.angle(1.0 + transfer(1j * w[-1])))
    zeros = 0.5 * poles.size - (turn + remainder + closing) / np.pi
    return max(0, round(zeros))


def _beside_poles(axis: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Return points of the imaginary axis with a half circle to the right of each pole of a function that is on it."""
    for pole in poles[np.abs(poles.real) < UNDAMPED * np.abs(poles)].tolist():
        radius = BESIDE * abs(pole)
        around = 1j * pole.imag + radius * np.exp(0.5j * np.pi * np.linspace(-1.0, 1.0, ARC_POINTS))
        below, above = axis[axis.imag < pole.imag - radius], axis[axis.imag > pole.imag + radius]
        axis = np.concatenate([below, around, above])
    return axis


def is_stable(transfer: LoopTransfer) -> bool:
    """Return whether all closed-loop poles lie in the open left half-plane."""
    try:
        return unstable_poles(transfer) == 0
    except ImproperLoopError:
        return False


def _from_crossovers(transfer: LoopTransfer) -> int:
    """Return the number of unstable poles of a rational loop with dead time."""
    if transfer.num.size == 0:
        poles = transfer.open_loop_poles
        return int(np.sum(poles.real >= -ON_AXIS * np.abs(poles)))
    if transfer.den[-1] + transfer.num[-1] == 0.0:
        return 1
    poles, zeros = transfer.open_loop_poles.tolist(), transfer.zeros.tolist()
    sign = math.pi if transfer.num[0] < 0.0 else 0.0
    crossovers = _all_crossovers(transfer).tolist()
    edges: list[tuple[float, complex]] = [(0.0, _at_rest(transfer))]
    edges += [(w, complex(transfer(complex(0.0, w)))) for w in crossovers]
    if any(abs(1.0 + value) < TOUCHING for _, value in edges[1:]):
        return 1

    def argument(w: float, value: complex, small: bool) -> float:
        if small:
            return _argument(poles, w) + cmath.phase(1.0 + value)
        return sign + _argument(zeros, w) - w * transfer.dead_time + cmath.phase(1.0 + 1.0 / value)

    change = 0.0
    for (low, at_low), (high, at_high) in pairwise(edges):
        small = abs(complex(transfer(complex(0.0, math.sqrt(low * high) or 0.5 * high)))) < 1.0
        change += argument(high, at_high, small) - argument(low, at_low, small)
    # beyond the last crossover |L| stays below one
    change += 0.5 * math.pi * len(poles) - argument(*edges[-1], small=True)
    return max(0, round(0.5 * len(poles) - change / math.pi))


def _all_crossovers(transfer: LoopTransfer) -> Array:
    """Return all gain crossovers; those that the roots of an ill-conditioned polynomial miss are found on a grid."""
    roots = transfer.gain_crossovers
    roots = roots[np.isfinite(roots) & (roots > 0.0)]
    if transfer.den.size <= CLOSED_FORM and np.all(np.diff(roots) > APART * roots[1:]):
        return roots
    corners = np.concatenate([np.abs(transfer.corner_frequencies), roots])
    if corners.size == 0:
        return roots
    low, high = corners.min() / BAND, BAND * corners.max()
    count = max(2, int(PER_DECADE * math.log10(high / low)))
    grid = np.exp(np.linspace(math.log(low), math.log(high), count))
    w = np.sort(np.concatenate([grid, np.sqrt(roots[1:] * roots[:-1])]))
    low_gain = np.abs(transfer(1j * w)) < 1.0

    found: list[float] = []
    for i in np.nonzero(low_gain[:-1] != low_gain[1:])[0]:
        inside = roots[(roots > w[i]) & (roots <= w[i + 1])]
        if inside.size % 2:
            found += inside.tolist()
        else:
            found.append(bracketed_root(transfer.log_modulus, w[i], w[i + 1]))
    return np.unique(found)


def _argument(roots: Sequence[complex], w: float) -> float:
    """Return the argument of the product of i w - root, continuous in w >= 0."""
    at = complex(0.0, w)
    turns = [cmath.phase(at - root) if root.real <= 0.0 else math.pi + cmath.phase(root - at) for root in roots]
    return math.fsum(turns)


def _at_rest(transfer: LoopTransfer) -> complex:
    """Return L(0), or a number too large for its inverse to count."""
    return complex(transfer.num[-1] / transfer.den[-1]) if transfer.den[-1] else complex(np.inf)


def argument_change(f: Callable[[ComplexArray], ComplexArray], path: ComplexArray) -> float | None:
    """Return the continuous change of arg f along a path, or None if a zero lies on the way or f overflows."""
    value = f(path)
    for _ in range(DEEPEST):
        if np.any(value == 0.0) or not np.isfinite(value).all():
            return None
        # of the angles themselves: a ratio of two values can overflow
        turns = np.mod(np.diff(np.angle(value)) + np.pi, 2.0 * np.pi) - np.pi
        coarse = np.nonzero(np.abs(turns) > LARGEST_TURN)[0]
        if coarse.size == 0:
            return float(np.sum(turns))
        middle = 0.5 * (path[coarse] + path[coarse + 1])
        if np.any((middle == path[coarse]) | (middle == path[coarse + 1])):
            return None
        path = np.insert(path, coarse + 1, middle)
        value = np.insert(value, coarse + 1, f(middle))
    return None

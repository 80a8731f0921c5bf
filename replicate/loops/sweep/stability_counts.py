r"""Stability of many loops at once, by the argument principle over their gain crossovers.

The same count as `replicate.loops.frequency_domain.stability`: between two gain crossovers the change of the argument
of :math:`f = D (1 + L) = N e^{-sL} (1 + 1/L)` is known in closed form. What cannot be decided here with certainty,
because crossovers nearly touch or the curve nearly passes through -1, is left to the single loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.sweep.loop_columns import LoopColumns, horner

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Flags = NDArray[np.bool_]

REAL = 1e-8  # imaginary part, relative to the modulus, of a root in w^2 that is real
DOUBTFUL = 1e-3  # and below which it may be one of a double root
CLEAR = 1e-4  # distance of |L| at rest from one, and of L from -1, that leaves no doubt
APART = 1e-6  # distance of L from -1 at a crossover that leaves none, where |L| is one there; if it is not,
OFF = 1e4  # so many times the difference more: between crossovers that are no double root the phase turns no faster
UNSTABLE, STABLE, UNDECIDED = 0, 1, 2


@dataclass(frozen=True)
class Characteristic:
    """N, D and the dead time of the characteristic functions D + N exp(-delay s) of many loops.

    Attributes
    ----------
    num, den
        Coefficients, descending powers, shapes (degree + 1, n) or (degree + 1, 1) where all loops share them.
    zeros, poles
        The roots of N and of D, each of shape (n,) or (1,).
    lost
        Loops whose N is of lower degree than the others'.
    delay
        One, or zero; without dead time L must vanish at infinite frequency.
    """

    num: Array
    den: Array
    zeros: Sequence[ComplexArray]
    poles: Sequence[ComplexArray]
    lost: Flags
    delay: float

    @classmethod
    def of(cls, loops: LoopColumns) -> Characteristic:
        """Return those of a block."""
        own, lost = _controller_roots(loops.controller_zeros)
        return cls(
            loops.num, loops.den[:, None], [*loops.zeros[:, None], *own], [*loops.poles[:, None]], lost, loops.delay
        )

    def shifted(self, by: Array) -> Characteristic:
        """Return those whose roots are moved by -by, which differs from loop to loop."""
        num, den = _shifted(self.num, by) * np.exp(-self.delay * by), _shifted(self.den, by)
        zeros, poles = ([root - by for root in roots] for roots in (self.zeros, self.poles))
        return replace(self, num=num, den=den, zeros=zeros, poles=poles)

    @property
    def feedthrough(self) -> Array:
        """The limits of |L| at infinite frequency."""
        if self.num.shape[0] < self.den.shape[0]:
            return np.zeros(self.num.shape[1])
        return np.asarray(np.abs(self.num[0] / self.den[0]))


def stability(loops: LoopColumns) -> tuple[NDArray[np.int8], Array]:
    """Return for each loop UNSTABLE, STABLE or UNDECIDED, and the gain crossovers.

    The crossovers have shape (most, n), ascending; ``inf`` where a loop has fewer.
    """
    function = Characteristic.of(loops)
    count, doubtful, crossovers = unstable_poles(function)
    decided = np.where(count <= 0.0, STABLE, UNSTABLE)
    # without bound at high frequency: infinitely many unstable poles
    decided = np.where(function.feedthrough >= 1.0, UNSTABLE, np.where(doubtful, UNDECIDED, decided))
    return decided.astype(np.int8), crossovers


def unstable_poles(function: Characteristic) -> tuple[Array, Flags, Array]:
    """Return the numbers of zeros with Re s > 0, which of them are in doubt, and the gain crossovers."""
    crossovers, doubtful = gain_crossovers(function)
    doubtful |= function.lost
    most, count = crossovers.shape
    finite = np.isfinite(crossovers)
    w = np.where(finite, crossovers, 1.0)
    value = horner(function.num, 1j * w) / horner(function.den, 1j * w) * np.exp(-1j * function.delay * w)
    off = OFF * (1.0 + function.delay * w) * np.abs(np.abs(value) - 1.0)
    doubtful |= np.any(finite & ~(np.abs(1.0 + value) > APART + off), axis=0)
    principal = np.angle(1.0 + value)  # where |L| = 1 the argument of 1 + 1/L is the opposite
    small_side = _argument(function.poles, w) + principal
    large_side = _argument(function.zeros, w) - function.delay * w - principal
    # at rest
    with np.errstate(all="ignore"):
        at_rest = np.where(function.den[-1] == 0.0, np.inf, function.num[-1] / function.den[-1])
    small = np.abs(at_rest) < 1.0
    doubtful |= np.abs(np.abs(at_rest) - 1.0) < CLEAR
    doubtful |= np.abs(1.0 + at_rest) < CLEAR
    rest = np.zeros(count)
    before_small, before_large = _argument(function.poles, rest), _argument(function.zeros, rest)
    change = np.zeros(count)
    for i in range(most):
        here = finite[i]
        step = np.where(small, small_side[i] - before_small, large_side[i] - before_large)
        change += np.where(here, step, 0.0)
        before_small, before_large = (
            np.where(here, small_side[i], before_small),
            np.where(here, large_side[i], before_large),
        )
        small = np.where(here, ~small, small)
    doubtful |= ~small  # |L| ends below one
    degree = function.den.shape[0] - 1
    change += 0.5 * np.pi * degree - before_small
    zeros = 0.5 * degree - change / np.pi
    found = np.round(zeros)
    return found, doubtful | (np.abs(zeros - found) > 0.1), crossovers


def gain_crossovers(function: Characteristic) -> tuple[Array, Flags]:
    """Return the frequencies with |L| = 1, ascending and ``inf`` at the end, and whether some may be missing."""
    n, d = squared_magnitude(function.num), squared_magnitude(function.den)
    difference = np.array(np.broadcast_to(d, (d.shape[0], n.shape[1])))
    difference[-n.shape[0] :] -= n
    roots, lost = polynomial_roots(difference)
    with np.errstate(all="ignore"):
        off = np.abs(roots.imag) / np.abs(roots.real)
    real = (roots.real > 0.0) & (off <= REAL)
    doubtful = lost | np.any((roots.real > 0.0) & (off > REAL) & (off < DOUBTFUL), axis=0)
    w = np.sort(np.where(real, np.sqrt(np.maximum(roots.real, 0.0)), np.inf), axis=0)
    with np.errstate(invalid="ignore"):
        doubtful |= np.any(w[1:] - w[:-1] < DOUBTFUL * w[:-1], axis=0)
    most = int(np.max(np.sum(np.isfinite(w), axis=0), initial=0))
    return w[:most], doubtful


def squared_magnitude(rows: Array) -> Array:
    """Return the coefficients in x = w^2 of |p(i w)|^2 for polynomials in columns, descending powers."""
    degree = rows.shape[0] - 1
    mirrored = rows * ((-1.0) ** np.arange(degree, -1, -1))[:, None]
    product = np.zeros((2 * degree + 1, rows.shape[1]))
    for i in range(degree + 1):
        product[i : i + degree + 1] += rows[i] * mirrored
    even = product[::2]
    return np.asarray(even * ((-1.0) ** np.arange(degree, -1, -1))[:, None])


def polynomial_roots(rows: Array) -> tuple[ComplexArray, Flags]:
    """Return the roots of polynomials in columns, shape (degree, n), and where the leading coefficient vanishes."""
    lost = rows[0] == 0.0
    monic = rows[1:] / np.where(lost, 1.0, rows[0])
    degree, count = monic.shape
    if degree <= 1:
        return -monic.astype(complex), lost
    if degree == 2:
        half, product = -0.5 * monic[0], monic[1]
        root = np.sqrt((half**2 - product).astype(complex))
        large = half + np.where(half >= 0.0, root, -root)
        with np.errstate(all="ignore"):
            small = np.where(large != 0.0, product / large, 0.0)
        return np.stack([large, small]), lost
    companion = np.zeros((count, degree, degree))
    companion[:, 0] = -monic.T
    companion[:, 1:, :-1] = np.eye(degree - 1)
    return np.asarray(np.linalg.eigvals(companion), dtype=complex).T, lost


def _controller_roots(rows: Array) -> tuple[ComplexArray, Flags]:
    if rows.shape[0] < 2:
        return np.zeros((0, rows.shape[1]), dtype=complex), rows[0] == 0.0
    return polynomial_roots(rows)


def _argument(roots: Sequence[ComplexArray], w: Array) -> Array:
    """Return the argument of the product of i w - root, continuous in w >= 0."""
    total = np.zeros(w.shape)
    for root in roots:
        if root.size > 1:
            left = np.arctan2(w - root.imag, -root.real)
            total += np.where(root.real > 0.0, np.pi + np.arctan2(root.imag - w, root.real), left)
        elif root.real > 0.0:
            total += np.pi + np.arctan2(root.imag - w, root.real)
        elif root == 0.0:
            total += 0.5 * np.pi
        else:
            total += np.arctan2(w - root.imag, -root.real)
    return total


def _shifted(rows: Array, by: Array) -> Array:
    """Return the polynomials p(s + by), one in each column, by repeated synthetic division."""
    shifted = np.array(np.broadcast_to(rows, (rows.shape[0], by.size)))
    for last in range(rows.shape[0] - 1, 0, -1):
        for i in range(1, last + 1):
            shifted[i] += by * shifted[i - 1]
    return shifted

r"""The last mode of a response: when all others have decayed to rounding, the rest is known in closed form.

After some dead times a response is :math:`e(t) = \mathrm{Re}\, c\, e^{s (t - t_0)}` with one real pole or one pair s.
It shows in three dead times of the response, as :math:`e_j = p e_{j-1} + q e_{j-2}`: p and q say where s is, Newton's
method on the characteristic function makes it exact, and the fit of c over the last two dead times proves it, because
the output over two dead times is the whole state of the loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.loop_columns import LoopColumns, Places

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Flags = NDArray[np.bool_]

SUSPECTED = 2e-11  # residual of the recurrence, of the largest deviation, with which a pole is looked for
PROVEN = 1e-12  # residual of the fit with which it is the last one
ROUNDING = 1e-15  # of the largest deviation: what a dead time may add to a slow mode


@dataclass
class LastModes:
    """For each loop the pole, the coefficient and the time from which on the rest is this mode alone.

    Attributes
    ----------
    found
        Whether there is one.
    pole, coefficient : array, shape (n,)
        s and c; a real pole has a real coefficient.
    start : array, shape (n,)
        The time t_0.
    error : array, shape (n,)
        How far c may be wrong.
    """

    found: Flags
    pole: ComplexArray
    coefficient: ComplexArray
    start: Array
    error: Array

    @classmethod
    def none(cls, count: int) -> LastModes:
        """Return the record of loops without one."""
        return cls(
            np.zeros(count, dtype=bool), np.full(count, -1.0 + 0.0j), np.zeros(count, dtype=complex), np.zeros(count),
            np.zeros(count),
        )  # fmt: skip

    def put(self, places: Places, modes: LastModes, start: float) -> None:
        """Enter those that were found."""
        at = places[modes.found]
        self.found[at], self.start[at] = True, start
        self.pole[at], self.coefficient[at] = modes.pole[modes.found], modes.coefficient[modes.found]
        self.error[at] = modes.error[modes.found]

    def integral(self) -> Array:
        """Return the integrals of the modes from their start on."""
        return np.asarray(np.real(-self.coefficient / self.pole))

    def absolute_integral(self) -> Array:
        """Return the integrals of the absolute values."""
        pole, c = self.pole, self.coefficient
        real = np.abs(c / pole)
        frequency = np.where(pole.imag > 0.0, pole.imag, 1.0)
        # the next zero, where the phase arg c + w t is an odd multiple of a right angle
        turn = np.mod(0.5 * np.pi - np.angle(c), np.pi)
        first = c * np.exp(pole * (turn / frequency))
        before = np.abs(np.real((first - c) / pole))
        decay = np.exp(pole * (np.pi / frequency))
        after = np.abs(np.real(first * (decay - 1.0) / pole))
        return np.where(pole.imag > 0.0, before + after / (1.0 - np.abs(decay)), real)

    def square_integral(self) -> Array:
        """Return the integrals of the squares."""
        c, pole = self.coefficient, self.pole
        mean = np.abs(c) ** 2 / (-4.0 * pole.real)
        return np.where(pole.imag > 0.0, mean - np.real(c**2 / (4.0 * pole)), 2.0 * mean)

    def square_moment(self) -> Array:
        """Return the integrals of the squares, weighted with the time."""
        c, pole, start = self.coefficient, self.pole, self.start

        mean, twice = np.abs(c) ** 2 * (1.0 / (2.0 * pole.real) - start) / (2.0 * pole.real), 2.0 * pole
        turning = np.real(c**2 * (1.0 / twice - start) / twice)
        return np.asarray(np.where(pole.imag > 0.0, 0.5 * mean + 0.5 * turning, mean))

    def absolute_moment(self) -> Array:
        """Return the integrals of the absolute values, weighted with the time."""
        pole, c, start = self.pole, self.coefficient, self.start
        real = np.abs(c * (1.0 / pole**2 - start / pole))
        frequency = np.where(pole.imag > 0.0, pole.imag, 1.0)
        wait, half = np.mod(0.5 * np.pi - np.angle(c), np.pi) / frequency, np.pi / frequency
        first, decay = c * np.exp(pole * wait), np.exp(pole * half)
        # up to the first zero, then half-waves, each a fixed fraction of the one before
        before = np.abs(np.real(first * ((start + wait) / pole - 1.0 / pole**2) - c * (start / pole - 1.0 / pole**2)))
        area = np.abs(np.real(first * (decay - 1.0) / pole))
        own = np.abs(np.real(first * (decay * (half / pole - 1.0 / pole**2) + 1.0 / pole**2)))
        left = 1.0 - np.abs(decay)
        after = ((start + wait) * area + own) / left + half * area * np.abs(decay) / left**2
        return np.where(pole.imag > 0.0, before + after, real)

    def absolute_change(self) -> Array:
        """Return the integrals of the absolute values of the derivatives."""
        return replace(self, coefficient=self.coefficient * self.pole).absolute_integral()

    def times(self, factor: NDArray[Any]) -> LastModes:
        """Return the modes of signals that are these, multiplied by a transfer function's values at the poles."""
        return replace(self, coefficient=np.where(self.found, self.coefficient * factor, 0.0))

    def first_at(self, level: Array) -> Array:
        """Return when real modes that approach zero from below a level reach it; ``nan`` for the others."""
        with np.errstate(all="ignore"):
            later = np.log(self.coefficient.real / level) / -self.pole.real
        reaches = self.found & (self.pole.imag == 0.0) & (self.coefficient.real < level) & (level < 0.0)
        return np.where(reaches, self.start + later, np.nan)

    def last_outside(self, width: Array) -> Array:
        """Return the last times at which real modes exceed a width; the start for the others."""
        with np.errstate(all="ignore"):
            later = np.log(np.abs(self.coefficient) / width) / -self.pole.real
        return self.start + np.where((self.pole.imag == 0.0) & (later > 0.0), later, 0.0)


def last_modes(
    loops: LoopColumns, recent: Sequence[Array], elapsed: float, size: Array, band: Array, high: Array
) -> LastModes:
    """Return the last modes of loops where there is one.

    Parameters
    ----------
    recent
        Deviations at the nodes of the pieces of the last three dead times, each of shape (points, n).
    elapsed
        Dead times since the step.
    size
        The largest deviation so far.
    band, high
        What an oscillation must not exceed any more: the settling band, and the highest deviation so far.
    """
    found, splits = LastModes.none(len(loops)), len(recent) // 3
    if splits == 0 or len(loops) == 0:
        return found
    start, oscillates = _starts(recent, splits, size)
    # an oscillation that is still outside the band will be looked at again
    chosen = np.nonzero(np.isfinite(start) & ~(oscillates & (np.abs(recent[-1][-1]) > band)))[0]
    if chosen.size == 0:
        return found
    # every second node is plenty: what is left of other modes is smooth
    middle, newest = (
        np.concatenate([values[::2, chosen] for values in recent[i * splits : (i + 1) * splits]]) for i in (1, 2)
    )
    inside = 0.5 * (chebyshev.nodes(DEGREE)[::2] + 1.0)
    nodes = np.concatenate([(i + inside) / splits for i in range(splits)])
    s, oscillates, part = start[chosen], oscillates[chosen], loops.take(chosen)
    with np.errstate(all="ignore"):
        for _ in range(3):
            s = s - part.newton_step(s)
        s = np.where(oscillates, s, s.real)
        c, residual, spread = _fit(s, nodes, middle, newest, oscillates)
        envelope = np.abs(c)
        proven = (residual <= PROVEN * size[chosen]) & (s.real < 0.0)
        over = oscillates & ((envelope > 0.99 * band[chosen]) | (envelope > high[chosen]))
        proven &= ~over & (~oscillates | (s.imag > 0.0))
    at = chosen[proven]
    found.found[at], found.pole[at], found.coefficient[at] = True, s[proven], c[proven]
    found.error[at] = (residual * spread)[proven] + ROUNDING * elapsed * size[at]
    return found


def _starts(recent: Sequence[Array], splits: int, size: Array) -> tuple[ComplexArray, Flags]:
    """Return approximate poles, ``nan`` where no last mode is in sight, and whether each is one of a pair.

    The recurrence is solved at two nodes of a dead time and must hold at two others; the fit will look at more.
    """
    one, two, *others = (
        [recent[i * splits + piece][node] for i in range(3)]
        for piece, node in (divmod(row, DEGREE + 1) for row in np.linspace(0, splits * (DEGREE + 1) - 1, 4).astype(int))
    )
    limit = SUSPECTED * size
    with np.errstate(all="ignore"):
        ratio = one[2] / one[1]
        lone = (ratio > 0.0) & (ratio < 1.0)
        for _, middle, newest in (two, *others):
            lone &= np.abs(newest - ratio * middle) <= limit
        determinant = one[1] * two[0] - two[1] * one[0]
        half = 0.5 * (one[2] * two[0] - two[2] * one[0]) / determinant
        q = (one[1] * two[2] - two[1] * one[2]) / determinant
        turned = -q - half * half
        pair = ~lone & (turned > 0.0)
        for oldest, middle, newest in others:
            pair &= np.abs(newest - 2.0 * half * middle - q * oldest) <= limit
        start = np.full(size.size, complex(np.nan))
        start[lone] = np.log(ratio[lone])
        start[pair] = np.log(half[pair] + 1j * np.sqrt(turned[pair]))
    return start, pair


def _fit(
    s: ComplexArray, nodes: Array, middle: Array, newest: Array, oscillates: Flags
) -> tuple[ComplexArray, Array, Array]:
    """Return the coefficients at the end of the newest dead time, and the largest residual over the last two.

    The third array says how far off a coefficient may be for residuals of size one: far if a dead time sees but a small
    part of an oscillation, which other modes pass for up to the square of that part.
    """
    mode = np.exp(np.outer(nodes - 1.0, s))
    cosine, sine = mode.real, -mode.imag
    cc, cs, ss = _dot(cosine, cosine), _dot(cosine, sine), _dot(sine, sine)
    ce, se = _dot(cosine, newest), _dot(sine, newest)
    determinant = cc * ss - cs**2
    a = np.where(oscillates, (ss * ce - cs * se) / determinant, ce / cc)
    b = np.where(oscillates, (cc * se - cs * ce) / determinant, 0.0)
    c = a + 1j * b
    residual = np.max(np.abs(newest - a * cosine - b * sine), axis=0)
    earlier = c * np.exp(-s)
    before = np.max(np.abs(middle - earlier.real * cosine - earlier.imag * sine), axis=0)
    spread = np.where(oscillates, nodes.size * (cc + ss) / determinant, np.sqrt(nodes.size / cc))
    return c, np.maximum(residual, before), spread


def _dot(left: Array, right: Array) -> Array:
    return np.asarray(np.einsum("pk,pk->k", left, right))

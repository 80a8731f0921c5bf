r"""The end of a response, when all but its slow modes has died away: their exponentials, passed over exactly.

A loop whose integral action is weak, or whose plant is slow, has modes that last a million times longer than others. A
march through time would need pieces without end, each with its rounding errors. Once the fast modes have decayed,
what output and control signal deviate from rest is a sum of exponentials: for steps r of the set-point and d of the
load, the residues of

.. math:: \frac{y_\infty}{s} - Y(s) = \frac{y_\infty (1 + C M) + G (y_\infty C - C_r r - (1 + C M) d)}{s (1 + L)} ,

.. math:: \frac{u_\infty}{s} - U(s) = \frac{u_\infty (1 + L) - C_r r + C G d}{s (1 + L)}, \qquad L = C (G + M),

at their poles; M is what a predictor adds to the measurement. The march up to there says whether that is all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from replicate.loops.controller import PID
from replicate.loops.numerics import chebyshev
from replicate.loops.plant import Plant
from replicate.loops.time_domain.piece_flow import too_many_pieces
from replicate.loops.time_domain.piecewise import Piecewise

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
System = tuple[Plant, Plant | None, PID]
Pieces = tuple[Array, Array, Array]  # breaks, and the Chebyshev coefficients of output and control signal

SETTLED = 34.0  # time constants of a mode until it has decayed to rounding, exp(-34) = 2e-15
GAP = 10.0  # least ratio of the rates of fast and slow modes: with less, a march takes few pieces more
MOST_PIECES = 400_000  # of these modes
REACH = 4.0  # length of a piece, in units of one over the largest modulus of a mode that is left
CIRCLE_RADIUS, CIRCLE_POINTS = 0.3, 32  # of the distance of the nearest pole; the rule's error is 0.3^32
CLOSE = 0.5  # deviation from rest, relative to it, that is small
LONGER, COMPARED = 1.25, 9  # how far the march goes on beyond, and the number of times at which both are compared
AGREE = 1e-12  # of the largest value: difference of the two that is rounding


def slow_groups(poles: ComplexArray, fastest: float) -> Iterator[tuple[ComplexArray, float]]:
    """Yield modes that are much slower than all others, and the rate at which the next one decays, the most first.

    Parameters
    ----------
    poles
        The rightmost poles of all that responds, Im >= 0, all of them stable, by descending real part.
    fastest
        A rate of decay that is the slowest of poles that are not among them.
    """
    rates = np.minimum(np.append(-poles.real, np.inf), fastest)
    for gap in np.nonzero(rates[1:-1] > GAP * rates[:-2])[0][::-1]:
        yield poles[: gap + 1], float(rates[gap + 1])


def with_slow_end(
    march: Callable[[float], Pieces],
    end: float,
    modes: ComplexArray,
    alone: float,
    system: System,
    steps: tuple[float, float],
    rest: tuple[float, float],
    unit: float = 1.0,
) -> Pieces | None:
    """Return a response up to ``end``, of which the slow modes alone are left from the time ``alone`` on.

    There is none where that cannot be seen: before the end, with a multiple slow pole, or while the response is still
    far below what these modes will be.

    Parameters
    ----------
    march
        Computes the response up to a time, piece by piece.
    modes
        The slow poles, Im >= 0.
    system
        The plant, what a predictor adds to its output in the measurement (or None), and the controller.
    steps
        Heights of the steps of set-point and load.
    rest
        Output and control signal in the end; ``nan`` where there is none.
    unit
        Of time, in the user's: for messages.

    Raises
    ------
    LoopError
        If the modes need too many pieces: one that hardly decays while it oscillates.
    """
    if alone > end:
        return None
    start = LONGER * alone
    ends = np.array(_breaks(modes, start, end, unit))
    found = march(start)
    breaks, *signals = found
    times = np.linspace(alone, start, COMPARED)
    tails = []
    rest = np.where(np.isfinite(rest), rest, 0.0).tolist()
    for final, residues, pieces in zip(rest, _residues(modes, system, steps, rest), signals, strict=True):
        marched = Piecewise(breaks, pieces)(times)
        left = _SlowEnd(modes, residues, final, start, float(marched[-1]))
        if not np.max(np.abs(left(times) - marched)) <= AGREE * np.max(np.abs(pieces)):
            return None
        tails.append(left.pieces(ends, pieces.shape[1] - 1))
    y, u = (np.concatenate(both) for both in zip(signals, tails, strict=True))
    return np.concatenate([breaks, ends[1:]]), y, u


@dataclass(frozen=True)
class _SlowEnd:
    """What a signal is at rest, and a sum of exponentials; it has a known value at a time.

    Close to rest the deviation from it has all its digits, and not those of a march; far from it, nothing cancels
    relative to the value that the march has reached.
    """

    modes: ComplexArray
    residues: ComplexArray  # of a pair, twice that of the one with Im > 0
    rest: float
    start: float
    value: float

    def __call__(self, times: Array) -> Array:
        return self._level + self._sum(times)

    @cached_property
    def _now(self) -> ComplexArray:
        return np.asarray(self.residues * np.exp(self.modes * self.start))

    @property
    def _is_close(self) -> bool:
        return abs(float(np.sum(self._now).real)) <= CLOSE * abs(self.rest)

    @property
    def _level(self) -> float:
        return self.rest if self._is_close else self.value

    def _sum(self, times: Array) -> Array:
        growth = np.exp if self._is_close else np.expm1
        return np.asarray((growth(self.modes * (times[..., None] - self.start)) @ self._now).real)

    def pieces(self, breaks: Array, degree: int) -> Array:
        """Return the Chebyshev coefficients on each piece."""
        times = breaks[:-1, None] + 0.5 * np.diff(breaks)[:, None] * (chebyshev.nodes(degree) + 1.0)
        series = self._sum(times) @ chebyshev.values_to_coefficients(degree).T
        series[:, 0] += self._level
        return np.asarray(series)


def _residues(
    modes: ComplexArray, system: System, steps: tuple[float, float], rest: tuple[float, float]
) -> tuple[ComplexArray, ComplexArray]:
    """Return the residues of output and control signal, means on circles; of a pair, twice that with Im > 0."""
    others = np.concatenate([modes, modes.conj(), [0.0]])
    distances = np.abs(modes[:, None] - others)
    distances[distances == 0.0] = np.inf
    radius = CIRCLE_RADIUS * np.min(distances, axis=1)
    around = radius[:, None] * np.exp(2j * np.pi * (np.arange(CIRCLE_POINTS) + 0.5) / CIRCLE_POINTS)
    s = modes[:, None] + around
    (plant, model, controller), (setpoint, load), (output, control) = system, steps, rest
    with np.errstate(all="ignore"):
        path, back, drive = plant(s), controller.feedback(s), controller.feedforward(s) * setpoint
        inside = 1.0 + (back * model(s) if model is not None else 0.0)
        around = around / (s * (inside + back * path))
        missing = output * inside + path * (output * back - drive - inside * load)
        more = control * (inside + back * path) - drive + back * path * load
    pairs = np.where(modes.imag > 0.0, 2.0, 1.0)
    return -np.mean(missing * around, axis=1) * pairs, -np.mean(more * around, axis=1) * pairs


def _breaks(modes: ComplexArray, start: float, end: float, unit: float) -> list[float]:
    """Return the ends of pieces on which the modes that are left are polynomials to rounding."""
    ends = [start]
    for mode in modes[np.argsort(modes.real)]:
        stop = min(end, SETTLED / -float(mode.real))
        fastest = float(np.max(np.abs(modes[modes.real >= mode.real])))
        if stop > ends[-1]:
            count = int(np.ceil((stop - ends[-1]) * fastest / REACH))
            if count > MOST_PIECES:
                raise too_many_pieces(MOST_PIECES, end * unit)
            ends += np.linspace(ends[-1], stop, count + 1)[1:].tolist()
    return [*ends, end] if end > ends[-1] else ends

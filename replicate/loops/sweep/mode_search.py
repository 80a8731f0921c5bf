r"""Which modes are left of a response: when all others have decayed to rounding, the rest is known in closed form.

After some dead times a response is a sum of few modes, :math:`e(t) = \sum_i \mathrm{Re}\, c_i e^{s_i t}`. Three poles,
conjugates counted, show in four dead times of the response, which obey :math:`e_j = p e_{j-1} + q e_{j-2} + r e_{j-3}`
(Prony): the roots of :math:`z^3 = p z^2 + q z + r` say where they are, Newton's method on the characteristic function
makes them exact, and c is the residue of the response there. Without dead time the roots of a polynomial say where they
are. From then on it is known when the sum will be simple enough. The last two dead times prove that it is all, because
the output over two dead times is the whole state.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

import numpy as np
from numpy.typing import NDArray

from replicate.loops.numerics import chebyshev
from replicate.loops.sweep.batch_poles import polished, rational_starts
from replicate.loops.sweep.block_series import DEGREE
from replicate.loops.sweep.last_modes import MOST, LastModes
from replicate.loops.sweep.loop_columns import LoopColumns, Places
from replicate.loops.sweep.stability_counts import Characteristic, unstable_poles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Flags = NDArray[np.bool_]

DEAD_TIMES = 4  # of the response that show its modes
EXPLAINED = 1e-3  # residual, of what is seen, with which modes explain it
PROVEN = 1e-12  # residual of their sum, of the largest deviation, with which they are the last ones
PATIENCE = 1.08  # factor to the time at which a loop of which more is left is looked at again
LOOKED_AT = 6  # points of a dead time at which they are compared: what is left of others is smooth
LEAST = 1e-2  # of what is proven: a mode that counts
CLEARLY = 0.9  # share of a real mode that all others together must not exceed
CONVERGED = 1e-8  # last relative step of Newton's method: the next is of its square, and what is left proves it
SLOW, FASTER = 0.01, 1e3  # decay of a mode in a dead time, and a factor to it
SAME = 1e-6  # relative distance of poles that are one


class ModeSearch:
    """The modes of loops, as far as they are known.

    Parameters
    ----------
    loops
        The loops.
    setpoint, load
        Heights of the steps.
    """

    def __init__(self, loops: LoopColumns, setpoint: float, load: float) -> None:
        self.loops, self.setpoint, self.load = loops, setpoint, load
        self.pole = np.full((MOST, len(loops)), -1.0 + 0.0j)  # the slowest first
        self.residue, self.due = np.zeros_like(self.pole), np.zeros(len(loops))
        self.known = np.zeros(len(loops), dtype=bool)

    def take(self, columns: Places) -> ModeSearch:
        """Return what is known of some of the loops."""
        part = copy(self)
        part.loops, part.due, part.known = self.loops.take(columns), self.due[columns], self.known[columns]
        part.pole, part.residue = self.pole.take(columns, axis=1), self.residue.take(columns, axis=1)
        return part

    def look(self, recent: Sequence[Array], elapsed: float, size: Array, *, unit: float, control: bool) -> LastModes:
        """Return the last modes of loops where they are known to be all that is left.

        Parameters
        ----------
        recent
            Deviations at the nodes of the pieces of the last dead times, each of shape (points, n).
        elapsed
            Dead times since the steps.
        size
            The largest deviation so far.
        unit
            Length of what counts as a dead time in ``recent``.
        control
            Whether the control signal must approach its final value steadily, too.
        """
        found, due = LastModes.none(len(self.loops)), self.due <= elapsed
        at, unknown = np.nonzero(due & self.known)[0], np.nonzero(due & ~self.known)[0]
        with np.errstate(all="ignore"):
            if at.size:
                limit, pole = PROVEN * size[at], self.pole[:, at]
                c = self.residue[:, at] * np.exp(pole * elapsed)
                others, amplitude = np.abs(c[1:]).sum(axis=0), np.abs(c[0])
                c[1:, others <= limit] = 0.0
                rest = _rest(recent, at, np.asarray(unit * pole), c)
                self.due[at] = elapsed * np.where(rest <= limit, 1.0, PATIENCE)
                self.known[at] = rest <= EXPLAINED * np.maximum(amplitude, others)
                proven = rest <= limit
                places = at[proven]
                found.found[places], found.error[places], found.beyond[places] = (
                    True,
                    rest[proven],
                    self._beyond(places),
                )
                found.pole[:, places], found.coefficient[:, places] = pole[:, proven], c[:, proven]
            if unknown.size:
                self._search(unknown, recent, elapsed, PROVEN * size, control=control)
        return found

    def _beyond(self, places: Places) -> Array:
        """Return a rate at which all modes decay at least that are not known, of loops whose last modes are found.

        Where the slowest is very slow, what is left may be rounding of the march, but also a mode that lasts as long:
        there is none if the argument principle counts no other pole between it and those that are faster.
        """
        pole = self.pole[:, places]
        beyond = -pole[0].real
        some = np.nonzero(beyond < SLOW)[0]
        if some.size:
            slow, pole = beyond[some], pole[:, some]
            faster = np.where(self.residue[1, places[some]] == 0.0, FASTER * slow, -pole[1].real)
            line = np.maximum(np.sqrt(slow * faster), 0.5 * faster)
            count, doubtful, _ = unstable_poles(Characteristic.of(self.loops.take(places[some])).shifted(-line))
            alone = ~doubtful & (count == np.where(pole[0].imag > 0.0, 2.0, 1.0))
            beyond[some] = np.where(alone, line, slow)
        return np.asarray(beyond)

    def _search(self, places: Places, recent: Sequence[Array], elapsed: float, limit: Array, *, control: bool) -> None:
        """Look for the modes of some loops."""
        start, seen = _starts(recent, places) if self.loops.delay else _rightmost(self.loops.take(places))
        places, start = places[seen], start[:, seen]
        slot, column = np.nonzero(np.isfinite(_distinct(start)))  # a pair needs but one of its two
        found = np.full(start.shape, complex(np.nan))
        found[slot, column] = polished(self.loops.take(places[column]), start[None, slot, column], CONVERGED)[0]
        slot, column = np.nonzero(np.isfinite(_distinct(found)))
        pole = found[slot, column]
        residue = self.loops.take(places[column]).residues(pole, self.setpoint, self.load)
        residue *= np.where(pole.imag > 0.0, 2.0, 1.0)  # a pole and its conjugate
        sizes = np.abs(residue * np.exp(pole * elapsed))
        counts = (sizes > LEAST * limit[places[column]]) & np.isfinite(residue) & (pole.real < 0.0)
        slot, column, pole, residue = slot[counts], column[counts], pole[counts], residue[counts]
        poles, residues = np.full(start.shape, -1.0 + 0.0j), np.zeros(start.shape, dtype=complex)
        poles[slot, column], residues[slot, column] = pole, residue
        order = np.argsort(np.where(residues == 0.0, np.inf, -poles.real), axis=0)
        poles, residues = np.take_along_axis(poles, order, axis=0), np.take_along_axis(residues, order, axis=0)
        self.pole[:, places], self.residue[:, places], self.known[places] = poles, residues, True
        now = residues * np.exp(poles * elapsed)
        self.due[places] = elapsed + self._wait(places, poles, now, limit[places], control)

    def _wait(self, at: Places, pole: ComplexArray, c: ComplexArray, limit: Array, control: bool) -> Array:
        """Return how long it takes until an oscillation is alone, or a real mode leads."""
        rate, size = -pole.real, np.abs(c)
        alone = np.max(np.log(size[1:] / limit) / rate[1:], axis=0)
        against = np.maximum(size, np.abs(c * pole / pole[0]))  # of the signals themselves and of their slopes
        if control:
            passed = np.abs(c * pole * self.loops.take(at).feedback(pole))
            against = np.maximum(against, passed * (size[0] / passed[0]))
        leads = np.log((MOST - 1) / CLEARLY * against[1:] / size[0]) / (rate[1:] - rate[0])
        leads = np.max(np.where(size[1:] == 0.0, -np.inf, leads), axis=0)
        return np.asarray(np.where(pole[0].imag > 0.0, alone, np.minimum(leads, alone)))


def _rightmost(loops: LoopColumns) -> tuple[ComplexArray, Flags]:
    """Return the rightmost poles of loops without dead time as `_starts` does: the roots of their polynomials."""
    found = np.full((MOST, len(loops)), complex(np.nan))
    starts = rational_starts(loops)
    found[: starts.shape[0]] = starts
    return found, np.ones(len(loops), dtype=bool)


def _distinct(pole: ComplexArray) -> ComplexArray:
    """Return the poles without those that are there already."""
    pole = pole.copy()
    for i in range(1, MOST):
        pole[i, np.any(np.abs(pole[i] - pole[:i]) <= SAME * np.abs(pole[i]), axis=0)] = np.nan
    return pole


def _rest(recent: Sequence[Array], at: Places, pole: ComplexArray, c: ComplexArray) -> Array:
    """Return by how much the last two dead times of some loops deviate from the sum of their modes."""
    splits, nodes = len(recent) // DEAD_TIMES, 0.5 * (chebyshev.nodes(DEGREE) + 1.0)
    slot, column = np.nonzero(c)
    pole, c = pole[slot, column], c[slot, column]
    worst, back = np.zeros(at.size), np.exp(-pole)
    for piece, node in _looked_at(splits, LOOKED_AT):
        modes = c * np.exp(pole * ((piece + nodes[node]) / splits - 1.0))
        for dead_time in (DEAD_TIMES - 1, DEAD_TIMES - 2):
            rest = recent[dead_time * splits + piece][node][at]
            rest -= np.bincount(column, weights=modes.real, minlength=at.size)
            np.maximum(worst, np.abs(rest), out=worst)
            modes *= back
    return worst


def _looked_at(splits: int, count: int) -> list[tuple[int, int]]:
    """Return some points of a dead time: pieces, and nodes in them."""
    rows = np.linspace(0, splits * (DEGREE + 1) - 1, count).astype(int)
    return [divmod(int(row), DEGREE + 1) for row in rows]


def _starts(recent: Sequence[Array], places: Places) -> tuple[ComplexArray, Flags]:
    """Return approximate poles of some loops, shape (MOST, places), and where they explain what is seen.

    The recurrence is solved at three points of a dead time and should hold at two others.
    """
    splits = len(recent) // DEAD_TIMES
    seen = [
        [recent[i * splits + piece][node][places] for i in range(DEAD_TIMES)]
        for piece, node in _looked_at(splits, MOST + 2)
    ]
    with np.errstate(all="ignore"):
        p = _solved([seen[i] for i in (0, 2, 4)])
        explained = np.ones(places.size, dtype=bool)
        for e in (seen[1], seen[3]):
            rest = e[3] - p[0] * e[2] - p[1] * e[1] - p[2] * e[0]
            explained &= np.abs(rest) <= EXPLAINED * np.abs(e).max(axis=0)
        s = np.log(_cubic_roots(p))
    return s.real + 1j * np.abs(s.imag), explained


def _solved(seen: list[list[Array]]) -> Array:
    """Return p, q and r of the recurrence from three sequences of four values, by Cramer's rule."""
    oldest, older, newer, newest = ([values[i] for values in seen] for i in range(4))
    determinant = _determinant(newer, older, oldest)
    top = (newest, older, oldest), (newer, newest, oldest), (newer, older, newest)
    return np.stack([_determinant(*columns) / determinant for columns in top])


def _determinant(a: Sequence[Array], b: Sequence[Array], c: Sequence[Array]) -> Array:
    minors = b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]
    return a[0] * minors[0] + a[1] * minors[1] + a[2] * minors[2]


def _cubic_roots(p: Array) -> ComplexArray:
    """Return the roots of z^3 = p_0 z^2 + p_1 z + p_2, shape (3, n), by Cardano's formula."""
    third = p[0] / 3.0
    q, r = third**2 + p[1] / 3.0, -(third**3) - 0.5 * third * p[1] - 0.5 * p[2]
    root = np.sqrt((r * r - q**3).astype(complex))
    one = (r + np.where(r < 0.0, -root, root)) ** (1.0 / 3.0)
    turned = one * np.exp(2j * np.pi / 3.0 * np.arange(MOST))[:, None]
    return np.asarray(third - turned - q / turned)

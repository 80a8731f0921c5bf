r"""The Nyquist curves of many loops on one grid of frequencies, and the places worth a closer look.

At a frequency L is linear in the coefficients of the controller's numerator, so that all curves are one matrix product.
The grid resolves the plant's corners and resonances and the turns of the dead time; that L has no narrower features
than these makes it enough for every controller. A peak of S is narrow only because L passes close to -1, steadily.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from replicate.loops.sweep.loop_columns import LoopColumns

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PER_DECADE = 40
TURN = np.pi / 16.0  # of the dead time between neighbouring frequencies
MOST_FREQUENCIES = 1500
LOWEST = 1e-3  # the grid begins this far below the lowest corner
AHEAD = 4.0 * np.pi  # beyond the last gain crossover: one turn of the dead time and more
RESONANT = 0.3  # damping below which the grid is denser around a pole or zero


@dataclass(frozen=True)
class Scan:
    """L(i w) of many loops, real and imaginary part, shape (frequencies, n).

    Attributes
    ----------
    w
        The frequencies, ascending.
    real, imag
        The curves.
    beyond
        A bound on |L| beyond the grid, shape (n,).
    """

    w: Array
    real: Array
    imag: Array
    beyond: Array


def scan(loops: LoopColumns, crossovers: Array) -> Scan:
    """Return the curves of loops with the given gain crossovers (`replicate.loops.sweep.stability_counts`)."""
    last = np.where(np.isfinite(crossovers), crossovers, 0.0).max(axis=0, initial=0.0)
    shared = np.concatenate([loops.zeros, loops.poles])
    corners = np.abs(shared[shared != 0.0])
    own = _own_corners(loops)
    high = max(float(np.max(last)), 2.0 * float(np.max(corners, initial=0.0)), 1.0) + AHEAD
    lowest = np.min(own, initial=np.inf, where=own > 0.0)
    low = LOWEST * min(1.0, float(np.min(corners, initial=1.0)), float(lowest))
    if high / TURN > MOST_FREQUENCIES:
        high = TURN * MOST_FREQUENCIES
    w = _grid(low, high, shared)
    q = np.polyval(loops.shared_num, 1j * w) / np.polyval(loops.den, 1j * w) * np.exp(-1j * loops.delay * w)
    powers = [q * (1j * w) ** n for n in range(loops.controller_zeros.shape[0])]
    matrix = np.stack(powers[::-1], axis=1)
    coefficients = loops.controller_zeros
    # beyond twice its corners every term falls, or rises to its limit
    limits = np.zeros(matrix.shape[1])
    if matrix.shape[1] + loops.shared_num.size - 1 >= loops.den.size:
        limits[0] = abs(loops.shared_num[0] / loops.den[0])
    beyond = _largest(np.maximum(np.abs(matrix[-1]), limits)[:, None] * coefficients)
    if high < 2.0 * np.max(corners, initial=0.0) + AHEAD:
        beyond = np.full(len(loops), np.inf)
    return Scan(w, matrix.real @ coefficients, matrix.imag @ coefficients, beyond)


def _largest(terms: Array) -> Array:
    """Return a bound on the sum of terms turned by right angles, the last one by none, that may each be smaller."""
    even, odd = terms[::-2], terms[-2::-2]
    size = np.abs(odd).sum(axis=0)
    # every second term is turned by half a turn: of equal sign they work against each other
    same = even.shape[0] < 2 or (even[0] * even[-1] >= 0.0)
    against = np.where(same, np.abs(even).max(axis=0), np.abs(even).sum(axis=0))
    return np.asarray(np.hypot(size, against))


def _own_corners(loops: LoopColumns) -> Array:
    """Return frequencies at which the controllers' numerators bend, shape (some, n)."""
    rows = np.abs(loops.controller_zeros)
    with np.errstate(all="ignore"):
        ratios = [rows[i + 1] / rows[i] for i in range(rows.shape[0] - 1)]
        if rows.shape[0] == 3:
            ratios.append(np.sqrt(rows[2] / rows[0]))
    return np.where(np.isfinite(ratios), ratios, 0.0) if ratios else np.zeros((0, len(loops)))


def _grid(low: float, high: float, roots: ComplexArray) -> Array:
    parts = [
        np.geomspace(low, high, max(2, int(PER_DECADE * np.log10(high / low)))),
        np.arange(TURN, high, TURN),
    ]
    for root in roots[(roots.imag > 0.0) & (np.abs(roots.real) < RESONANT * np.abs(roots))]:
        width = max(abs(root.real), 1e-9 * abs(root))
        spread = np.geomspace(0.1, 30.0, 16)
        parts += [root.imag + width * np.concatenate([-spread, [0.0], spread])]
    w = np.unique(np.concatenate(parts))
    return w[(w >= low) & (w <= high)]

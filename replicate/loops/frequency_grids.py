"""Grids of frequencies: dense at every corner, around every resonance, and within every turn of a dead time."""

from __future__ import annotations

from functools import cache
from math import log10

import numpy as np
from numpy.typing import NDArray

from replicate.loops.loop_transfer import LoopTransfer
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MOST_POINTS = 40_000  # on the turns of the dead time from rest on, 20 for each
POINTS_AROUND = 200
LARGEST_LAG = 4.0 * np.pi


def loop_grid(transfer: LoopTransfer, end: float, *, per_decade: int = 60) -> Array:
    """Return frequencies that resolve every corner, resonance and dead-time rotation of L up to ``end``."""
    corners = transfer.corner_frequencies
    slow = [end, *np.abs(corners).tolist()]
    longest = transfer.longest_dead_time
    if longest:
        slow.append(1.0 / longest)
    start = 1e-4 * min(slow)
    if not transfer.plant.parts:
        start = min(start, 1e-8 * end, 1e-4 * transfer.plant.corners[0])
    parts = [_logarithmic(start, end, per_decade)]
    if longest:
        step = np.pi / (10.0 * longest)
        turns = np.arange(1.0, min(end / step, MOST_POINTS)) * step
        parts.append(turns)
        if end > step * MOST_POINTS:
            # beyond, the dead time turns L through all phases before |L| changes: what matters is where |L| is largest
            parts += [w + step * np.arange(-POINTS_AROUND, POINTS_AROUND) for w in transfer.gain_stationary if w < end]
    spread = _two_sided(30.0, 0.1, 12)
    parts += _around(_resonant(corners), spread, narrowest=1e-12)
    w = np.unique(np.concatenate(parts))
    return w[(w > 0.0) & (w <= end)]


def peak_grid(transfer: LoopTransfer, end: float, poles: ComplexArray, start: float = 0.0) -> Array:
    """Return frequencies from ``start`` to ``end`` that also resolve the peaks which closed-loop poles make."""
    w = loop_grid(transfer, end, per_decade=80)
    near = _around(poles[poles.imag > 0.0], _two_sided(10.0, 0.03, 12), narrowest=0.0)
    w = np.unique(np.concatenate([w, *near, [start, end]]))  # both ends, so that bands that overlap leave no gap
    return w[(w > 0.0) & (w >= start) & (w <= end)]


def wide_grid(transfer: LoopTransfer, end: float, poles: ComplexArray, decades: int) -> Array:
    """Return frequencies as for a peak, and ``decades`` more beyond the loop's corners on both sides."""
    near = _around(poles[poles.imag > 0.0], np.linspace(-3.0, 3.0, 25), narrowest=0.0)
    w = np.unique(np.concatenate([loop_grid(transfer, end, per_decade=80), *near]))
    w = w[w > 0.0]
    below = np.geomspace(w[0] * 10.0**-decades, w[0], 20 * decades)[:-1]
    above = np.geomspace(w[-1], w[-1] * 10.0**decades, 80 * decades)[1:]
    return np.concatenate([below, w, above])


def plants_grid(first: Plant, second: Plant, decades: int) -> Array:
    """Return frequencies that resolve the corners and resonances of two plants and the turns of their dead times."""
    corners = np.concatenate([part for plant in (first, second) for part in (plant.poles(), plant.zeros())])
    corners = corners[np.abs(corners) > 0.0]
    delays = [plant.dead_time for plant in (first, second) if plant.dead_time]
    moduli = [*np.abs(corners).tolist(), *(1.0 / delay for delay in delays)] or [1.0]
    low, high = min(moduli) * 10.0**-decades, max(moduli) * 10.0**decades
    parts = [_logarithmic(low, high, 200)]
    if delays:
        parts.append(np.asarray(np.arange(1, 5000) * (2.0 * np.pi / max(delays)) / 60.0, dtype=float))
    parts += _around(corners[corners.imag > np.abs(corners.real)], np.linspace(-5.0, 5.0, 41), narrowest=1e-9)
    w = np.unique(np.concatenate(parts))
    return np.asarray(w[(w >= low) & (w <= high)])


def design_grid(plant: Plant) -> Array:
    """Return the frequencies on which a design looks for its optimum, before polishing."""
    corners = np.array(plant.corners)
    longest = max((part.dead_time for part in plant.parts), default=plant.dead_time)
    if longest:
        corners = np.append(corners, 1.0 / longest)
    low, high = 2e-3 * corners.min(), 1e3 * corners.max()
    parts = [_logarithmic(low, high, 70)]
    if longest:
        step = np.pi / (24.0 * longest)
        parts.append(np.asarray(np.arange(1, 24 * 12) * step, dtype=float))
    parts += _around(plant.resonances, _two_sided(20.0, 0.1, 10), narrowest=1e-9)
    grid = np.unique(np.concatenate(parts))
    grid = grid[grid > 0.0]
    # two turns of the plant's own phase are more than a PI controller can make use of
    phase = np.unwrap(np.angle(plant(1j * grid)))
    beyond = np.nonzero(phase < phase[0] - LARGEST_LAG)[0]
    return grid[: beyond[0]] if beyond.size else grid


def _logarithmic(start: float, end: float, per_decade: int) -> Array:
    decades = log10(end / start)
    w: Array = start * 10.0 ** np.linspace(0.0, decades, max(2, int(per_decade * decades)))
    w[-1] = end
    return w


@cache
def _two_sided(widest: float, narrowest: float, count: int) -> Array:
    """Return offsets that are dense at zero, in units of a resonance's half-width."""
    offsets = np.geomspace(narrowest, widest, count)
    return np.concatenate([-offsets[::-1], [0.0], offsets])


def _resonant(roots: ComplexArray) -> ComplexArray:
    return np.asarray(roots[(np.abs(roots.real) < 0.3 * np.abs(roots)) & (roots.imag > 0.0)])


def _around(roots: ComplexArray, spread: Array, *, narrowest: float) -> list[Array]:
    """Return frequencies around the imaginary parts of roots; ``narrowest`` is the least half-width, relative.

    A root that is narrower lies on the axis to rounding, where the gain may have no value.
    """
    parts = []
    for root in roots:
        width = max(abs(root.real), narrowest * abs(root))
        parts.append(root.imag + width * (spread if abs(root.real) == width else spread[spread != 0.0]))
    return parts

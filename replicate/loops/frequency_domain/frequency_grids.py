"""Grids of frequencies: dense at every corner, around every resonance, and within every turn of a dead time."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import log10

import numpy as np
from numpy.typing import NDArray

from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.plant import Plant

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MOST_POINTS = 40_000  # on the turns of the dead time from rest on, 20 for each
POINTS_AROUND = 200
LARGEST_LAG = 4.0 * np.pi
SLOWEST = 1e-4  # where a grid begins, of the lowest corner,
SLOWEST_OF_FUNCTION = 1e-8  # and of its end for a function, which may go on bending towards rest
DESIGN_BAND = 2e-3, 1e3  # frequencies of interest to a design, of the lowest and the highest corner
PER_TURN, PER_TURN_OF_GAP, PER_TURN_OF_DESIGN = 20, 60, 48  # of the dead time
MOST_TURNS_OF_GAP, MOST_TURNS_OF_DESIGN = 83, 6
AROUND_CORNER = 30.0, 0.1, 12  # widest and least offset, in half-widths of a resonance, and their number on each side,
AROUND_POLE = 10.0, 0.03, 12  # around a peak that a closed-loop pole makes,
AROUND_FUNCTION = 20.0, 0.1, 10  # and around a function's pole
NARROWEST, NARROWEST_OF_PLANTS = 1e-12, 1e-9  # least half-width of a resonance, relative to its frequency
MOST_BANDS, WIDER = 40, 1.5  # beyond the band of a loop, and the ratio of the ends of each
RESONANT = 0.3  # largest damping of one


def loop_grid(transfer: LoopTransfer, end: float, *, per_decade: int = 60) -> Array:
    """Return frequencies that resolve every corner, resonance and dead-time rotation of L up to ``end``."""
    w = np.unique(np.concatenate(_resolving(transfer, end, per_decade)))
    return w[(w > 0.0) & (w <= end)]


def _resolving(transfer: LoopTransfer, end: float, per_decade: int) -> list[Array]:
    corners = transfer.corner_frequencies
    slow = [end, *np.abs(corners).tolist()]
    longest = transfer.longest_dead_time
    if longest:
        slow.append(1.0 / longest)
    start = SLOWEST * min(slow)
    if not transfer.plant.parts:
        start = min(start, SLOWEST_OF_FUNCTION * end, SLOWEST * transfer.plant.corners[0])
    parts = [_logarithmic(start, end, per_decade)]
    if longest:
        step = 2.0 * np.pi / (PER_TURN * longest)
        turns = np.arange(1.0, min(end / step, MOST_POINTS)) * step
        parts.append(turns)
        if end > step * MOST_POINTS:
            # beyond, the dead time turns L through all phases before |L| changes: what matters is where |L| is largest
            parts += [w + step * np.arange(-POINTS_AROUND, POINTS_AROUND) for w in transfer.gain_stationary if w < end]
    return parts + _around(_resonant(corners), _two_sided(*AROUND_CORNER), narrowest=NARROWEST)


def peak_grid(transfer: LoopTransfer, end: float, poles: ComplexArray, start: float = 0.0) -> Array:
    """Return frequencies from ``start`` to ``end`` that also resolve the peaks which closed-loop poles make."""
    near = _around(poles[poles.imag > 0.0], _two_sided(*AROUND_POLE), narrowest=0.0)
    # both ends, so that bands that overlap leave no gap
    w = np.unique(np.concatenate([*_resolving(transfer, end, 80), *near, [start, end]]))
    return w[(w > 0.0) & (w >= start) & (w <= end)]


def bands_beyond(transfer: LoopTransfer, end: float) -> Iterator[tuple[float, float]]:
    """Yield band after band beyond a frequency, as long as a grid resolves the turns of the dead time."""
    last = 2.0 * np.pi * MOST_POINTS / (PER_TURN * transfer.longest_dead_time) if transfer.longest_dead_time else np.inf
    for _ in range(MOST_BANDS):
        if end > last:
            return
        yield end, WIDER * end
        end *= WIDER


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
        step = 2.0 * np.pi / (PER_TURN_OF_GAP * max(delays))
        parts.append(np.arange(1.0, PER_TURN_OF_GAP * MOST_TURNS_OF_GAP) * step)
    parts += _around(
        corners[corners.imag > np.abs(corners.real)], np.linspace(-5.0, 5.0, 41), narrowest=NARROWEST_OF_PLANTS
    )
    w = np.unique(np.concatenate(parts))
    return np.asarray(w[(w >= low) & (w <= high)])


def design_grid(plant: Plant) -> Array:
    """Return the frequencies on which a design looks for its optimum, before polishing."""
    corners = np.array(plant.corners)
    longest = max((part.dead_time for part in plant.parts), default=plant.dead_time)
    if longest:
        corners = np.append(corners, 1.0 / longest)
    low, high = DESIGN_BAND[0] * corners.min(), DESIGN_BAND[1] * corners.max()
    parts = [_logarithmic(low, high, 70)]
    if longest:
        step = 2.0 * np.pi / (PER_TURN_OF_DESIGN * longest)
        parts.append(np.arange(1.0, PER_TURN_OF_DESIGN * MOST_TURNS_OF_DESIGN) * step)
    parts += _around(plant.resonances, _two_sided(*AROUND_FUNCTION), narrowest=NARROWEST_OF_PLANTS)
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
    return np.asarray(roots[(np.abs(roots.real) < RESONANT * np.abs(roots)) & (roots.imag > 0.0)])


def _around(roots: ComplexArray, spread: Array, *, narrowest: float) -> list[Array]:
    """Return frequencies around the imaginary parts of roots; ``narrowest`` is the least half-width, relative.

    A root that is narrower lies on the axis to rounding, where the gain may have no value.
    """
    parts = []
    for root in roots:
        width = max(abs(root.real), narrowest * abs(root))
        parts.append(root.imag + width * (spread if abs(root.real) == width else spread[spread != 0.0]))
    return parts

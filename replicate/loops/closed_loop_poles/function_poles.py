r"""Closed-loop poles of loops around functions: where to look for them, and what of the negative real axis is a cut.

Poles far from the imaginary axis are local minima of \|1 + 1/L\| on a polar grid; narrow ones, close to it, are the
resonances of the sensitivity; real ones are changes of sign. The argument principle counts those in the right
half-plane, where the function is analytic, and finds the ones that are missing there. To the left the function may have
poles of its own, which no contour tells from zeros: a stable pole that is closer to a zero of the loop than the grid is
fine, and far from the axis, may be missed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from replicate.loops.closed_loop_poles.pole_starts import asymptotic_starts
from replicate.loops.closed_loop_poles.zero_search import Box, newton, zeros_in_box
from replicate.loops.frequency_domain import stability
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics.bracketed import bracketed_root
from replicate.loops.plants.cut import has_cut
from replicate.loops.plants.function_resonances import resonances

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

PER_DECADE, ANGLES = 36, 60  # of the grid
LEFTMOST = 0.98 * np.pi  # rad: beyond, poles are looked for on the axis
AXIS_PER_DECADE = 40
MOST_MINIMA = 200  # of the grid that are followed, the lowest first
SLOWEST = 1e-2  # radius at which the grid begins, in units of the lowest frequency with |L| = 1 or a corner,
SLOWEST_REAL = 1e-6  # and where the search on the negative real axis begins
SMALL = 0.3  # a loop gain that is far from -1
FASTEST = 10.0  # radius at which both end, in units of the last corner or the frequency beyond which |L| is small,
LARGEST_GROWTH = 300.0  # and on the axis also the logarithm of exp(-s dead_time)
REAL = 1e-6  # imaginary part, relative to the modulus, of a value that is real
DIFFERENCE, DIRECTIONS = 1e-2, 8  # radius of a difference, relative to |s|, and its points
OFF_AXES = 1e-6  # distance from the axes, relative to its size, of the box in which unstable pairs are counted


def function_starts(transfer: LoopTransfer, count: int) -> ComplexArray:
    """Return starts, Im >= 0, for a plant given by a function."""
    lowest, highest = transfer.plant.corners
    end = max(transfer.beyond(SMALL), highest)  # what is hardly fed back has poles near the function's own
    low = min([end, lowest, *np.abs(transfer.corner_frequencies).tolist(), *transfer.gain_crossovers.tolist()])
    farthest = max(FASTEST * end, LARGEST_GROWTH / transfer.dead_time if transfer.dead_time else 0.0)
    with np.errstate(all="ignore"):
        parts = [
            _minima_on_grid(transfer, SLOWEST * low, FASTEST * end),
            resonances(lambda s: 1.0 / (1.0 + transfer(s)), SLOWEST * low, FASTEST * end),
            _starts_on_axis(transfer, _logarithmic(SLOWEST_REAL * low, farthest, AXIS_PER_DECADE)),
        ]
    if transfer.dead_time:
        parts.append(asymptotic_starts(transfer, count))
    return np.concatenate(parts)


def missing_unstable(transfer: LoopTransfer, found: list[complex]) -> ComplexArray:
    """Return the poles with Re s > 0 and Im s > 0 if those among the poles found are not all; else none."""
    if stability.unstable_poles(transfer) == sum(2 if p.imag else 1 for p in found if p.real >= 0.0):
        return np.empty(0, dtype=complex)
    top = FASTEST * transfer.beyond(SMALL)
    box = Box(OFF_AXES * top, top, OFF_AXES * top, top)
    zeros = zeros_in_box(transfer.characteristic, transfer.characteristic_slope, box, turning=transfer.dead_time)
    return np.array([zero.place for zero in zeros or ()], dtype=complex)


def poles_at_controller_zeros(transfer: LoopTransfer) -> ComplexArray:
    """Return poles, Im >= 0, that a zero of the controller keeps near a pole of the function, or hides in it.

    Between the two, or on both, lies a closed-loop pole that neither a grid nor f shows: f has a pole next to it.
    What is analytic there is f/G, the controller's numerator plus its denominator over G.
    """
    num, den, plant = transfer.num, transfer.den, transfer.plant

    def inverse(s: ComplexArray) -> ComplexArray:
        return np.asarray(np.polyval(den, s) / plant(s))

    def excess(s: ComplexArray) -> ComplexArray:
        return np.asarray(np.polyval(num, s) + inverse(s))

    def slope(s: ComplexArray) -> ComplexArray:
        step = DIFFERENCE * np.abs(s)
        turn = np.exp(2j * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
        mean = np.mean(inverse(s[:, None] + step[:, None] * turn) / turn, axis=1) / step
        return np.asarray(np.polyval(np.polyder(num), s) + mean)

    found = [newton(excess, slope, zero) for zero in transfer.zeros.tolist() if zero.imag >= 0.0 and zero]
    poles = np.array([complex(s.real, abs(s.imag)) for s in found if s is not None], dtype=complex)
    real = poles.imag <= REAL * np.abs(poles)
    poles[real] = poles.real[real]
    return np.asarray(poles[~real | ~has_cut(transfer, np.abs(poles))])


def _logarithmic(low: float, high: float, per_decade: int) -> Array:
    return np.geomspace(low, high, max(8, int(per_decade * np.log10(high / low))))


def _minima_on_grid(transfer: LoopTransfer, low: float, high: float) -> ComplexArray:
    """Return the local minima of |1 + 1/L|, which is zero at the poles and free of the scale of L, on a polar grid."""
    s = _logarithmic(low, high, PER_DECADE)[:, None] * np.exp(1j * np.linspace(0.0, LEFTMOST, ANGLES))
    relative = np.abs(1.0 + 1.0 / transfer(s))
    inner = relative[1:-1, :]
    lowest = (inner <= relative[:-2, :]) & (inner <= relative[2:, :])
    padded = np.pad(relative, ((0, 0), (1, 1)), mode="edge")[1:-1]
    lowest &= (inner <= padded[:, :-2]) & (inner <= padded[:, 2:])
    best = np.argsort(inner[lowest])[:MOST_MINIMA]
    return np.asarray(s[1:-1][lowest][best])


def _starts_on_axis(transfer: LoopTransfer, radius: Array) -> ComplexArray:
    """Return starts on the negative real axis, where L is real: sign changes and minima of 1 + 1/L."""

    def excess(x: float) -> float:
        # 1 + 1/L where L is large, and without its poles where L is zero: (1 + L) L / (1 + L^2)
        size = float(complex(transfer(complex(-x))).real)
        if abs(size) > 1.0:
            return (1.0 + 1.0 / size) / (1.0 + 1.0 / size**2)
        return (1.0 + size) * size / (1.0 + size**2)

    smooth = ~has_cut(transfer, radius)
    value = 1.0 + 1.0 / transfer(-radius.astype(complex)).real
    smooth &= np.isfinite(value)
    both = smooth[1:] & smooth[:-1]
    found = [
        bracketed_root(excess, radius[i], radius[i + 1]) for i in np.nonzero(both & (value[1:] * value[:-1] < 0.0))[0]
    ]
    size = np.where(smooth, np.abs(value), np.inf)
    low = (size[1:-1] < size[:-2]) & (size[1:-1] < size[2:]) & both[1:] & both[:-1]
    return -np.array([*found, *radius[1:-1][low]], dtype=complex)

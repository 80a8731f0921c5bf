r"""The rightmost pole of a rational loop with one dead time: guessed, polished and proven.

With a rational function in place of the dead time the loop has finitely many poles, which are close to the exact ones
where it matters: to the right. These are starts for Newton's method on the exact characteristic function. That nothing
was missed is proven, not hoped: L(s + c), c just left of the pole found, has as many poles in the right half-plane as L
has to the right of c, and the argument principle counts them (`replicate.loops.frequency_domain.stability`). Where the
proof fails, `replicate.loops.closed_loop_poles.poles` searches the plane.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from replicate.loops.frequency_domain import stability
from replicate.loops.frequency_domain.loop_transfer import LoopTransfer
from replicate.loops.numerics import polynomials
from replicate.loops.numerics.pade import dead_time_polynomials
from replicate.loops.numerics.polynomials import horner_with_slope

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

ORDER = 6  # of the rational function
STARTS = 3
STEPS = 12
CONVERGED = 1e-12  # last relative step of Newton's method at a simple pole: the next would be rounding
SAME = 1e-8  # relative distance of two points that are one pole
REAL = 1e-10  # imaginary part, relative to the modulus, of a pole that is real
APART = 0.03  # relative distance of poles that may be one multiple pole
TIE = 1e-6  # relative distance of real parts between which no line fits
CROWDED = 0.98  # |L| at the far end of the line from which on a neutral loop may have infinitely many poles there
REACH = 0.5  # farthest distance of the line from the pole, over the dead time, unless the pole's own is larger
FARTHEST = 100.0  # distance of the line from the axis, in units of one over the dead time


def proven_pole_with_others(transfer: LoopTransfer) -> list[complex] | None:
    """Return the rightmost pole of a rational loop with one dead time, and others near it; None if there is no proof.

    One of each pair, Im >= 0, by descending real part. Of the others some may be missing.
    """
    if type(transfer) is not LoopTransfer or not transfer.dead_time or not transfer.num.size:
        return None
    poles = polished_poles(transfer, starts(transfer))
    line = _line(poles, transfer.dead_time)
    if line is None or transfer.feedthrough * math.exp(-line * transfer.dead_time) >= CROWDED:
        return None
    right = 2 if poles[0].imag else 1
    return poles if stability.unstable_poles(transfer.shifted(line)) == right else None


def starts(transfer: LoopTransfer) -> list[complex]:
    """Return the rightmost poles, Im >= 0, of the loop with a rational function in place of the dead time."""
    top, bottom = dead_time_polynomials(transfer.dead_time, ORDER)
    open_loop, fed_back = polynomials.product(transfer.den, bottom), polynomials.product(transfer.num, top)
    open_loop[open_loop.size - fed_back.size :] += fed_back
    companion = np.zeros((open_loop.size - 1, open_loop.size - 1))
    companion.flat[companion.shape[0] :: companion.shape[0] + 1] = 1.0
    companion[0] = open_loop[1:] / -open_loop[0]
    found = np.linalg.eigvals(companion).tolist()
    return sorted((complex(s) for s in found if s.imag >= 0.0), key=lambda s: -s.real)[:STARTS]


def polished_poles(transfer: LoopTransfer, near: list[complex]) -> list[complex]:
    """Return the distinct simple poles to which Newton's method leads, by descending real part."""
    found: list[complex] = []
    for start in near:
        pole = _newton(transfer, start)
        if pole is not None and all(abs(pole - other) > SAME * abs(pole) for other in found):
            found.append(pole)
    return sorted(found, key=lambda s: (-s.real, s.imag))


def _newton(transfer: LoopTransfer, s: complex) -> complex | None:
    num, den, delay = transfer.num.tolist(), transfer.den.tolist(), transfer.dead_time
    try:
        for _ in range(STEPS):
            (n, n_slope), (d, d_slope) = horner_with_slope(num, s), horner_with_slope(den, s)
            turn = cmath.exp(-s * delay)
            step = (d + n * turn) / (d_slope + (n_slope - delay * n) * turn)
            s -= step
            if abs(step) <= CONVERGED * abs(s):
                return complex(s.real, abs(s.imag)) if abs(s.imag) > REAL * abs(s) else complex(s.real, 0.0)
    except (OverflowError, ZeroDivisionError):
        pass
    return None


def _line(poles: list[complex], dead_time: float) -> float | None:
    """Return a real part that the first pole exceeds, and no other; None if the second is too close to it."""
    if not poles:
        return None
    first, *others = poles
    line = first.real - max(abs(first.real), REACH / dead_time)
    if others:
        if abs(others[0] - first) <= APART * abs(first) or first.real - others[0].real <= TIE * abs(first.real):
            return None
        line = max(line, 0.5 * (first.real + others[0].real))
    return line if abs(line) * dead_time <= FARTHEST else None

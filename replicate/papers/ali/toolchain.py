r"""How the printed Ms were computed: a Padé model of the dead time, and a norm routine that stops at 1 %.

The text says that Ms comes from a MATLAB toolbox. Its ``norm(sys, inf)`` documents the algorithm of Bruinsma and
Steinbuch and a default relative tolerance of 0.01. That routine never returns more than the true peak: it
evaluates the gain at the peaking frequencies of the system's modes and returns the best of them if no
frequency has a gain 1 % higher.

Nothing here is exact, on purpose; the exact sensitivity peak is `replicate.loops.Loop.sensitivity_peak`.

Reference: N. A. Bruinsma and M. Steinbuch, "A fast algorithm to compute the H-infinity norm of a transfer
function matrix", Systems & Control Letters 14 (1990) 287-293.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from replicate.loops import PID, Loop, Plant
from replicate.loops.numerics.pade import dead_time_polynomials

Array = NDArray[np.float64]

TOLERANCE = 0.01  # the default of norm(sys, inf)
ITERATIONS = 30


@cache
def pade_plant(theta: float, order: int) -> Plant:
    """Return (1) with K = T = 1 and the dead time replaced by its Padé approximation of the given order."""
    num, den = dead_time_polynomials(theta, order)
    return Plant(num, np.polymul(den, [1.0, -1.0]))


def pade_sensitivity_peak(theta: float, controller: PID, order: int) -> float:
    """Return max |S| of the Padé model's loop, exactly."""
    return Loop(pade_plant(theta, order), controller).sensitivity_peak().value


def pade_sensitivity_norm(theta: float, controller: PID, order: int, tolerance: float = TOLERANCE) -> float:
    """Return max |S| of the Padé model's loop as the norm routine reports it, up to ``tolerance`` too small."""
    transfer = Loop(pade_plant(theta, order), controller).transfer
    return norm_estimate(transfer.den, np.asarray(np.polyadd(transfer.den, transfer.num), dtype=float), tolerance)


def norm_estimate(num: Array, den: Array, tolerance: float = TOLERANCE) -> float:
    r"""Return the lower bound on max |num/den| at which the two-step algorithm stops.

    Parameters
    ----------
    num, den
        A stable, proper transfer function, descending powers of s.
    tolerance
        Relative accuracy: the result g satisfies g <= max|num/den| <= (1 + tolerance) g.

    Examples
    --------
    A second-order resonance starts at its own peaking frequency, so the first bound is already the peak
    1/(2 zeta sqrt(1 - zeta^2)).

    >>> import numpy as np
    >>> round(norm_estimate(np.array([1.0]), np.array([1.0, 0.2, 1.0])), 6)
    5.025189
    """

    def gain(w: Array) -> Array:
        return np.asarray(np.abs(np.polyval(num, 1j * w) / np.polyval(den, 1j * w)))

    best = max(float(np.max(gain(_peaking_frequencies(den)))), float(gain(np.zeros(1))[0]), _at_infinity(num, den))
    for _ in range(ITERATIONS):
        reached = _frequencies_of_gain(num, den, (1.0 + tolerance) * best)
        if reached.size < 2:
            break
        middles = np.sqrt(reached[:-1] * reached[1:])
        improved = max(best, float(np.max(gain(middles))))
        if improved < best * (1.0 + 0.1 * tolerance):
            break
        best = improved
    return best


def _at_infinity(num: Array, den: Array) -> float:
    return abs(float(num[0] / den[0])) if num.size == den.size else 0.0


def _peaking_frequencies(den: Array) -> Array:
    """Return the resonance frequency of every mode, at least half its natural frequency."""
    poles = np.roots(den)
    natural = np.abs(poles)
    damping = np.abs(poles.real) / natural
    return np.asarray(natural * np.sqrt(np.maximum(0.25, 1.0 - 2.0 * damping**2)))


def _frequencies_of_gain(num: Array, den: Array, level: float) -> Array:
    """Return the positive frequencies at which the gain equals ``level``, ascending."""
    roots = np.roots(np.polysub(_squared_magnitude(num), level**2 * _squared_magnitude(den)))
    real = roots.real[(roots.real > 0.0) & (np.abs(roots.imag) < 1e-6 * np.abs(roots))]
    return np.sort(np.sqrt(real))


def _squared_magnitude(polynomial: Array) -> Array:
    """Return the coefficients in w^2 of the squared magnitude on the imaginary axis."""
    mirrored = polynomial * (-1.0) ** np.arange(polynomial.size - 1, -1, -1)
    even = np.polymul(polynomial, mirrored)[::2]
    return np.asarray(even * (-1.0) ** np.arange(even.size - 1, -1, -1))

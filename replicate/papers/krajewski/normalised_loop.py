r"""The normalised loop (6), :math:`G(s) = \frac{a + bs}{s}\,\frac{e^{-\tau s}}{1 + s}`, and its margins.

Everything is written with one angle. With the lag :math:`\theta(\omega) = \arctan\omega + \tau\omega` of the
process, the point of the (a, b) plane at which G(jω) has magnitude g and phase margin m is, from (11) and (28),

.. math:: a = g\,\omega\sqrt{1+\omega^2}\,\sin(\theta + m), \qquad b = -g\sqrt{1+\omega^2}\,\cos(\theta + m),

so a > 0 as long as :math:`\theta(\omega) + m < \pi`: this is the branch on which (11) and (28) describe
stable loops. Angles are in radians here and in degrees in everything that is shown.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from replicate.loops import PI, Loop, Plant

Array = NDArray[np.float64]


def loop(a: float, b: float, tau: float) -> Loop:
    """Return the loop (6) as the numerical core sees it: K = T = 1, so K_P = b and K_I = a."""
    return Loop(Plant([1.0], [1.0, 1.0], dead_time=tau), PI(k=b, ki=a))


def frequency_response(a: ArrayLike, b: ArrayLike, tau: ArrayLike, w: ArrayLike) -> NDArray[np.complex128]:
    """Evaluate G(jω) of (6); arguments broadcast."""
    s = 1j * np.asarray(w, dtype=float)
    return np.asarray((np.asarray(a) + np.asarray(b) * s) / s * np.exp(-np.asarray(tau) * s) / (1.0 + s))  # (6)


def lag(tau: ArrayLike, w: ArrayLike) -> Array:
    """Return the process' phase lag θ = arctan ω + τω in radians."""
    w = np.asarray(w, dtype=float)
    return np.asarray(np.arctan(w) + np.asarray(tau) * w)


def point(tau: ArrayLike, w: ArrayLike, phase_margin: ArrayLike = 0.0, g: ArrayLike = 1.0) -> tuple[Array, Array]:
    """Return (a, b) at which G(jω) = g exp(j(m - π)): (11) for g = 1, (28) for m = 0.

    Parameters
    ----------
    tau, w
        Normalised dead time and frequency.
    phase_margin
        In degrees.
    g
        Magnitude of G(jω).
    """
    w = np.asarray(w, dtype=float)
    angle = np.asarray(tau) * w + np.radians(phase_margin)
    a = g * w * (np.sin(angle) + w * np.cos(angle))  # (11a), (28a)
    b = g * (w * np.sin(angle) - np.cos(angle))  # (11b), (28b)
    return np.asarray(a), np.asarray(b)


def crossover(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the gain crossover frequency, the only positive root of (15); for a = 0, |b| < 1 there is none: 0."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    half = 0.5 * (b * b - 1.0)
    root = np.hypot(half, a)
    # (16) is quadratic in ω²; where b² < 1 the usual formula would subtract nearly equal numbers.
    with np.errstate(divide="ignore", invalid="ignore"):
        small = np.where(a == 0.0, 0.0, a * a / (root - half))
    return np.asarray(np.sqrt(np.where(half > 0.0, half + root, small)))


def phase(a: ArrayLike, b: ArrayLike, tau: ArrayLike, w: ArrayLike) -> Array:
    """Return the unwrapped phase of G(jω) in radians: continuous in ω, -π/2 at ω = 0 for a > 0."""
    w = np.asarray(w, dtype=float)
    return np.asarray(np.arctan2(np.asarray(b) * w, np.asarray(a)) - 0.5 * np.pi - lag(tau, w))


def phase_margin(a: ArrayLike, b: ArrayLike, tau: ArrayLike, w: ArrayLike | None = None) -> Array:
    """Return m_φ in degrees for a > 0, negative where the loop is unstable; w is the crossover if it is known."""
    return np.asarray(np.degrees(np.pi + phase(a, b, tau, crossover(a, b) if w is None else w)))  # (9)


@cache
def end_frequency(tau: float, phase_margin: float = 0.0) -> float:
    """Return the frequency at which θ(ω) + m = π: the upper end of the locus on the b axis.

    Parameters
    ----------
    phase_margin
        In degrees, between 0 and 180.

    Raises
    ------
    ValueError
        If the phase margin or the dead time is outside its range.
    """
    if not 0.0 <= phase_margin < 180.0:
        msg = f"the phase margin must be at least 0 and less than 180 degrees, not {phase_margin:g}"
        raise ValueError(msg)
    if not tau > 0.0:
        msg = f"the normalised dead time must be positive, not {tau:g}"
        raise ValueError(msg)
    angle = np.pi - np.radians(phase_margin)
    return float(brentq(lambda w: float(lag(tau, w)) - angle, 0.0, angle / tau, xtol=1e-300, rtol=8.9e-16))


def phase_crossover(a: float, b: float, tau: float) -> float:
    """Return ω_B, the first frequency with phase -π, for a >= 0.

    On (0, end_frequency) the phase reaches -π exactly once, since there the slope (30) rises from -∞ to ∞.
    """
    end = end_frequency(tau)
    a = max(a, 0.0)  # at the ends of the loci rounding may leave a little less

    def excess(w: float) -> float:  # `phase` + π of a single number
        return math.atan2(b * w, a) + 0.5 * math.pi - math.atan(w) - tau * w

    if excess(end) >= 0.0:  # on the b axis
        return end
    return float(brentq(excess, 0.0, end, xtol=1e-300, rtol=8.9e-16, maxiter=300))


def gain_ratio(a: float, b: float, tau: float) -> float:
    """Return g = |G(jω_B)|, the reciprocal of the gain margin (27)."""
    return float(abs(frequency_response(a, b, tau, phase_crossover(a, b, tau))))


def margin_along_crossover(tau: float, w: float, a: float) -> tuple[float, float]:
    """Return b > 0 on the ellipse (16) at a given a, and the phase margin there in degrees."""
    b = float(np.sqrt(1.0 + w * w - (a / w) ** 2))
    return b, float(phase_margin(a, b, tau))

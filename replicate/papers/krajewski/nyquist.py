"""The Nyquist diagram of the normalised loop: where it starts, its asymptote, and how often it encircles -1."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.papers.krajewski.normalised_loop import frequency_response


def asymptote(a: ArrayLike, b: ArrayLike, tau: float) -> NDArray[np.float64]:
    """Return the abscissa of the vertical asymptote for ω → 0+: (12)."""
    return np.asarray(np.asarray(b) - (1.0 + tau) * np.asarray(a), dtype=float)


def encirclements(a: float, b: float, tau: float) -> int:
    """Return how often the full Nyquist curve encircles -1 clockwise.

    The curve is closed by the large arc on which s passes the pole at 0 on its right; the angle of 1 + G is
    followed from there to a frequency beyond which |G| < 1.
    """
    w = np.geomspace(1e-6, 1e3, 20_001)
    angle = np.unwrap(np.angle(1.0 + frequency_response(a, b, tau, w)))
    # Over the small half circle s = ε exp(jφ), φ from -π/2 to π/2, G ≈ a/s turns by -π (a > 0 or a < 0 alike).
    turn = 2.0 * (angle[-1] - angle[0]) - np.pi
    return round(float(-turn / (2.0 * np.pi)))


def quadrant(z: complex) -> int:
    """Return the quadrant, 1 to 4, of a number off the axes."""
    return (1 if z.imag > 0 else 4) if z.real > 0 else (2 if z.imag > 0 else 3)

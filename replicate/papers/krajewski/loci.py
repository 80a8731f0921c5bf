"""The loci of the charts as parametric curves with their exact derivatives.

A locus is a function of a parameter u in [0, 1] that returns points and derivatives, shapes (n, 2). It ends
where the loop stops being stable or the frequency leaves the branch on which a > 0, so nothing needs clipping.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.papers.krajewski.normalised_loop import (
    end_frequency,
    gain_ratio,
    lag,
    phase_crossover,
    point,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Locus:
    """A smooth curve in the (a, b) plane.

    Attributes
    ----------
    curve
        Maps parameters u in [0, 1], shape (n,), to points and derivatives d/du, each of shape (n, 2).
    """

    curve: Callable[[Array], tuple[Array, Array]]

    def points(self, count: int = 401) -> Array:
        """Return points (a, b) along the curve, shape (count, 2)."""
        return self.curve(np.linspace(0.0, 1.0, count))[0]

    def part(self, start: float, end: float) -> Locus:
        """Return the part between two parameters (reversed if start > end)."""

        def curve(u: Array) -> tuple[Array, Array]:
            points, slopes = self.curve(start + (end - start) * u)
            return points, slopes * (end - start)

        return Locus(curve)


def _by_frequency(tau: float, low: float, high: float, phase_margin: float, g: float) -> Locus:
    """Return the points with fixed magnitude and phase as the frequency moves."""
    m = np.radians(phase_margin)

    def curve(u: Array) -> tuple[Array, Array]:
        w = low + (high - low) * u
        psi = lag(tau, w) + m
        root = np.sqrt(1.0 + w * w)
        psi_slope = tau + 1.0 / (1.0 + w * w)
        sin, cos = np.sin(psi), np.cos(psi)
        points = np.column_stack(point(tau, w, phase_margin, g))
        slopes = np.column_stack(
            [
                (1.0 + 2.0 * w * w) / root * sin + w * root * cos * psi_slope,
                -w / root * cos + root * sin * psi_slope,
            ]
        )
        return points, g * (high - low) * slopes

    return Locus(curve)


def constant_phase_margin(tau: float, phase_margin: float) -> Locus:
    """Return the locus of a phase margin (degrees), from (0, -cos m) up to (0, b_u): (11)."""
    return _by_frequency(tau, 0.0, end_frequency(tau, phase_margin), phase_margin, 1.0)


def constant_gain_ratio(tau: float, g: float) -> Locus:
    """Return the locus of g, from (0, -g) up to (0, g b_u(0)): (28)."""
    return _by_frequency(tau, 0.0, end_frequency(tau), 0.0, g)


def stability_boundary(tau: float) -> Locus:
    """Return the curved part of the stability boundary, m = 0 and g = 1."""
    return constant_phase_margin(tau, 0.0)


def _ellipse_arc(w: float, start: float, end: float) -> Locus:
    """Return a = ω√(1+ω²) sin ψ, b = -√(1+ω²) cos ψ between two values of ψ: (16)."""
    root = np.sqrt(1.0 + w * w)

    def curve(u: Array) -> tuple[Array, Array]:
        psi = start + (end - start) * u
        points = root * np.column_stack([w * np.sin(psi), -np.cos(psi)])
        slopes = root * (end - start) * np.column_stack([w * np.cos(psi), np.sin(psi)])
        return points, slopes

    return Locus(curve)


def crossover_ellipse(w: float) -> Locus:
    """Return the right half of the ellipse (16), from (0, -√(1+ω²)) to (0, √(1+ω²))."""
    return _ellipse_arc(w, 0.0, np.pi)


def constant_crossover(tau: float, w: float, least: float = 0.0, most: float | None = None) -> Locus | None:
    """Return the arc of (16) with phase margins in a range, in the order of rising phase margin.

    Parameters
    ----------
    least, most
        Degrees; by default the whole arc from the stability boundary up to the b axis.

    Returns
    -------
    Locus or None
        ``None`` if no point of the arc has such a phase margin.
    """
    start = float(lag(tau, w)) + np.radians(least)
    end = np.pi if most is None else min(np.pi, float(lag(tau, w)) + np.radians(most))
    return _ellipse_arc(w, start, end) if start < end else None


def constant_phase_crossover(tau: float, w: float) -> Locus | None:
    """Return the segment of the line (29) inside the stability region; ``None`` if there is none."""
    if w >= end_frequency(tau):
        return None
    tip = np.array([float(x) for x in point(tau, w)])  # g = 1 on the stability boundary

    def curve(u: Array) -> tuple[Array, Array]:
        return u[:, None] * tip, np.broadcast_to(tip, (u.size, 2))

    return Locus(curve)


def upper_end(tau: float, phase_margin: float) -> float:
    """Return b_u, where the locus of a phase margin (degrees) meets the b axis above: (17)."""
    return float(np.sqrt(1.0 + end_frequency(tau, phase_margin) ** 2))


def largest_a(tau: float, phase_margin: float) -> float:
    """Return the largest a on the locus of a phase margin, for the limits of a chart."""
    return float(constant_phase_margin(tau, phase_margin).points(2001)[:, 0].max())


@dataclass(frozen=True)
class Corner:
    """A point where a locus of phase margin crosses one of gain margin; u is its place on either locus."""

    a: float
    b: float
    crossover: float
    u_phase_margin: float
    u_gain_ratio: float


def corners(tau: float, phase_margin_degrees: float, g: float) -> list[Corner]:
    """Return the crossings of the loci m = const and g = const, in the order of rising crossover frequency."""
    end = end_frequency(tau, phase_margin_degrees)

    def excess(w: float) -> float:
        a, b = point(tau, w, phase_margin_degrees)
        return gain_ratio(float(a), float(b), tau) - g

    grid = end * np.linspace(0.0, 1.0, 402)[1:-1]
    values = np.array([excess(w) for w in grid])
    found = []
    for i in np.flatnonzero(values[:-1] * values[1:] < 0.0):
        w = float(brentq(excess, grid[i], grid[i + 1], xtol=1e-300, rtol=8.9e-16))
        a, b = (float(x) for x in point(tau, w, phase_margin_degrees))
        found.append(Corner(a, b, w, w / end, phase_crossover(a, b, tau) / end_frequency(tau)))
    return found

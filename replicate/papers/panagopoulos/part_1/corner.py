"""Where the envelope of G12 changes from a smooth top to a corner.

The smooth optimum is a root of (18), and as the damping falls the Nyquist curve comes to touch the circle a second
time. From there on the root still exists, but its loop violates the constraint at another frequency.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from replicate.loops import PI, Circle, Loop
from replicate.loops.design.pi_tangency import smooth_gains
from replicate.papers.panagopoulos.part_1.phase import roots_of_h
from replicate.papers.panagopoulos.part_1.plants import resonant

FREQUENCIES = np.geomspace(0.3, 4.0, 3000)  # around the resonance at 3, where everything happens
BRACKET = (0.8, 2.6)  # of a


def smooth_solution(a: float, ms: float) -> tuple[float, PI]:
    """Return the one root of h that gives a positive integral gain, and its gains."""
    plant, circle = resonant(a), Circle.of(ms)
    gains = {w: smooth_gains(plant, circle, w) for w in roots_of_h(plant, circle)}
    root, (k, ki) = next((w, pair) for w, pair in gains.items() if pair[1] > 0.0)
    return root, PI(k, ki)


def largest_sensitivity(a: float, ms: float) -> float:
    """Return max |S| of the loop that the root of h gives."""
    _, controller = smooth_solution(a, ms)
    return Loop(resonant(a), controller).sensitivity_peak().value


@cache
def corner_limit(ms: float) -> float:
    """Return the smallest a for which the root of h is the optimum: the second peak of |S| just reaches Ms."""

    def excess(a: float) -> float:
        root, controller = smooth_solution(a, ms)
        loop = Loop(resonant(a), controller)

        def distance(w: float) -> float:
            return float(abs(1.0 + complex(loop(1j * w))))

        d = np.abs(1.0 + loop(1j * FREQUENCIES))
        low = np.nonzero((d[1:-1] < d[:-2]) & (d[1:-1] < d[2:]))[0] + 1
        others = [i for i in low if FREQUENCIES[i] < 0.97 * root]
        if not others:
            return -1.0
        minima = (
            minimize_scalar(distance, bounds=(FREQUENCIES[i - 1], FREQUENCIES[i + 1]), options={"xatol": 1e-12}).fun
            for i in others
        )
        return float(1.0 / min(minima) - ms)

    return float(brentq(excess, *BRACKET, xtol=1e-11))


@cache
def slope_limit() -> float:
    """Return the smallest a for which G12 satisfies the second condition of (20), slope below 1 at all frequencies."""

    def excess(a: float) -> float:
        plant = resonant(a)

        def slope(w: float) -> float:
            return float((1j * w * plant.log_derivative(1j * w)).real)

        slopes = (1j * FREQUENCIES * plant.log_derivative(1j * FREQUENCIES)).real
        steepest = FREQUENCIES[np.argmax(slopes)]
        found = minimize_scalar(
            lambda w: -slope(w),
            bounds=(0.98 * steepest, 1.02 * steepest),
            method="bounded",
            options={"xatol": 1e-12},
        )
        return -float(found.fun) - 1.0

    return float(brentq(excess, *BRACKET, xtol=1e-12))


def curvature(a: float, ms: float) -> float:
    """Return d2f/dw2 at the root of h (19), exact to rounding.

    The squared distance is (1 + L(iw)) (1 + L(-iw)), an analytic function of w: Cauchy's formula on a circle around w0.
    """
    root, controller = smooth_solution(a, ms)
    loop = Loop(resonant(a), controller)
    turn = np.exp(2j * np.pi * np.arange(32) / 32)
    radius = 0.05 * root
    w = root + radius * turn
    f = (1.0 + loop(1j * w)) * (1.0 + loop(-1j * w))
    return float(2.0 * np.mean(f / turn**2).real / radius**2)


@cache
def curvature_limit(ms: float) -> float:
    """Return the smallest a for which condition (19) holds at the root of h."""
    return float(brentq(lambda a: curvature(a, ms), 0.5, 1.5, xtol=1e-12))

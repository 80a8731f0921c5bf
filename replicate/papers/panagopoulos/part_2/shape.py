"""How a Nyquist curve bends and turns: the largest curvature and phase slope on a range of frequencies."""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from replicate.loops import PID, Circle, Plant, search_range
from replicate.loops.design.nyquist_constraints import LoopJet
from replicate.papers.panagopoulos.part_2.designs import pi_design
from replicate.papers.panagopoulos.part_2.processes import PLANTS, split

POINTS = 2000
DECADES = 3.0  # beyond the search range's lower end, where it has no upper one


@cache
def stated_range(row: str) -> tuple[float, float]:
    """Return the search range of section 4 for a table row."""
    pi = pi_design(row)
    return search_range(PLANTS[split(row)[0]], pi.k, pi.ki)


def values(kind: Literal["curvature", "phase"], plant: Plant, controller: PID, w: np.ndarray) -> np.ndarray:
    """Return the curvature, or the slope of the phase d(arg L)/d(ln w), at frequencies."""
    gains = np.array([controller.k, controller.ki, controller.kd])
    value, _ = LoopJet.of(plant, w).values(kind, Circle.of(2.0), gains)
    return np.asarray(-value)


def largest_over(
    kind: Literal["curvature", "phase"], plant: Plant, controller: PID, span: tuple[float, float]
) -> float:
    """Return the largest value on a range, polished between the points of a grid."""
    low, high = span
    w = np.geomspace(low, high if np.isfinite(high) else low * 10.0**DECADES, POINTS)
    sampled = values(kind, plant, controller, w)
    i = int(np.argmax(sampled))
    if i in (0, POINTS - 1):
        return float(sampled[i])
    found = minimize_scalar(
        lambda x: -float(values(kind, plant, controller, np.array([x]))[0]),
        bounds=(w[i - 1], w[i + 1]),
        method="bounded",
        options={"xatol": 1e-9 * w[i]},
    )
    return max(float(sampled[i]), -float(found.fun))


def largest_gain(plant: Plant, ms: float) -> float:
    """Return the largest k for which the lowest band of ellipses leaves room: the maximum of their left vertices.

    The left vertices lie at ``-C alpha/r^2 - R/r``; a larger k is inside some ellipse for every ki and kd.
    """
    radius = Circle.of(ms).radius

    def left(w: np.ndarray) -> np.ndarray:
        value = plant(1j * w)
        return np.asarray(-value.real / np.abs(value) ** 2 - radius / np.abs(value))

    # the first band: up to where the phase of the plant passes -270 degrees and the vertices turn back
    w = np.geomspace(1e-3, 1e3, 6000)
    phase = np.unwrap(np.angle(plant(1j * w)))
    phase -= 2.0 * np.pi * np.round((phase[0] + 0.5 * np.pi * plant.integrators) / (2.0 * np.pi))
    w = w[: np.argmax(phase < -1.5 * np.pi)] if np.any(phase < -1.5 * np.pi) else w
    sampled = left(w)
    peak = np.nonzero((sampled[1:-1] >= sampled[:-2]) & (sampled[1:-1] >= sampled[2:]) & (sampled[1:-1] > 0.0))[0]
    if peak.size == 0:
        return float("nan")
    i = int(peak[0]) + 1
    found = minimize_scalar(
        lambda x: -float(left(np.array([x]))[0]),
        bounds=(w[i - 1], w[i + 1]),
        method="bounded",
        options={"xatol": 1e-12 * w[i]},
    )
    return -float(found.fun)

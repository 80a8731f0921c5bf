"""Theorem 1: where the smooth optimum must be, and which of the roots of h it is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI, Circle, Loop
from replicate.loops.design.pi_tangency import smooth_condition, smooth_gains
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.designs import design
from replicate.papers.panagopoulos.part_1.labels import design_rows
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag, roots_of_h
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

ROWS = {f"G{number} Ms={ms}": (f"G{number}", ms) for number in range(1, 12) for ms in (1.4, 2.0)}

theorem_1 = paper.table(
    "I-theorem-1",
    "Theorem 1: the interval of the optimum",
    kind="formula",
    printed=False,
    rows=tuple(ROWS),
    columns=("w90", "w0", "w_dagger", "slope", "h_low", "h_high", "inside", "roots", "positive", "stable"),
    caption="The interval (21) and the design's $\\omega_0$ in it; the largest slope "
    "$d\\log|G|/d\\log\\omega$ in it, which (20) wants below 1; the sign of $h$ at its ends; how many roots "
    "$h$ has in it; how many it has at all, up to a lag of two turns; how many of these give $k_i > 0$; and "
    "how many of those a stable loop.",
    labels={
        **design_rows(ROWS),
        "w90": "$\\omega_{90}$",
        "w0": "$\\omega_0$",
        "w_dagger": "$\\omega_\\dagger$",
        "slope": "slope",
        "h_low": "$h$ low",
        "h_high": "$h$ high",
        "inside": "roots inside",
        "roots": "roots",
        "positive": "$k_i>0$",
        "stable": "stable",
    },
)


def interval(plant: str, ms: float) -> tuple[float, float]:
    """Return the ends of the interval (21)."""
    circle = Circle.of(ms)
    upper = 180.0 - math.degrees(math.asin(circle.radius / circle.center))
    return frequencies_of_lag(PLANTS[plant], 90.0)[0], frequencies_of_lag(PLANTS[plant], upper)[0]


def largest_slope(plant: str, low: float, high: float) -> float:
    """Return the largest d log|G| / d log w on an interval (20)."""
    w = np.geomspace(max(low, 1e-6 * high), high, 4001)
    return float(np.max((1j * w * PLANTS[plant].log_derivative(1j * w)).real)) + 0.0  # no negative zero


def gains_at_roots(plant: str, ms: float) -> list[tuple[float, float, float, bool]]:
    """Return (w, k, ki, stable) for every root of h."""
    circle = Circle.of(ms)
    found = []
    for w in roots_of_h(PLANTS[plant], circle):
        k, ki = smooth_gains(PLANTS[plant], circle, w)
        stable = ki > 0.0 and Loop(PLANTS[plant], PI(k, ki)).is_stable()
        found.append((w, k, ki, stable))
    return found


@theorem_1.reading("as-written", "All roots of (18)")
def roots() -> pd.DataFrame:
    """Look for every root of h, for every plant."""
    rows = {}
    for row, (plant, ms) in ROWS.items():
        low, high = interval(plant, ms)
        ends = np.array([low or 1e-6 * high, high])  # for an integrator the interval begins at w = 0
        h = smooth_condition(PLANTS[plant], Circle.of(ms), ends)
        found = gains_at_roots(plant, ms)
        rows[row] = [
            low,
            design(plant, ms).frequency,
            high,
            largest_slope(plant, low, high),
            *np.sign(h),
            sum(low < w < high for w, *_ in found),
            len(found),
            sum(ki > 0.0 for _, _, ki, _ in found),
            sum(stable for *_, stable in found),
        ]
    return theorem_1.frame(rows)

"""Exact overshoot and rise time of proportional control over many gains at once, time scaled to h = 1."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.loops import PI, Plant, step_responses

Array = NDArray[np.float64]

SHORTEST = 30.0  # dead times; the highest peak of a loop up to 0.999 of its stability limit comes long before


@dataclass(frozen=True)
class Sweep:
    """Loops with one ph: gains Kh, overshoot in per cent, rise time over h."""

    ph: float
    kh: Array
    overshoot: Array
    rise_time: Array


@cache
def stability_limit(ph: float) -> float:
    """Return the largest stable Kh: cos w = -ph/Kh, sin w = w/Kh with w in (0, pi)."""
    if ph == 0.0:
        return 0.5 * np.pi
    w = brentq(lambda w: w * np.cos(w) + ph * np.sin(w), 0.5 * np.pi, np.pi, xtol=1e-300, rtol=8.9e-16)
    return float(np.hypot(w, ph))


def sweep(ph: float, kh: Array) -> Sweep:
    """Return exact overshoot and rise time; one matrix product per dead time serves all gains."""
    until = max(SHORTEST, 1.0 + 4.0 / (ph + float(kh.min())))  # a slow loop is close to the lag 1/(p + K)
    signals = step_responses(Plant([1.0], [1.0, ph], dead_time=1.0), [PI(float(k)) for k in kh], until)
    overshoot = [max(0.0, 100.0 * (float(y.peak()) / y.final - 1.0)) for y in signals]
    rise = [y.first_reach(0.9 * y.final) - y.first_reach(0.1 * y.final) for y in signals]
    return Sweep(ph, np.asarray(kh, dtype=float), _without_rounding(np.array(overshoot)), np.array(rise))


def _without_rounding(overshoot: Array) -> Array:
    return np.where(overshoot < 1e-11, 0.0, overshoot)


@cache
def dense(count: int, gains: int, top: float = 0.95) -> tuple[Sweep, ...]:
    """Return ``count`` values of ph from 0 to 10, each with ``gains`` values of Kh up to ``top`` of the limit."""
    # finer where the curves change most
    values = np.round(10.0 * np.linspace(0.0, 1.0, count) ** 2, 4)
    return tuple(sweep(float(ph), np.linspace(0.02, top, gains) * stability_limit(float(ph))) for ph in values)

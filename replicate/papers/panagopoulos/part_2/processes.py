"""The eight processes of paper II and the rows of its tables.

The letters mean other processes than in paper I, so this part keeps its own list.
"""

from __future__ import annotations

from functools import reduce

import numpy as np

from replicate.loops import Plant


def _lags(*time_constants: float) -> list[float]:
    """Return the coefficients of (1 + s T1)(1 + s T2)..., descending powers."""
    factors = [np.array([t, 1.0]) for t in time_constants]
    return [float(c) for c in reduce(np.polymul, factors)]


G4 = Plant([1.0], _lags(1, 1, 1, 1))  # also the example of the supplement, (4)

PLANTS: dict[str, Plant] = {
    "G1": Plant([1.0], [*_lags(1, 1, 1), 0.0]),
    "G2": Plant([1.0], _lags(1, 1, 1), dead_time=5.0),
    "G3": Plant([1.0], _lags(1, 0.2, 0.04, 0.008)),
    "G4": G4,
    "G5": Plant([1.0], _lags(*[1] * 5)),
    "G6": Plant([1.0], _lags(*[1] * 6)),
    "G7": Plant([1.0], _lags(*[1] * 7)),
    "G8": Plant([-2.0, 1.0], _lags(1, 1, 1)),
}

LEVELS = (1.4, 2.0)
"""The two values of the design parameter Ms."""

NEAR_INTEGRATING = ("G1", "G3")
"""Integrating, or "a pole relatively close to zero": here the text leaves out the curvature constraint."""

ROWS = tuple(f"{name} Ms={ms}" for name in PLANTS for ms in LEVELS)
ROW_LABELS = {f"{name} Ms={ms}": f"${name[0]}_{name[1]}$, $M_s = {ms}$" for name in PLANTS for ms in LEVELS}


def split(row: str) -> tuple[str, float]:
    """Return process and Ms of a row key.

    Examples
    --------
    >>> split("G4 Ms=2.0")
    ('G4', 2.0)
    """
    name, _, ms = row.partition(" Ms=")
    return name, float(ms)

"""How the frequencies of Table 1 were read: off 200 logarithmic points over three decades.

The design's own w0 is a root of (18) and exact. The printed one is the point of a grid at which |S| is largest, and the
set-point weight was computed there too. All twenty numbers of the five plants without dead time follow from a grid of
200 points, a factor of 10^(3/199) = 1.035 apart, as MATLAB's ``logspace(a, a + 3, 200)`` makes it.
"""

from __future__ import annotations

import numpy as np

from replicate.loops import setpoint_weight
from replicate.papers.panagopoulos.part_1.designs import complementary_peak, design, loop
from replicate.papers.panagopoulos.part_1.plants import PLANTS

POINTS = 200
POINTS_TRIED, DECADES_TRIED, FIRST_TRIED = (50, 100, 200, 500, 1000), (2, 3, 4), (-4, -3, -2, -1, 0)
FIRST_DECADE = {"G1": -2, "G2": -1, "G4": -3, "G5": -2, "G6": -1}  # none fits G3, which has dead time


def peak_on_grid(plant: str, ms: float) -> float:
    """Return the point of the plant's grid at which |S| is largest; w0 itself for a plant without grid."""
    if plant not in FIRST_DECADE:
        return design(plant, ms).frequency
    first = FIRST_DECADE[plant]
    w = np.logspace(first, first + 3, POINTS)
    sensitivity = np.abs(1.0 / (1.0 + loop(plant, ms)(1j * w)))
    return float(w[np.argmax(sensitivity)])


def weight_on_grid(plant: str, ms: float) -> float:
    """Return the set-point weight (25) at the grid's peak of |S|."""
    found = design(plant, ms)
    at = (peak_on_grid(plant, ms), complementary_peak(plant, ms).value)
    return setpoint_weight(PLANTS[plant], found.k, found.ki, at=at)

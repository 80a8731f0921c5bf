"""Margins and maximum sensitivity of the proposed rule over the whole range of dead times."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from replicate.exhibits import extrema
from replicate.loops import Loop
from replicate.papers.khan.processes import loop

# of log ph, one for each case of the rule
PARTS = (np.linspace(np.log(0.01), np.log(0.2), 16), np.linspace(np.log(0.2 + 1e-9), np.log(20.0), 25))


@cache
def robustness(variant: str, points: int = 61) -> tuple[np.ndarray, ...]:
    """Return ph, gain margin, phase margin in radians and M_s of the proposed rule on 0.01..20."""
    ph = np.geomspace(0.01, 20.0, points)
    loops = [loop("Proposed", 1.0, float(x), variant) for x in ph]
    margins = [closed.margins() for closed in loops]
    return (
        ph,
        np.array([m.gain for m in margins]),
        np.radians([m.phase for m in margins]),
        np.array([float(closed.sensitivity_peak()) for closed in loops]),
    )


def smallest(of_loop: Callable[[Loop], float], variant: str) -> tuple[float, float]:
    """Return the ph in 0.01..20 at which a quantity of the rule's loop is smallest, and how small, by optimisation.

    The two cases of the rule, which meet at ph = 0.2 with a jump, are searched apart.
    """

    def quantity(x: float) -> float:
        return of_loop(loop("Proposed", 1.0, float(np.exp(x)), variant))

    found = [
        extrema.smallest(quantity, part, np.array([of_loop(closed) for closed in loops]))
        for part, loops in zip(PARTS, _loops_on_parts(variant), strict=True)
    ]
    at, value = min(found, key=lambda one: one[1])
    return float(np.exp(at)), value


@cache
def _loops_on_parts(variant: str) -> tuple[tuple[Loop, ...], ...]:
    return tuple(tuple(loop("Proposed", 1.0, float(np.exp(x)), variant) for x in part) for part in PARTS)

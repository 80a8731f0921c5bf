"""Margins and maximum sensitivity of the proposed rule over the whole range of dead times."""

from __future__ import annotations

from functools import cache

import numpy as np

from replicate.papers.khan.processes import loop


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

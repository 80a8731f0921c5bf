"""Frequencies at which a plant has a given phase lag, and the roots of h(w)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from replicate.loops import Circle, Plant
from replicate.loops.design.pi_tangency import smooth_condition
from replicate.loops.frequency_domain.frequency_grids import design_grid


def frequencies_of_lag(plant: Plant, degrees: float) -> tuple[float, ...]:
    """Return all frequencies at which the plant lags by an angle, ascending; 0 if it does so from the start.

    The lag is counted continuously from steady state, where an integrator has 90 degrees and an unstable pole 180.
    """
    w = design_grid(plant) * np.sqrt(1.0001)  # off the points at which a dead time's lag is a round number
    lag = -np.degrees(np.unwrap(np.angle(plant(1j * w))))
    negative = plant.is_rational and plant.num[-1] * np.trim_zeros(plant.den, "b")[-1] < 0.0
    at_rest = 90.0 * plant.integrators + (180.0 if negative else 0.0)
    lag += 360.0 * np.round((at_rest - lag[0]) / 360.0)
    turn = np.exp(1j * np.radians(degrees))

    def excess(x: float) -> float:  # the plant turned back by the lag is real and positive there
        return float(np.angle(complex(plant(1j * x)) * turn))

    found = [0.0] if abs(at_rest - degrees) < 1e-9 else []
    changes = np.nonzero((lag[:-1] - degrees) * (lag[1:] - degrees) < 0.0)[0]
    found += [float(brentq(excess, w[i], w[i + 1], xtol=1e-300, rtol=8.9e-16)) for i in changes]
    return tuple(found)


def roots_of_h(plant: Plant, circle: Circle) -> tuple[float, ...]:
    """Return all roots of h (18) up to two turns of the plant's own phase, ascending."""
    w = design_grid(plant)
    h = smooth_condition(plant, circle, w)

    def condition(x: float) -> float:
        return float(smooth_condition(plant, circle, np.array([x]))[0])

    changes = np.nonzero(h[:-1] * h[1:] < 0.0)[0]
    return tuple(float(brentq(condition, w[i], w[i + 1], xtol=1e-300, rtol=8.9e-16)) for i in changes)

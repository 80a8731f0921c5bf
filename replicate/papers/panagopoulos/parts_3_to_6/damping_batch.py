"""Paper VI: the gain k_b of smallest IAE over a test batch. The paper's batch is not given; this one is ours."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from replicate.papers.panagopoulos.parts_3_to_6.active_damping import Shaft, damping_ratio, k_b_from
from replicate.papers.panagopoulos.parts_3_to_6.modal import ModalSum

OMEGA_P = (1.6, 3.0, 6.0, 12.0)
ZETA_P = (0.01, 0.02, 0.03, 0.05, 0.1)  # omega_f = 1, as in the paper

GAINS = 10  # of the search between 0 and the largest stable gain
DECIMALS = 5  # of the best gain: at a minimum the IAE does not tell more


class Member(NamedTuple):
    """One process of the batch and its best gain."""

    omega_p: float
    zeta_p: float
    ratio: float  # P_max / P_min
    k_b: float
    iae: float
    iae_without: float
    iae_by_formula_6: float
    iae_by_formula_10: float
    damping: float  # smallest damping ratio of the inner loop with k_b by (10)


class Line(NamedTuple):
    """A fitted line k_b = intercept + slope * P_max/P_min and the largest distance of a member from it."""

    slope: float
    intercept: float
    largest_residual: float


def impulse_iae(shaft: Shaft, k_b: float) -> float:
    """Return the IAE of the response to a unit impulse of the load (r = 0)."""
    return ModalSum.impulse(shaft.damped(k_b)).absolute_integral()


def best_gain(shaft: Shaft) -> tuple[float, float]:
    """Return the k_b of smallest IAE, to five decimals, and that IAE; 0 if feedback gains nothing."""
    limit = shaft.largest_stable_gain()
    grid = limit * np.linspace(0.0, 0.96, GAINS)
    values = [impulse_iae(shaft, k_b) for k_b in grid]
    lowest = int(np.argmin(values))
    bounds = (grid[max(lowest - 1, 0)], grid[min(lowest + 1, GAINS - 1)])
    found = minimize_scalar(lambda k: impulse_iae(shaft, k), bounds=bounds, method="bounded", options={"xatol": 1e-7})
    # where the output never changes sign the IAE is P(0), whatever the gain
    if found.fun > values[0] * (1.0 - 1e-9):
        return 0.0, values[0]
    k_b = round(float(found.x), DECIMALS)
    return k_b, impulse_iae(shaft, k_b)


@cache
def batch() -> tuple[Member, ...]:
    """Return the batch with the best gains."""
    members = []
    for omega_p in OMEGA_P:
        for zeta_p in ZETA_P:
            shaft = Shaft.as_in_eq_3(zeta_p, omega_p)
            k_b, iae = best_gain(shaft)
            by_ratio = k_b_from(shaft.ratio)
            without, plain, refined = (impulse_iae(shaft, gain) for gain in (0.0, 1.0, by_ratio))
            damping = damping_ratio(shaft.damped(by_ratio).poles())
            members.append(Member(omega_p, zeta_p, shaft.ratio, k_b, iae, without, plain, refined, damping))
    return tuple(members)


def fit(members: tuple[Member, ...]) -> Line:
    """Return the least-squares line through best gains over P_max/P_min."""
    x = np.array([member.ratio for member in members])
    y = np.array([member.k_b for member in members])
    slope, intercept = np.polyfit(x, y, 1)
    return Line(float(slope), float(intercept), float(np.max(np.abs(y - intercept - slope * x))))


def of(omega_p: float) -> tuple[Member, ...]:
    """Return the members of one resonance frequency."""
    return tuple(member for member in batch() if member.omega_p == omega_p)

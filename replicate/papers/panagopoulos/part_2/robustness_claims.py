"""The checkable formulas of section 2 of paper II: the norm (2), and what noise filters do at high frequency."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math

import numpy as np

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.loops import PID, Loop, Weight, gamma_norm
from replicate.papers.panagopoulos.part_2.claims import ROUNDING, claims
from replicate.papers.panagopoulos.part_2.designs import optimal
from replicate.papers.panagopoulos.part_2.processes import PLANTS, split

ROW = "G4 Ms=1.4"  # the process of the supplement's examples
FACTORS = (2.0, 5.0, 10.0)  # N between the ends that the text gives
FAST = 1e9  # rad/s, far above all corner frequencies
CLOSE = 1e-6  # relative; what is left of the corner frequencies there


@claims.claim("eq-2", "(2) is an $H_\\infty$ norm.", where="II, section 2, (2)")
def eq_2() -> Finding:
    plant, controller = PLANTS[split(ROW)[0]], optimal(ROW)
    norm = gamma_norm(plant, controller, Weight.balancing(plant, controller))
    value = complex(Loop(plant, controller)(1j * norm.frequency))
    formula = (1.0 + abs(value)) / abs(1.0 + value)
    return Finding(
        "holds" if abs(formula / norm.value - 1.0) < ROUNDING else "fails",
        norm.value,
        f"For {split(ROW)[0]}, $M_s = 1.4$, the largest value of (2) is {number(norm.value, 6)}, and so is the norm "
        "of the "
        "four transfer functions with the weight of paper III.",
    )


def _gain(controller: PID) -> float:
    """Return the high-frequency gain from measurement to control signal."""
    return float(abs(controller.feedback(np.array([1j * FAST]))[0]))


@claims.claim(
    "high-frequency-derivative",
    "A filter on the derivative alone, with $T_d/N$, limits the high-frequency gain to $k(1+N)$.",
    where="II, section 2, measurement noise",
)
def derivative_filter() -> Finding:
    c = optimal(ROW)
    td = c.derivative_time
    found = {n: _gain(PID.ideal(c.k, c.integral_time, td, derivative_filter=td / n)) for n in FACTORS}
    off = max(abs(found[n] / (c.k * (1.0 + n)) - 1.0) for n in FACTORS)
    return Finding(
        "holds" if off < CLOSE else "fails",
        found[10.0] / c.k,
        "For the optimum of $G_4$, $M_s = 1.4$, it is "
        + ", ".join(f"{number(found[n] / c.k)} $k$ ($N = {n:g}$)" for n in FACTORS)
        + ".",
    )


@claims.claim(
    "high-frequency-all",
    "With all terms behind a filter of first order the high-frequency gain is $k_d/T_f$, with one of second order "
    "zero.",
    where="II, section 2, measurement noise",
)
def filter_on_all() -> Finding:
    c, time = optimal(ROW), 0.1
    first, second = (
        _gain(PID(c.k, c.ki, c.kd, measurement_filter=time, measurement_filter_order=order)) for order in (1, 2)
    )
    holds = math.isclose(first, c.kd / time, rel_tol=CLOSE) and second < CLOSE * first
    return Finding(
        "holds" if holds else "fails",
        first * time / c.kd,
        f"For the same controller and $T_f = {time:g}$ it is {number(first, 6)} with the first order, where $k_d/T_f$ "
        "is "
        f"{number(c.kd / time, 6)}; with the second order it falls towards zero ({number(second, 2)} at $10^9$ rad/s).",
    )

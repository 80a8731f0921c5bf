"""Example 8 and section 4.2: what the noise filter does."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np

from replicate.loops import PI, Loop
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.table_4 import (
    FACTORS,
    MS,
    NOISE_CORNER,
    NOISE_DENSITY,
    Filtered,
    filtered,
)

if TYPE_CHECKING:
    import pandas as pd

RECOMMENDED = (5, 10)
FINITE = {row[2:]: m for row, m in FACTORS.items() if math.isfinite(m)}

example_8 = paper.table(
    "I-example-8",
    "Filtering of measurement noise, $G_7$",
    kind="example",
    rows=(
        *(f"{part}_Gf_m{m}" for m in RECOMMENDED for part in ("abs", "arg")),
        "zeta",
        *(f"Tf_m{m}" for m in FINITE),
        *(f"sigma_S_m{m}" for m in FINITE),
        *(f"excess_m{m}" for m in FINITE),
    ),
    columns=("value",),
    caption="The filter at $\\omega_0$ for the recommended $m$ (section 4.2; degrees); its time constant; the "
    "standard deviation of the control signal with the sensitivity itself in place of $M_s$; and by which "
    "factor the paper's formula, which is in Table 4, overestimates it.",
    labels={
        **{f"abs_Gf_m{m}": f"$|G_f(i\\omega_0)|$, $m = {m}$" for m in RECOMMENDED},
        **{f"arg_Gf_m{m}": f"$\\arg G_f(i\\omega_0)$, $m = {m}$" for m in RECOMMENDED},
        **{f"Tf_m{m}": f"$T_f$, $m = {m}$" for m in FINITE},
        **{f"sigma_S_m{m}": f"$\\sigma$ with $|S|$, $m = {m}$" for m in FINITE},
        **{f"excess_m{m}": f"overestimated, $m = {m}$" for m in FINITE},
        "zeta": "$\\zeta$",
        "value": "Value",
    },
)

END = 30000.0  # rad per unit time; the tail beyond it is below 1e-10 of the whole
PANEL = 1.0
POINTS = 12


def true_sigma(case: Filtered) -> float:
    """Return the standard deviation of the control signal with the sensitivity itself, by quadrature.

    For |S| = 1 the variance has the paper's closed form; what is integrated is the difference, ``|S|^2 - 1``.
    """
    k, ki = case.found.k, case.found.ki
    loop = Loop(case.plant, PI(k, ki))
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    edges = np.concatenate([np.arange(0.0, 10.0, 0.1), np.arange(10.0, END + PANEL, PANEL)])
    half, middle = 0.5 * np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
    s = 1j * (middle[:, None] + half[:, None] * nodes)
    # the controller's integrator meets the zero of the noise model
    transfer = (k * s + ki) / ((s + NOISE_CORNER) * (1.0 + s * case.filter_time))
    difference = np.abs(transfer) ** 2 * (np.abs(1.0 / (1.0 + loop(s))) ** 2 - 1.0)
    correction = float(np.sum((difference @ weights) * half)) / math.pi
    return math.sqrt((case.sigma / MS) ** 2 + NOISE_DENSITY * correction)


@example_8.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Evaluate the filter and the noise."""
    values: dict[str, float] = {}
    for m in RECOMMENDED:
        response = 1.0 / (1.0 + 1j / m)  # (2) at w0 with (26)
        values[f"abs_Gf_m{m}"] = abs(response)
        values[f"arg_Gf_m{m}"] = math.degrees(cmath.phase(response))
    for name, factor in FINITE.items():
        case = filtered(factor)
        sigma = true_sigma(case)
        values |= {
            f"Tf_m{name}": case.filter_time,
            f"sigma_S_m{name}": sigma,
            f"excess_m{name}": case.sigma / sigma,
        }
    return example_8.frame({"zeta": math.nan, **values})

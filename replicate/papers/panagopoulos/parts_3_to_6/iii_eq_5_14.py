"""III, (12) to (14): the gamma contour, its marked points, and the circles that enclose it and that it encloses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.parts_3_to_6.loop_shaping import (
    CONTOURS,
    combined_circle,
    contour,
    contour_points,
    distances,
    gamma_at,
    gamma_of_m,
    m_of_gamma,
)

if TYPE_CHECKING:
    import pandas as pd

DECIMALS = 12

formulas = paper.table(
    "III-eq-5-14",
    "The $\\gamma$ contour and its circles",
    kind="formula",
    printed=False,
    rows=tuple(f"{gamma:g}" for gamma in CONTOURS),
    columns=(
        "residual", "OA", "OB", "OC", "OD", "AC", "OB_OD", "phase_A", "M", "gamma_back", "outside", "touch_re",
        "touch_im", "M_inner", "inside",
    ),
    labels={
        "residual": "$\\max|\\gamma(L)/\\gamma - 1|$",
        "OB_OD": "$OB\\cdot OD$",
        "phase_A": "$\\arg A$ (deg)",
        "M": "$M(\\gamma)$",
        "gamma_back": "$\\gamma(M(\\gamma))$",
        "outside": "farthest outside",
        "touch_re": "touches at Re",
        "touch_im": "Im",
        "M_inner": "$M$ of inner circle",
        "inside": "deepest inside",
    },
    caption="For the contours of Figure 5: how well points of $r(\\varphi)$ satisfy $(1+|L|)/|1+L| = \\gamma$; the "
    "marked points; the combined circle of $M(\\gamma)$, by how much the contour leaves it (relative to its "
    "radius) and where it touches; and the combined circle of $(\\gamma+1)/2$ through $B$ and $D$, with how far "
    "the contour enters it.",
)  # fmt: skip


@formulas.reading(
    "as-written",
    "Contour with the $-1$ under the root",
    note="The print shows $\\sqrt{(\\cdot)^2} - 1$; with the $-1$ outside the root the points do not lie on the "
    "contour.",
)
def as_written() -> pd.DataFrame:
    """Evaluate the contour formulas for every gamma of Figure 5."""
    rows = {}
    for gamma in CONTOURS:
        curve, points = contour(gamma), contour_points(gamma)
        m = float(m_of_gamma(gamma))
        circle = combined_circle(m)
        distance = np.abs(curve + circle.center) / circle.radius
        # the distance is flat there: of all points that are the farthest, up to rounding, the contour's first, A
        touch = curve[np.argmax(distance >= distance.max() - 10.0**-DECIMALS)]
        inner_m = 0.5 * (gamma + 1.0)
        inner = combined_circle(inner_m)
        # what is zero up to rounding is shown as zero
        rows[f"{gamma:g}"] = [
            round(float(np.max(np.abs(gamma_at(curve) / gamma - 1.0))), DECIMALS),
            round(float(abs(touch)), DECIMALS),
            points.ob, points.oc, points.od, points.ac, points.ob * points.od,
            float(np.degrees(points.phase_of_a)),
            m, float(gamma_of_m(m)),
            round(distances(gamma, circle)[1] - 1.0, DECIMALS) + 0.0,
            float(touch.real), float(abs(touch.imag)),
            inner_m,
            round(1.0 - distances(gamma, inner)[0], DECIMALS) + 0.0,
        ]  # fmt: skip
    return formulas.frame(rows)

r"""The promise "the minimum distance equals the specified value", put to the test.

The repeated root of (5) is :math:`\omega^2 = -KK_p/(T_i q)`: the Nyquist curve of the design loop (3)
touches the circle of radius y around -1 only if q < 0. Table 1 uses q > 0.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from replicate.loops import PI, Loop, Plant
from replicate.papers.ali import paper
from replicate.papers.ali.sensitivities import exact_peak
from replicate.papers.ali.structures import Settings, series
from replicate.papers.ali.tuning import (
    Branch,
    gain_product,
    integral_time,
    specified_sensitivity,
    tangency_frequency,
)

if TYPE_CHECKING:
    import pandas as pd

BRANCHES: tuple[Branch, Branch] = ("printed", "tangency")


def design_loop(x: Fraction, branch: Branch) -> Loop:
    """Return the loop (3), for which the design was made: no filter, the 1/1 Padé zero, its pole cancelled."""
    theta, gain = float(x), gain_product(x)
    return Loop(Plant([-theta / 2.0, 1.0], [1.0, -1.0]), PI.from_integral_time(gain, integral_time(x, branch)))


def true_peak(x: Fraction, branch: Branch) -> float:
    """Return Ms of the controller (2) with the exact dead time."""
    settings = Settings(gain_product(x), integral_time(x, branch), float(x / 2))
    return exact_peak(float(x), series(settings))


tangency = paper.table(
    "tangency",
    "The specified distance, with the printed and with the true tangency",
    printed=False,
    rows=tuple(str(float(Fraction(tenths, 10))) for tenths in range(1, 11)),
    columns=(
        "Ms_star",
        "Ti",
        "Ms_design",
        "Ms",
        "Ti_tangency",
        "Ms_design_tangency",
        "Ms_tangency",
        "w_tangency",
    ),
    caption="Rows: $\\theta/T$, with $KK_p = \\sqrt{2T/\\theta}$. $M_s^*$ is what the user specifies. Left: the "
    "printed $T_i$ ($q > 0$) and the maximum of $|S|$ that it gives in the design loop (3) and, with the "
    "controller (2) and the exact dead time, in truth. Right: the same for the $T_i$ of the true tangency ($q < "
    "0$), with the frequency at which the design loop touches the circle.",
    labels={
        "Ms_star": "$M_s^*$",
        "Ti": "$T_i$",
        "Ms_design": "in (3)",
        "Ms": "true",
        "Ti_tangency": "$T_i$, $q<0$",
        "Ms_design_tangency": "in (3)",
        "Ms_tangency": "true",
        "w_tangency": "$\\omega T$",
    },
)


@tangency.reading(
    "as-written",
    "Both signs of $q$",
    note="With the printed $T_i$, $|S|$ of the design loop only approaches its supremum $1/(1 - "
    "\\sqrt{\\theta/2T})$ as $\\omega \\to \\infty$; there is no tangency. In row 0.5, $q = 0$ and both "
    "coincide, with the tangency at infinity.",
)
def compute() -> pd.DataFrame:
    """Compute settings and sensitivities for both signs of q."""
    rows = {}
    for row in tangency.rows:
        x = Fraction(row)
        values = [float(specified_sensitivity(x))]
        for branch in BRANCHES:
            values += [
                integral_time(x, branch),
                design_loop(x, branch).sensitivity_peak().value,
                true_peak(x, branch),
            ]
        rows[row] = [*values, tangency_frequency(x)]
    return tangency.frame(rows)

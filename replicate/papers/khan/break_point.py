"""The break point K_b = 1/(h e^{1+ph}) against the exact double pole and against visible overshoot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq
from scipy.special import lambertw

from replicate.papers.khan import paper
from replicate.papers.khan.sweep import overshoot, stability_limit

if TYPE_CHECKING:
    import pandas as pd

VISIBLE = (0.01, 0.1, 1.0)  # overshoot, in per cent

breakpoint_table = paper.table(
    "breakpoint",
    "Break point and first visible overshoot",
    printed=False,
    caption="$K_b h$ by the paper's formula; the gain at which the two rightmost poles, "
    "$s h = -ph + W(-Kh\\,e^{ph})$ on the branches 0 and $-1$, coincide; the gains at which the overshoot reaches "
    "0.01, 0.1 and 1 per cent.",
    labels={"formula": "$K_b h$", "double_pole": "double pole", "visible_0.01": "0.01 %", "visible_0.1": "0.1 %",
            "visible_1": "1 %"},
)  # fmt: skip

PH = (0.0, 0.5, 1.0, 2.0, 5.0, 10.0)


def double_pole(ph: float) -> float:
    """Return the gain at which the two rightmost poles meet, from the branches of Lambert's W."""

    def gap(log_kh: float) -> float:
        argument = -np.exp(log_kh + ph)
        pair = lambertw(argument, 0) - lambertw(argument, -1)
        return float(pair.real) if abs(pair.imag) < 1e-9 else -float(abs(pair.imag))

    return float(np.exp(brentq(gap, -ph - 3.0, -ph + 1.0, xtol=1e-15)))


def visible(ph: float, percent: float) -> float:
    """Return the gain at which the overshoot reaches a level."""
    top = 0.9 * stability_limit(ph)
    return float(brentq(lambda kh: overshoot(ph, kh) - percent, np.exp(-1.0 - ph), top, xtol=1e-10))


@breakpoint_table.reading("as-written", "Formula, double pole, visible overshoot")
def compare() -> pd.DataFrame:
    """Compare the three."""
    rows = {
        f"ph={ph:g}": {
            "formula": float(np.exp(-1.0 - ph)),
            "double_pole": double_pole(ph),
            **{f"visible_{level:g}": visible(ph, level) for level in VISIBLE},
        }
        for ph in PH
    }
    return breakpoint_table.frame(rows)

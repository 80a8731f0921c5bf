"""Example 5: the oscillatory plant; when the envelope has a corner, and the extreme case without damping."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from replicate.loops import PI, Loop, design_pi
from replicate.papers.panagopoulos import paper
from replicate.papers.panagopoulos.part_1.corner import (
    corner_limit,
    curvature_limit,
    largest_sensitivity,
    slope_limit,
)
from replicate.papers.panagopoulos.part_1.plants import PLANTS

if TYPE_CHECKING:
    import pandas as pd

MS = 2.0
EXTREME = "G12 a=0.0"
EXTREME_MS = 1.4

example_5 = paper.table(
    "I-example-5",
    "An oscillatory plant, $G_{12}$",
    kind="example",
    rows=(
        "zeta_G6",
        "a_corner",
        "a_corner_1.8",
        "a_corner_1.6",
        "a_corner_1.4",
        "a_slope",
        "a_curvature",
        "Ms_at_a_slope",
        "k_a0",
        "ki_a0",
        "b_a0",
        "w1_a0",
        "w2_a0",
        "Ms_of_printed_gains",
    ),
    columns=("value",),
    caption="Three different limits for $a$. From $a_{corner}$ on the root of (18) is the optimum, below it "
    "the optimum is a corner; it depends on $M_s$. At $a_{slope}$ the largest slope of $|G|$ is 1, the limit "
    "of condition (20); this is the printed number, and the root of (18) for $M_s = 2$ violates the "
    "constraint there. Down to $a_{curvature}$ the local condition (19) holds, so it does not reveal this either.",
    labels={
        "zeta_G6": "$\\zeta$ of $G_6$",
        "a_corner": "$a_{corner}$, $M_s = 2$",
        **{f"a_corner_{ms}": f"$a_{{corner}}$, $M_s = {ms}$" for ms in (1.8, 1.6, 1.4)},
        "a_slope": "$a_{slope}$",
        "a_curvature": "$a_{curvature}$, $M_s = 2$",
        "Ms_at_a_slope": "$\\max|S|$ at $a_{slope}$",
        "k_a0": "$k$, $a = 0$",
        "ki_a0": "$k_i$, $a = 0$",
        "b_a0": "$b$, $a = 0$",
        "w1_a0": "$\\omega_1$, $a = 0$",
        "w2_a0": "$\\omega_2$, $a = 0$",
        "Ms_of_printed_gains": "$M_s$ of the printed gains",
        "value": "Value",
    },
)


def _values(a_corner: float, ms: float) -> pd.DataFrame:
    found = design_pi(PLANTS[EXTREME], ms=ms)
    gains = (paper.printed_numbers("I-example-5")[row, "value"] for row in ("k_a0", "ki_a0"))
    resonance = PLANTS["G6"].poles()
    resonance = resonance[resonance.imag > 0.0][0]
    return example_5.frame(
        {
            "zeta_G6": -resonance.real / abs(resonance),
            "a_corner": a_corner,
            **{f"a_corner_{bound}": corner_limit(bound) for bound in (1.8, 1.6, 1.4)},
            "a_slope": slope_limit(),
            "a_curvature": curvature_limit(MS),
            "Ms_at_a_slope": largest_sensitivity(slope_limit(), MS),
            "k_a0": found.k,
            "ki_a0": found.ki,
            "b_a0": found.b,
            "w1_a0": found.frequencies[0],
            "w2_a0": found.frequencies[-1],
            "Ms_of_printed_gains": Loop(PLANTS[EXTREME], PI(*gains)).sensitivity_peak().value,
        }
    )


@example_5.reading("as-written", "As written")
def as_written() -> pd.DataFrame:
    """Compute the limit at which the optimum becomes a corner, and the extreme design for Ms = 1.4."""
    return _values(corner_limit(MS), EXTREME_MS)


@example_5.reading(
    "authors",
    "The slope limit of (20), and $M_s = \\sqrt{2}$",
    note="The printed $a$ is the limit of condition (20), not of the corner; the printed gains for $a = 0$ "
    "are the optimum for $M_s = \\sqrt{2}$, which the text rounds to 1.4.",
    tried={"limit of $a$": 2, "$M_s$ for $a = 0$": 2},
)
def authors() -> pd.DataFrame:
    """Compute what the printed numbers are."""
    return _values(slope_limit(), math.sqrt(2.0))

"""The worked example 3.1: every number printed in it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exclusion import Box, Ends, Rule
from replicate.loops import PI, Loop
from replicate.loops.bounds.gain_boxes import NOTHING, GainBox
from replicate.loops.bounds.intervals import Interval, exactly
from replicate.loops.bounds.response_boxes import ResponseBox, setpoint_errors
from replicate.papers.khan import paper
from replicate.papers.khan.fits import overshoot_fit
from replicate.papers.khan.processes import plant
from replicate.papers.khan.sweep import sweep

if TYPE_CHECKING:
    import pandas as pd

ROWS_31 = ("L_IB", "L_PB", "Bryant_tr", "Bryant_ts", "L_IH", "L_PH", "Haalman_overshoot", "Haalman_tr", "Haalman_ts",
           "overshoot_K0.28", "L_P", "K")  # fmt: skip

H = 1.82  # dead time
TAU = 0.6
GAIN = 0.28  # K of the cancelled loop, as printed

example_3_1 = paper.table(
    "example-3-1",
    "Bryant, Haalman and a gain for 5 % overshoot, $\\tau = 0.6$, $h = 1.82$",
    kind="example",
    rows=ROWS_31,
    columns=("value",),
    caption="Rise time from 10 % to 90 %, settling to 2 %, in seconds; overshoot in per cent.",
    labels={
        "L_IB": "$L_{IB}$", "L_PB": "$L_{PB}$", "L_IH": "$L_{IH}$", "L_PH": "$L_{PH}$", "L_P": "$L_P = 0.28\\,\\tau$",
        "Bryant_tr": "Bryant $t_r$", "Bryant_ts": "Bryant $t_s$", "Haalman_overshoot": "Haalman overshoot (%)",
        "Haalman_tr": "Haalman $t_r$", "Haalman_ts": "Haalman $t_s$", "overshoot_K0.28": "overshoot for $K = 0.28$ (%)",
        "K": "$K$",
    },
)  # fmt: skip


def _example_3_1(overshoot: float) -> pd.DataFrame:
    tau = TAU
    integral = 1.0 / tau
    gain_bryant, gain_haalman = 0.368 * tau / H, 2.0 / 3.0 * tau / H
    # L_P (1 + 1/(tau s)) e^{-hs}/(tau s + 1) = (L_P/tau) e^{-hs}/s: the zero cancels the pole (6)
    bryant, haalman = (Loop(plant(0.0, H), PI(g / tau)).step() for g in (gain_bryant, gain_haalman))
    values = [
        integral, gain_bryant, bryant.rise_time(), bryant.settling_time(), integral, gain_haalman,
        100.0 * haalman.overshoot(), haalman.rise_time(), haalman.settling_time(), overshoot, GAIN * tau, math.nan,
    ]  # fmt: skip
    return example_3_1.frame(dict(zip(ROWS_31, values, strict=True)))


@example_3_1.reading("as-written", "exact")
def example_3_1_exact() -> pd.DataFrame:
    """Compute everything with the exact response."""
    return _example_3_1(float(sweep(0.0, np.array([GAIN * H])).overshoot[0]))


@example_3_1.reading("formulas", "overshoot for $K = 0.28$ by case I of (2)")
def example_3_1_formulas() -> pd.DataFrame:
    """Take the overshoot from the fit."""
    return _example_3_1(overshoot_fit(0.0, GAIN * H))


def _errors(box: Box, gain: str) -> ResponseBox | None:
    return setpoint_errors(plant(0.0, H), GainBox(Interval(*box[gain]) / exactly(TAU), NOTHING))


def _settles_otherwise(gain: str) -> Rule:
    def rule(_: str, box: Box, ends: Ends) -> bool:
        errors = _errors(box, gain)
        return errors is not None and errors.never_settles_between(*ends, 0.02)

    return rule


def _rises_otherwise(gain: str) -> Rule:
    def rule(_: str, box: Box, ends: Ends) -> bool:
        errors = _errors(box, gain)
        return errors is not None and not (errors.first_below(0.1) - errors.first_below(0.9)).meets(*ends)

    return rule


@example_3_1.reading(
    "printed-gain",
    "for the printed gains",
    "What $K$ rounds to 0.28 is open, and so are $L_P$ and the exact overshoot, and the responses for all gains that "
    "round to the printed $L_{PB}$ and $L_{PH}$.",
    inputs=("K", "L_PB", "L_PH"),
    rules_out={
        "Bryant_ts": _settles_otherwise("L_PB"),
        "Haalman_ts": _settles_otherwise("L_PH"),
        "Bryant_tr": _rises_otherwise("L_PB"),
    },
)
def from_printed_gain(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Compute what follows from the printed gains."""
    overshoot = float(sweep(0.0, np.array([given["K"] * H])).overshoot[0])
    bryant, haalman = (Loop(plant(0.0, H), PI(given[name] / TAU)).step() for name in ("L_PB", "L_PH"))
    return {
        "Bryant_tr": bryant.rise_time(),
        "Bryant_ts": bryant.settling_time(),
        "Haalman_overshoot": 100.0 * haalman.overshoot(),
        "Haalman_tr": haalman.rise_time(),
        "Haalman_ts": haalman.settling_time(),
        "overshoot_K0.28": overshoot,
        "L_P": given["K"] * TAU,
    }

"""The worked examples 2.1, 2.2 and 2.3: every number printed in them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits.exclusion import Box, Ends, Rule
from replicate.exhibits.near import Near
from replicate.loops.bounds.intervals import Interval, exactly, exponential
from replicate.papers.khan import paper
from replicate.papers.khan.fits import case_4_parts, overshoot_fit, rise_time_fit, rise_time_parts
from replicate.papers.khan.sweep import stability_limit, sweep

if TYPE_CHECKING:
    import pandas as pd

ROWS_21 = ("ph", "A1", "B1", "overshoot_estimate", "overshoot_actual", "overshoot_error", "A2", "B2", "C2", "D2",
           "tr_estimate", "tr_actual")  # fmt: skip
H = 1.82  # dead time of example 2.1
P = "p=1.6667"
# The cells of the printed coefficients of each part of (2), case IV, and of (3).
COEFFICIENTS = {
    part: tuple(f"refit-coefficients:{row}:x{place}" for place in range(4))
    for part, row in (
        ("A1", "case-4 A"), ("B1", "case-4 B"),
        ("A2", "rise-time A"), ("B2", "rise-time B"), ("C2", "rise-time C"), ("D2", "rise-time D"),
    )
}  # fmt: skip

example_2_1 = paper.table(
    "example-2-1",
    "Estimates and true values for $p = 1.6667$, $K = 1$, $h = 1.82$",
    kind="example",
    rows=ROWS_21,
    columns=("value",),
    caption="Overshoot in per cent of $y_{ss}$, its error in percentage points; rise time in seconds.",
    labels={
        "ph": "$ph$", "A1": "$A_1$", "B1": "$B_1$", "A2": "$A_2$", "B2": "$B_2$", "C2": "$C_2$", "D2": "$D_2$",
        "overshoot_estimate": "overshoot, estimate (%)", "overshoot_actual": "overshoot, exact (%)",
        "overshoot_error": "error (points)", "tr_estimate": "$t_r$, estimate", "tr_actual": "$t_r$, exact",
    },
)  # fmt: skip


def _example_2_1(p: float) -> pd.DataFrame:
    ph = p * H
    exact = sweep(ph, np.array([H]))
    a1, b1 = case_4_parts(ph)
    estimate = overshoot_fit(ph, H)
    parts = [float(part) for part in rise_time_parts(ph)]
    values = [ph, a1, b1, estimate, float(exact.overshoot[0]), float(exact.overshoot[0]) - estimate, *parts,
              H * float(rise_time_fit(ph, H)), H * float(exact.rise_time[0])]  # fmt: skip
    return example_2_1.frame(dict(zip(ROWS_21, values, strict=True)))


@example_2_1.reading("as-written", "$p = 1.6667$, as the example says")
def example_2_1_as_written() -> pd.DataFrame:
    """Evaluate with the printed p."""
    return _example_2_1(1.6667)


@example_2_1.reading(
    "p-1.667", "$p = 1.667$", "The printed $ph = 3.03394$ is $1.667 \\times 1.82$: one digit of $p$ fewer."
)
def example_2_1_three_digits() -> pd.DataFrame:
    """Evaluate with p rounded once more."""
    return _example_2_1(1.667)


@example_2_1.reading("p-5-3", "$p = 5/3$", "The time constant 0.6 of Example 3.1 gives $p = 5/3$.")
def example_2_1_fraction() -> pd.DataFrame:
    """Evaluate with p = 1/0.6."""
    return _example_2_1(5.0 / 3.0)


def _part_of_box(name: str, box: Box) -> Interval:
    """Return an interval that holds one part of (2) or (3) for all coefficients of a box."""
    a, b, c, d = (Interval(*box[place]) for place in COEFFICIENTS[name])
    ph = Interval(*box[P]) * exactly(H)
    return a + b * ph + c * exponential(ph / d if name in {"A1", "B1"} else ph * d)


def _estimates_of_parts(parts: Mapping[str, Interval]) -> dict[str, Interval]:
    """Return intervals that hold the estimates, as `last_step`."""
    h = exactly(H)
    rise = parts["A2"] * exponential(-h / parts["B2"]) + parts["C2"] * exponential(-h / parts["D2"])
    return {"overshoot_estimate": parts["A1"] + parts["B1"] * h, "tr_estimate": h * rise}


def _rules(quantities: Callable[[Box], Mapping[str, Interval]], names: Iterable[str]) -> dict[str, Rule]:
    """Return rules for quantities whose intervals over a box are known."""

    def rule(name: str) -> Rule:
        def misses(_: str, box: Box, ends: Ends) -> bool:
            return not quantities(box)[name].meets(*ends)

        return misses

    return {name: rule(name) for name in names}


def _of_coefficients(box: Box) -> dict[str, Interval]:
    parts = {name: _part_of_box(name, box) for name in COEFFICIENTS}
    return {"ph": Interval(*box[P]) * exactly(H)} | parts | _estimates_of_parts(parts)


def _of_parts(box: Box) -> dict[str, Interval]:
    return _estimates_of_parts({name: Interval(*box[name]) for name in COEFFICIENTS})


@example_2_1.reading(
    "printed-coefficients",
    "any coefficients of (2) and (3) that round to the printed ones",
    "The authors had their fits with more digits than they print. $p$ is any number that rounds to 1.6667, such as "
    "5/3.",
    inputs=(P, *(place for places in COEFFICIENTS.values() for place in places)),
    rules_out=_rules(_of_coefficients, ("ph", *COEFFICIENTS, "overshoot_estimate", "tr_estimate")),
)
def example_2_1_from_coefficients(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Evaluate (2) and (3) with other coefficients."""
    ph = given[P] * H
    parts = {}
    for name, places in COEFFICIENTS.items():
        a, b, c, d = (given[place] for place in places)
        # the last coefficient divides ph in (2) and multiplies it in (3)
        parts[name] = a + b * ph + c * math.exp(ph / d if name in {"A1", "B1"} else ph * d)
    return {"ph": ph} | parts | last_step(parts)


@example_2_1.reading(
    "printed-parts",
    "from the example's own intermediate values",
    "$t_r$ and the overshoot from the coefficients that the example prints, to see whether its last step is right.",
    inputs=("A1", "B1", "A2", "B2", "C2", "D2"),
    rules_out=_rules(_of_parts, ("overshoot_estimate", "tr_estimate")),
)
def example_2_1_from_print(_: str, given: Mapping[str, float]) -> dict[str, float]:
    """Take the last step of the example with its printed intermediate values."""
    return last_step(given)


def last_step(parts: Mapping[str, float]) -> dict[str, float]:
    """Return the estimates from the coefficients of the example, for K = 1."""
    return {
        "overshoot_estimate": parts["A1"] + parts["B1"] * H,
        "tr_estimate": H * (parts["A2"] * math.exp(-H / parts["B2"]) + parts["C2"] * math.exp(-H / parts["D2"])),
    }


example_2_2 = paper.table(
    "example-2-2",
    "Stability limit for $p = h = 1$",
    kind="example",
    rows=("K_max",),
    columns=("value",),
    caption="The gain at which the closed loop of $e^{-hs}/(s+p)$ begins to oscillate without end.",
    labels={"K_max": "$K_{max}$"},
)


@example_2_2.reading("as-written", "$\\cos wh = -p/K$, $\\sin wh = w/K$")
def example_2_2_as_written() -> pd.DataFrame:
    """Solve the two equations."""
    return example_2_2.frame({"K_max": stability_limit(1.0)})


example_2_3 = paper.table(
    "example-2-3",
    "A gain for a rise time of one second, $p = h = 1$",
    kind="example",
    rows=("Kh", "tr", "overshoot"),
    columns=("value",),
    caption="The gain for which $t_r$ is exactly one second; rise time and overshoot of the printed gain 0.375. "
    "The paper reads all three off its figures, as approximate values.",
    near=Near(fraction=0.02),  # what can be read off a figure
    labels={"Kh": "$Kh$ for $t_r = 1$", "tr": "$t_r$ at $Kh = 0.375$", "overshoot": "overshoot at $Kh = 0.375$ (%)"},
)


@example_2_3.reading("as-written", "exact")
def example_2_3_exact() -> pd.DataFrame:
    """Compute with the exact response."""
    from scipy.optimize import brentq

    gain = brentq(lambda k: float(sweep(1.0, np.array([k])).rise_time[0]) - 1.0, 0.2, 0.6, xtol=1e-13)
    at = sweep(1.0, np.array([0.375]))
    values = [gain, float(at.rise_time[0]), float(at.overshoot[0])]
    return example_2_3.frame(dict(zip(example_2_3.rows, values, strict=True)))


@example_2_3.reading("formulas", "with the fits (2) and (3)", "The 'more precise estimates' that the text mentions.")
def example_2_3_formulas() -> pd.DataFrame:
    """Compute with the paper's fits."""
    from scipy.optimize import brentq

    gain = brentq(lambda k: float(rise_time_fit(1.0, k)) - 1.0, 0.2, 0.6, xtol=1e-13)
    values = [gain, float(rise_time_fit(1.0, 0.375)), overshoot_fit(1.0, 0.375)]
    return example_2_3.frame(dict(zip(example_2_3.rows, values, strict=True)))

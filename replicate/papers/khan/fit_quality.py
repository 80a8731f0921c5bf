"""How good the fits (2) and (3) are, on a dense grid of stable loops with exact metrics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from replicate.exhibits import Table
from replicate.exhibits.extrema import largest
from replicate.papers.khan import paper
from replicate.papers.khan.fits import (
    CASES,
    cases_of,
    complex_below,
    fit_of_case,
    overshoot_fits,
    positive_from,
    rise_time_fit,
)
from replicate.papers.khan.sweep import Sweep, dense, stability_limit, sweep

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]

PH_2 = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0, 7.0, 10.0)
PH_3 = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0, 6.0, 7.0, 8.0, 10.0)
USUAL = 0.95  # of the stability limit

LABELS = {
    "n": "loops", "r2": "$r^2$", "rms": "rms", "worst": "worst", "worst_ph": "at $ph$", "worst_Kh": "at $Kh$",
}  # fmt: skip

eq_2 = paper.table(
    "eq-2",
    "Quality of the overshoot fit (2)",
    kind="formula",
    printed=False,
    caption="Estimate minus exact overshoot, in percentage points, over a dense grid of stable loops: by case, then "
    "for single values of $ph$. $r^2$ is the coefficient of determination. At $ph = 0.5$ and 3, where two cases meet, "
    "the first is taken.",
    labels=LABELS,
)
eq_3 = paper.table(
    "eq-3",
    "Quality of the rise-time fit (3)",
    kind="formula",
    printed=False,
    caption="Estimate minus exact rise time; rms and worst relative to the exact one, in per cent. $r^2$ is that of "
    "$t_r/h$ itself.",
    labels=LABELS,
)
edges = paper.table(
    "case-edges",
    "Where the cases of (2) meet, and what they miss",
    kind="formula",
    printed=False,
    columns=("value", "ph", "Kh"),
    caption="Jumps: the largest difference of two neighbouring cases on their common edge, in percentage points, and "
    "where. Then three gains: below the first $M$ is complex, up to the second it is negative (both mean an estimate "
    "of zero), and from 1.5 to the third, the stability limit, no case applies. Last, the share of the stability "
    "limit from which a later peak is higher than the first, which the fit follows.",
    labels={"value": "value", "ph": "at $ph$", "Kh": "at $Kh$"},
)


def quality(estimate: Array, exact: Array, loops: Sweep, scale: Array | float = 1.0) -> dict[str, float]:
    """Return size, r^2, rms and worst error with its place; the errors in units of the scale."""
    error = estimate - exact
    relative = error / scale
    worst = int(np.argmax(np.abs(relative)))
    r2 = 1.0 - float(np.sum(error**2) / np.sum((exact - exact.mean()) ** 2))
    return {
        "n": exact.size,
        "r2": r2,
        "rms": float(np.sqrt(np.mean(relative**2))),
        "worst": float(relative[worst]),
        "worst_ph": float(loops.ph[worst]),
        "worst_Kh": float(loops.kh[worst]),
    }


def _overshoot(loops: Sweep, *, first_peak: bool = False) -> pd.DataFrame:
    cases = cases_of(loops.ph, loops.kh)
    exact = loops.first_peak if first_peak else loops.overshoot
    estimate = overshoot_fits(loops.ph, loops.kh)
    masks = {f"Case {case}": cases == case for case in CASES} | {"all cases": cases != ""}
    masks |= {f"ph = {ph:g}": (loops.ph == ph) & (cases != "") for ph in PH_2}
    return _by_mask(eq_2, masks, estimate, exact, loops)


def _by_mask(
    table: Table,
    masks: Mapping[str, NDArray[np.bool_]],
    estimate: Array,
    exact: Array,
    loops: Sweep,
    *,
    relative: bool = False,
) -> pd.DataFrame:
    rows = {}
    for name, mask in masks.items():
        scale = exact[mask] / 100.0 if relative else 1.0
        rows[name] = quality(estimate[mask], exact[mask], loops.where(mask), scale)
    return table.frame(rows)


def usual() -> Sweep:
    """Return the loops of the dense grid with gains up to 0.95 of the stability limit."""
    return dense().where(dense().share <= USUAL + 1e-9)


@eq_2.reading(
    "as-written",
    "the highest value, gains to 0.99 of the limit",
    "$M_P$ is the maximum of the output, as section II-A defines it; $Kh$ from 0.01 to 0.99 of the stability limit.",
)
def overshoot_quality() -> pd.DataFrame:
    """Compare the fit of the overshoot with the exact one on the whole grid."""
    return _overshoot(dense())


@eq_2.reading(
    "first-peak",
    "the first peak, gains to 0.99 of the limit",
    "For large $ph$ and gains within a few per cent of the stability limit a later peak is the highest. The fit "
    "follows the first.",
)
def first_peak_quality() -> pd.DataFrame:
    """Compare with the first peak."""
    return _overshoot(dense(), first_peak=True)


@eq_2.reading("up-to-95", "the highest value, gains to 0.95 of the limit", "Here the first peak is the highest.")
def usual_quality() -> pd.DataFrame:
    """Compare away from the stability limit."""
    return _overshoot(usual())


def _rise_time(loops: Sweep) -> pd.DataFrame:
    masks = {"0.5 <= ph <= 10": loops.ph >= 0.5} | {f"ph = {ph:g}": loops.ph == ph for ph in PH_3}
    return _by_mask(eq_3, masks, rise_time_fit(loops.ph, loops.kh), loops.rise_time, loops, relative=True)


@eq_3.reading("as-written", "gains to 0.99 of the limit", "$Kh$ from 0.01 to 0.99 of the stability limit.")
def rise_time_quality() -> pd.DataFrame:
    """Compare the fit of the rise time with the exact one on the whole grid."""
    return _rise_time(dense())


@eq_3.reading(
    "from-20-to-95", "gains from 0.2 to 0.95 of the limit", "Without the small gains, for which the response is slow."
)
def usual_rise_time_quality() -> pd.DataFrame:
    """Compare away from both ends."""
    return _rise_time(usual().where(usual().share >= 0.2 - 1e-9))


@edges.reading("as-written", "As printed")
def compare_edges() -> pd.DataFrame:
    """Compare neighbouring cases along their common edges, and list what is left out."""
    rows: dict[str, tuple[float, float, float]] = {}
    for cases, start, end in (
        (("I", "II"), (0.0, 0.7), (0.5, 0.7)),
        (("I", "III"), (0.5, 0.0), (0.5, 0.7)),
        (("II", "III"), (0.5, 0.7), (0.5, 1.5)),
        (("III", "IV"), (3.0, 0.0), (3.0, 0.99 * stability_limit(3.0))),
    ):
        rows[f"jump {cases[0]}/{cases[1]}"] = largest_jump(cases, start, end)
    for ph_value in (0.0, 0.25, 0.5):
        gains = {
            "M complex below": complex_below(ph_value),
            "M negative below": positive_from(ph_value),
            "no case above 1.5 to": stability_limit(ph_value),
        }
        rows |= {f"{name}, ph = {ph_value:g}": (gain, ph_value, gain) for name, gain in gains.items()}
    for ph_value in (3.0, 5.0, 7.0, 10.0):
        share = _later_peak_from(ph_value)
        rows[f"later peak higher from, ph = {ph_value:g}"] = (share, ph_value, share * stability_limit(ph_value))
    return edges.frame(rows)


def largest_jump(
    cases: tuple[str, str], start: tuple[float, float], end: tuple[float, float]
) -> tuple[float, float, float]:
    """Return the largest difference of two cases on the edge between two points (ph, Kh), and where it is.

    The second case minus the first, in percentage points; an estimate below zero, or a complex one, is zero. The
    estimates have kinks where they reach zero, so the edge is bracketed finely before the maximum is found.
    """

    def place(t: Array | float) -> tuple[Array | float, Array | float]:
        return start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])

    def jump(t: Array | float) -> Array:
        first, second = (fit_of_case(case, *place(t)) for case in cases)
        return np.asarray(second - first)

    grid = np.linspace(0.0, 1.0, 2001)
    t, _ = largest(lambda t: abs(jump(t)), grid, np.abs(jump(grid)))
    ph, kh = place(t)
    return float(jump(t)), float(ph), float(kh)


def _later_peak_from(ph: float) -> float:
    """Return the share of the stability limit, to 1e-4, from which a later peak is the highest."""
    low, high = 0.9, 0.999
    while high - low > 1e-4:
        shares = np.linspace(low, high, 24)
        found = sweep(ph, shares * stability_limit(ph))
        first = int(np.argmax(found.overshoot > found.first_peak + 1e-9))
        low, high = float(shares[max(first - 1, 0)]), float(shares[first])
    return round(high, 4)

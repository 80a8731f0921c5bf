"""How good the fits (2) and (3) are, on a dense grid of stable loops with exact metrics."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from replicate.papers.khan import paper
from replicate.papers.khan.fits import CASES, case_of, m_of_case, overshoot_fit, rise_time_fit
from replicate.papers.khan.sweep import Sweep, dense, stability_limit

Array = NDArray[np.float64]

PH_ROWS = (0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0)
LABELS = {
    "n": "loops", "r2": "$r^2$", "rms": "rms", "worst": "worst", "worst_ph": "at $ph$", "worst_Kh": "at $Kh$",
}  # fmt: skip

eq_2 = paper.table(
    "eq-2",
    "Quality of the overshoot fit (2)",
    kind="formula",
    printed=False,
    caption="Estimate minus exact overshoot, in percentage points, over stable loops with $Kh$ up to 0.95 of the "
    "stability limit: by case, then by bands of $ph$. $r^2$ is the coefficient of determination.",
    labels=LABELS,
)
eq_3 = paper.table(
    "eq-3",
    "Quality of the rise-time fit (3)",
    kind="formula",
    printed=False,
    caption="Estimate minus exact rise time, relative to the exact one in per cent for rms and worst; $r^2$ is that of "
    "$t_r/h$ itself. Loops with $0.5 \\le ph \\le 10$ and $Kh$ up to 0.95 of the stability limit.",
    labels=LABELS,
)
eq_2_edges = paper.table(
    "case-edges",
    "Where the cases of (2) meet, and what they leave out",
    kind="formula",
    printed=False,
    caption="Largest difference of two neighbouring cases where both hold, in percentage points; where $M$ is complex; "
    "which stable gains no case covers.",
)


def summary(estimate: Array, exact: Array, ph: Array, kh: Array, scale: Array | float = 1.0) -> dict[str, float]:
    """Return size, r^2, rms and worst error with its place."""
    error = estimate - exact
    relative = error / scale
    worst = int(np.argmax(np.abs(relative)))
    r2 = 1.0 - float(np.sum(error**2) / np.sum((exact - exact.mean()) ** 2))
    return {
        "n": exact.size,
        "r2": r2,
        "rms": float(np.sqrt(np.mean(relative**2))),
        "worst": float(relative[worst]),
        "worst_ph": float(ph[worst]),
        "worst_Kh": float(kh[worst]),
    }


def table_of(sweeps: Sequence[Sweep]) -> tuple[Array, Array, Array, Array]:
    """Return ph, Kh, overshoot and rise time of all loops, flat."""
    ph = np.concatenate([np.full(s.kh.size, s.ph) for s in sweeps])
    return (
        ph,
        np.concatenate([s.kh for s in sweeps]),
        np.concatenate([s.overshoot for s in sweeps]),
        np.concatenate([s.rise_time for s in sweeps]),
    )


def _bands() -> list[tuple[str, float, float]]:
    edges = [0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0]
    return [(f"ph {low:g}..{high:g}", low, high) for low, high in pairwise(edges)]


@eq_2.reading("as-written", "Case by case, Max[0, M]")
def overshoot_quality() -> pd.DataFrame:
    """Compare the fit of the overshoot with the exact one."""
    ph, kh, exact, _ = table_of(dense(52, 200))
    cases = np.array([case_of(a, b) or "" for a, b in zip(ph, kh, strict=True)])
    estimate = np.array([overshoot_fit(a, b) for a, b in zip(ph, kh, strict=True)])
    rows = {f"Case {case}": _part(cases == case, estimate, exact, ph, kh) for case in CASES}
    covered = cases != ""
    rows["all cases"] = _part(covered, estimate, exact, ph, kh)
    for name, low, high in _bands():
        rows[name] = _part(covered & (ph >= low) & (ph <= high), estimate, exact, ph, kh)
    return pd.DataFrame.from_dict(rows, orient="index")


@eq_3.reading("as-written", "(3) as printed")
def rise_time_quality() -> pd.DataFrame:
    """Compare the fit of the rise time with the exact one."""
    ph, kh, _, exact = table_of(dense(52, 200))
    valid = ph >= 0.5
    estimate = rise_time_fit(ph, kh)
    rows = {"0.5 <= ph <= 10": _part(valid, estimate, exact, ph, kh, relative=True)}
    for name, low, high in _bands()[2:]:
        rows[name] = _part(valid & (ph >= low) & (ph <= high), estimate, exact, ph, kh, relative=True)
    for value in (5.0, 10.0):
        nearest = ph[np.argmin(np.abs(ph - value))]
        rows[f"ph = {nearest:g}"] = _part(ph == nearest, estimate, exact, ph, kh, relative=True)
    frame = pd.DataFrame.from_dict(rows, orient="index")
    frame[["rms", "worst"]] *= 100.0
    return frame


def _part(
    mask: NDArray[np.bool_], estimate: Array, exact: Array, ph: Array, kh: Array, *, relative: bool = False
) -> dict[str, float]:
    scale = exact[mask] if relative else 1.0
    return summary(estimate[mask], exact[mask], ph[mask], kh[mask], scale)


@eq_2_edges.reading("as-written", "As printed")
def edges() -> pd.DataFrame:
    """Compare neighbouring cases along their common edges."""
    rows: dict[str, dict[str, float]] = {}
    for (first, second), ph, kh in (
        (("I", "II"), np.linspace(0.0, 0.5, 101), np.full(101, 0.7)),
        (("I", "III"), np.full(101, 0.5), np.linspace(0.0, 0.7, 101)),
        (("II", "III"), np.full(101, 0.5), np.linspace(0.7, 1.5, 101)),
        (("III", "IV"), np.full(101, 3.0), np.linspace(0.0, 0.95 * stability_limit(3.0), 101)),
    ):
        a, b = (np.maximum(np.nan_to_num(m_of_case(case, ph, kh)), 0.0) for case in (first, second))
        worst = int(np.argmax(np.abs(a - b)))
        rows[f"jump {first}/{second}"] = {
            "value": float(a[worst] - b[worst]),
            "ph": float(ph[worst]),
            "Kh": float(kh[worst]),
        }
    for ph_value in (0.0, 0.25, 0.5):
        rows[f"M complex below, ph={ph_value:g}"] = {
            "value": _complex_below(ph_value),
            "ph": ph_value,
            "Kh": _complex_below(ph_value),
        }
        limit = stability_limit(ph_value)
        rows[f"not covered from 1.5 to, ph={ph_value:g}"] = {"value": limit, "ph": ph_value, "Kh": limit}
    return pd.DataFrame.from_dict(rows, orient="index")


def _complex_below(ph: float) -> float:
    """Return the gain below which case I takes the power of a negative number."""
    kh = np.linspace(0.0, 0.7, 70001)
    return float(kh[np.isnan(m_of_case("I", ph, kh))].max(initial=0.0))

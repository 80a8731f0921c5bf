"""The paper's forms fitted anew to exact data, and one smooth formula for the whole range."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares

from replicate.papers.khan import paper
from replicate.papers.khan.fit_quality import summary, table_of
from replicate.papers.khan.fits import CASES, Coefficients, case_of, m_of_case, printed_coefficients, rise_time_fit
from replicate.papers.khan.sweep import dense

Array = NDArray[np.float64]

refit = paper.table(
    "refit",
    "The same forms fitted to exact data",
    printed=False,
    caption="Least-squares fits on stable loops with $Kh$ up to 0.95 of the limit. $r^2$ and worst error of the "
    "overshoot cases in percentage points; of the rise time in per cent. Below, the coefficients one by one.",
    labels={
        "r2_paper": "$r^2$, paper", "r2_refit": "$r^2$, refit", "worst_paper": "worst, paper",
        "worst_refit": "worst, refit",
        "paper": "paper", "refit": "refit",
    },
)  # fmt: skip
better = paper.table(
    "better-fit",
    "One smooth formula for the overshoot, $0 \\le ph \\le 10$",
    printed=False,
    caption="$M = B r + q r^2$ with the soft ramp $r = w \\ln\\left(1 + e^{(Kh - k)/w}\\right)$, "
    "$B = b_0 + b_1 e^{-ph/b_2} + b_3\\,ph$ and $k$, $w$, $q$ of the form $x_0 + x_1 e^{-ph/x_2}$: no cases, no "
    "complex "
    "values, no jumps. Errors in percentage points.",
    labels={"value": "value"},
)
BETTER_START = (15.0, 60.0, 2.4, -0.6, -0.1, 0.6, 4.0, 0.1, -0.07, 0.5, 0.0, 14.0, 0.3)
BETTER_NAMES = ("b0", "b1", "b2", "b3", "k0", "k1", "k2", "w0", "w1", "w2", "q0", "q1", "q2")


# The data determine the coefficients of case III, four exponentials in one another's way, to fewer digits.
DETERMINED = {"case-3": 2}


def significant(value: float, digits: int) -> float:
    """Round to a number of significant digits: more would differ between machines."""
    return float(f"{value:.{digits}g}")


def better_formula(x: Array, ph: Array, kh: Array) -> Array:
    """Evaluate the smooth formula, in per cent."""
    slope = _decay(x[0:3], ph) + x[3] * ph
    corner, curvature = _decay(x[4:7], ph), _decay(x[10:13], ph)
    width = np.maximum(_decay(x[7:10], ph), 1e-4)
    ramp = width * np.logaddexp(0.0, (kh - corner) / width)
    return np.asarray(slope * ramp + curvature * ramp**2)


def _decay(x: Array, ph: Array) -> Array:
    return np.asarray(x[0] + x[1] * np.exp(-ph / x[2]))


@cache
def data() -> tuple[Array, Array, Array, Array]:
    """Return ph, Kh, overshoot and rise time of the loops that the fits use."""
    return table_of(dense(36, 60))


@cache
def fitted_better() -> tuple[Array, dict[str, float]]:
    """Return coefficients and quality of the smooth formula."""
    ph, kh, exact, _ = data()

    def error(x: Array) -> Array:
        return better_formula(x, ph, kh) - exact

    found = least_squares(error, np.array(BETTER_START), x_scale="jac", max_nfev=4000)
    return found.x, summary(better_formula(found.x, ph, kh), exact, ph, kh)


def _flat(c: Coefficients, case: str) -> Array:
    part = c[case]
    keys = {"case-1": ["offset", "a", "b", "c", "d", "e", "f"], "case-2": ["constant", "slope"]}.get(case, list("ABCD"))
    return np.concatenate([np.atleast_1d(part[key]) for key in keys if key in part])


def _with(c: Coefficients, case: str, x: Array) -> Coefficients:
    part = c[case]
    if case == "case-1":
        new: dict[str, object] = dict(zip(["offset", "a", "b", "c", "d", "e", "f"], x.tolist(), strict=True))
    else:
        keys = ["constant", "slope"] if case == "case-2" else [k for k in "ABCD" if k in part]
        size = len(part[keys[0]])
        new = {key: x[i * size : (i + 1) * size].tolist() for i, key in enumerate(keys)}
    return c | {case: new}


@cache
def refitted() -> dict[str, tuple[Array, Array, dict[str, float], dict[str, float]]]:
    """Return, by case, printed and refitted coefficients and their qualities."""
    ph, kh, overshoot, rise = data()
    cases = np.array([case_of(a, b) or "" for a, b in zip(ph, kh, strict=True)])
    printed = printed_coefficients()
    result = {}
    for number, case in enumerate(CASES, 1):
        mask = cases == case
        result[f"case-{number}"] = _fit(
            f"case-{number}", printed, partial(_clipped, case, ph[mask], kh[mask]),
            overshoot[mask], ph[mask], kh[mask], 1.0,
        )  # fmt: skip
    mask = ph >= 0.5
    result["rise-time"] = _fit(
        "rise-time", printed, partial(rise_time_fit, ph[mask], kh[mask]), rise[mask], ph[mask], kh[mask],
        rise[mask] / 100.0,
    )  # fmt: skip
    return result


def _clipped(case: str, ph: Array, kh: Array, c: Coefficients) -> Array:
    return np.maximum(np.nan_to_num(m_of_case(case, ph, kh, c)), 0.0)


def _fit(
    case: str, printed: Coefficients, evaluate: Callable[[Coefficients], Array], exact: Array, ph: Array, kh: Array,
    scale: Array | float,
) -> tuple[Array, Array, dict[str, float], dict[str, float]]:  # fmt: skip
    start = _flat(printed, case)

    def residual(x: Array) -> Array:
        with np.errstate(all="ignore"):
            return np.nan_to_num((evaluate(_with(printed, case, x)) - exact) / scale, nan=1e6, posinf=1e6, neginf=-1e6)

    found = least_squares(residual, start, x_scale="jac", max_nfev=3000, ftol=1e-15, xtol=1e-14, gtol=1e-15)
    return (
        start,
        found.x,
        summary(evaluate(printed), exact, ph, kh, scale),
        summary(evaluate(_with(printed, case, found.x)), exact, ph, kh, scale),
    )


@refit.reading("as-written", "Least squares on exact data")
def compare() -> pd.DataFrame:
    """List quality and coefficients beside the paper's."""
    rows: dict[str, dict[str, float]] = {}
    for case, (_, _, old, new) in refitted().items():
        rows[case] = {
            "r2_paper": old["r2"], "r2_refit": round(new["r2"], 8),
            "worst_paper": old["worst"], "worst_refit": significant(new["worst"], 4),
        }  # fmt: skip
    for case, (start, found, _, _) in refitted().items():
        for index, (a, b) in enumerate(zip(start, found, strict=True), 1):
            digits = DETERMINED.get(case, 3)
            rows[f"{case} coefficient {index}"] = {"paper": float(a), "refit": significant(float(b), digits)}
    return pd.DataFrame.from_dict(rows, orient="index")


@better.reading("as-written", "Least squares on exact data")
def show_better() -> pd.DataFrame:
    """List coefficients and quality of the smooth formula."""
    x, quality = fitted_better()
    rows = dict(zip(BETTER_NAMES, (significant(float(v), 5) for v in x), strict=True))
    rows |= {"coefficients": float(x.size), "r2": quality["r2"], "rms": quality["rms"], "worst": quality["worst"],
             "worst_ph": quality["worst_ph"], "worst_Kh": quality["worst_Kh"]}  # fmt: skip
    return pd.DataFrame({"value": rows})

"""The paper's forms fitted anew to exact data, and one smooth formula for the whole range."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import least_squares

from replicate.papers.khan import paper
from replicate.papers.khan.fit_quality import quality, usual
from replicate.papers.khan.fits import (
    CASE_1,
    CASES,
    Coefficients,
    cases_of,
    fit_of_case,
    printed_coefficients,
    rise_time_fit,
)
from replicate.papers.khan.smooth import smooth_overshoot
from replicate.papers.khan.sweep import Sweep

Array = NDArray[np.float64]

NAMES = {"case-1": "case I", "case-2": "case II", "case-3": "case III", "case-4": "case IV", "rise-time": "rise time"}
PARTS = {
    "case-1": ("amplitude", "shift"), "case-2": ("constant", "slope"), "case-3": tuple("ABCD"), "case-4": tuple("AB"),
    "rise-time": tuple("ABCD"),
}  # fmt: skip
SIZES = {"case-1": (4, 3), "case-2": (3, 3), "case-3": (4,) * 4, "case-4": (4,) * 2, "rise-time": (4,) * 4}

refit = paper.table(
    "refit",
    "The same forms fitted to exact data",
    printed=False,
    caption="Least-squares fits on the stable loops with $Kh$ up to 0.95 of the limit. Errors are in percentage points "
    "for the overshoot cases, in per cent of the exact value for the rise time. The rise time is fitted by its "
    "relative error, for which $r^2$ may fall even as the errors do: for the absolute error the best coefficients "
    "of the printed form grow without bound.",
    labels=NAMES
    | {
        "n": "loops",
        "r2_paper": "$r^2$, paper",
        "r2_refit": "refit",
        "rms_paper": "rms, paper",
        "rms_refit": "refit ",
        "worst_paper": "worst, paper",
        "worst_refit": "refit  ",
    },
)
coefficients = paper.table(
    "refit-coefficients",
    "The coefficients of the fits, printed and refitted",
    rows=tuple(f"{case} {part}" for case, parts in PARTS.items() for part in parts),
    columns=tuple(f"x{k}" for k in range(4)),
    caption="The coefficients of each function of $ph$, as printed and as refitted to three digits. Case I: "
    "$x_0 + (x_1 + x_2 e^{-ph/x_3})$ in the amplitude, $x_0 + x_1 e^{-ph/x_2}$ in the shift. Case II: polynomials. "
    "Cases III and IV: $x_0 + x_1\\,ph + x_2 e^{ph/x_3}$; for the rise time $e^{x_3 ph}$.",
    labels={f"{case} {part}": f"{NAMES[case]}: {part}" for case, parts in PARTS.items() for part in parts}
    | {f"x{k}": f"$x_{k}$" for k in range(4)},
)
better = paper.table(
    "better-fit",
    "One smooth formula for the overshoot, $0 \\le ph \\le 10$",
    printed=False,
    caption="$M = w \\ln(1 + e^{F/w})$ with the closed form $F(ph, Kh)$ of the first peak and the width "
    "$w = a\\,e^{-b\\,ph}(x e^{-x})^n$, $x = Kh\\,e^{ph}$, in which $a$, $b$ and $n$ are fitted. No cases, no complex "
    "values, no jumps. Errors in percentage points, on the loops with $Kh$ up to 0.95 of the stability limit; beside "
    "it the paper's four cases on the same loops, where they apply.",
    labels={"smooth": "smooth formula", "paper": "paper, (2)", "worst": "worst error", "rms": "rms error",
            "r2": "$r^2$", "n": "loops", "worst_ph": "at $ph$", "worst_Kh": "at $Kh$",
            "coefficients": "fitted coefficients"},
)  # fmt: skip

START = (171.0, 2.73, 2.87)


def significant(value: float, digits: int) -> float:
    """Round to a number of significant digits: more would differ between machines."""
    return float(f"{value:.{digits}g}")


@cache
def smooth_coefficients() -> tuple[float, float, float]:
    """Return a, b and n, fitted to the exact overshoot and rounded to four digits, as they are published here."""
    loops = usual()

    def error(x: Array) -> Array:
        return smooth_overshoot(loops.ph, loops.kh, (x[0], x[1], x[2])) - loops.overshoot

    found = least_squares(error, np.array(START), x_scale="jac", ftol=1e-14, xtol=1e-14, gtol=1e-14)
    a, b, n = (significant(float(value), 4) for value in found.x)
    return a, b, n


@better.reading("as-written", "Least squares on exact data")
def show_better() -> pd.DataFrame:
    """List coefficients and quality of the smooth formula beside those of the paper's four cases."""
    loops = usual()
    cases = cases_of(loops.ph, loops.kh)
    estimate = np.zeros(loops.ph.size)
    for case in CASES:
        mask = cases == case
        estimate[mask] = _clipped(case, loops.where(mask), printed_coefficients())
    covered = cases != ""
    size = sum(_flat(printed_coefficients(), f"case-{number}").size for number in range(1, 5))
    a, b, n = smooth_coefficients()
    columns = {
        "smooth": quality(smooth_overshoot(loops.ph, loops.kh, (a, b, n)), loops.overshoot, loops)
        | {"coefficients": 3.0, "a": a, "b": b, "exponent": n},
        "paper": quality(estimate[covered], loops.overshoot[covered], loops.where(covered))
        | {"coefficients": float(size)},
    }
    order = ["coefficients", "n", "r2", "rms", "worst", "worst_ph", "worst_Kh", "a", "b", "exponent"]
    return pd.DataFrame(columns).reindex(order)


def _flat(c: Coefficients, case: str) -> Array:
    part = c[case]
    keys = CASE_1 if case == "case-1" else tuple(part)
    return np.concatenate([np.atleast_1d(part[key]) for key in keys])


def _with(c: Coefficients, case: str, x: Array) -> Coefficients:
    if case == "case-1":
        new: dict[str, object] = dict(zip(CASE_1, x.tolist(), strict=True))
    else:
        parts = np.split(x, len(c[case]))
        new = {key: part.tolist() for key, part in zip(c[case], parts, strict=True)}
    return c | {case: new}


def _clipped(case: str, loops: Sweep, c: Coefficients) -> Array:
    return fit_of_case(case, loops.ph, loops.kh, c)


def _rise_time(loops: Sweep, c: Coefficients) -> Array:
    return rise_time_fit(loops.ph, loops.kh, c)


def _slopes_3(parts: tuple[Array, ...], kh: Array) -> tuple[Array, ...]:
    """Return the derivatives of A + B Kh + C e^(D Kh), clipped at zero, with respect to A, B, C, D."""
    a, b, c, d = parts
    power = np.exp(d * kh)
    shown = np.where(a + b * kh + c * power > 0.0, 1.0, 0.0)
    return shown, shown * kh, shown * power, shown * c * kh * power


def _slopes_rise(parts: tuple[Array, ...], kh: Array) -> tuple[Array, ...]:
    """Return the derivatives of A e^(-Kh/B) + C e^(-Kh/D) with respect to A, B, C, D."""
    a, b, c, d = parts
    fast, slow = np.exp(-kh / b), np.exp(-kh / d)
    return fast, a * kh / b**2 * fast, slow, c * kh / d**2 * slow


Slopes = Callable[[tuple[Array, ...], Array], tuple[Array, ...]]
_SLOPES: dict[str, tuple[Slopes, bool]] = {"case-3": (_slopes_3, False), "rise-time": (_slopes_rise, True)}


def _jacobian(slopes: tuple[Slopes, bool], part: dict[str, list[float]], loops: Sweep) -> Array:
    """Return the Jacobian of a form in A, B, C, D, each x0 + x1 ph + x2 e^(ph/x3), or e^(x3 ph) for a rate."""
    slope, rate = slopes
    values, columns = [], []
    for x in part.values():
        power = np.exp(loops.ph * x[3] if rate else loops.ph / x[3])
        last = x[2] * loops.ph * power * (1.0 if rate else -1.0 / x[3] ** 2)
        values.append(x[0] + x[1] * loops.ph + x[2] * power)
        columns.append((np.ones(loops.ph.size), loops.ph, power, last))
    outer = slope(tuple(values), loops.kh)
    return np.stack([o * c for o, inner in zip(outer, columns, strict=True) for c in inner], axis=1)


Fit = tuple[Array, Array, dict[str, float], dict[str, float]]


@cache
def refitted() -> dict[str, Fit]:
    """Return, by case, printed and refitted coefficients and their qualities."""
    loops = usual()
    cases = cases_of(loops.ph, loops.kh)
    result = {}
    for number, case in enumerate(CASES, 1):
        some = loops.where(cases == case)
        result[f"case-{number}"] = _fit(f"case-{number}", partial(_clipped, case, some), some.overshoot, some)
    some = loops.where(loops.ph >= 0.5)
    result["rise-time"] = _fit("rise-time", partial(_rise_time, some), some.rise_time, some, relative=True)
    return result


def _fit(
    case: str, evaluate: Callable[[Coefficients], Array], exact: Array, loops: Sweep, *, relative: bool = False
) -> Fit:
    """Fit one form by least squares of the absolute or the relative error.

    Raises
    ------
    ValueError
        If the iteration does not converge.
    """
    printed = printed_coefficients()
    start = _flat(printed, case)
    scale = exact / 100.0 if relative else np.ones_like(exact)

    def residual(x: Array) -> Array:
        with np.errstate(all="ignore"):
            error = (evaluate(_with(printed, case, x)) - exact) / scale
            return np.nan_to_num(error, nan=1e6, posinf=1e6, neginf=-1e6)

    slopes = _SLOPES.get(case)

    def jacobian(x: Array) -> Array:
        assert slopes is not None  # noqa: S101  -- passed on only then
        return _jacobian(slopes, _with(printed, case, x)[case], loops) / scale[:, None]

    found = least_squares(
        residual, start, jac=jacobian if slopes else "2-point", method="lm", x_scale=np.abs(start),
        ftol=1e-9, xtol=1e-9, gtol=1e-9,
    )  # fmt: skip
    if not found.success:
        msg = f"{case}: {found.message}"
        raise ValueError(msg)
    return (
        start,
        found.x,
        quality(evaluate(printed), exact, loops, scale),
        quality(evaluate(_with(printed, case, found.x)), exact, loops, scale),
    )


@refit.reading("as-written", "Least squares on exact data")
def compare() -> pd.DataFrame:
    """List the quality beside the paper's."""
    rows: dict[str, dict[str, float]] = {}
    for case, (_, _, old, new) in refitted().items():
        rows[case] = {"n": old["n"]} | {
            f"{name}_{who}": significant(values[name], 4) if name != "r2" else round(values[name], 6)
            for name in ("r2", "rms", "worst")
            for who, values in (("paper", old), ("refit", new))
        }
    return refit.frame(rows)


@coefficients.reading("as-written", "Least squares on exact data")
def compare_coefficients() -> pd.DataFrame:
    """List the refitted coefficients, one function of ph per row."""
    rows: dict[str, dict[str, float]] = {}
    for case, (_, found, _, _) in refitted().items():
        parts = np.split(found, np.cumsum(SIZES[case])[:-1])
        for name, part in zip(PARTS[case], parts, strict=True):
            rows[f"{case} {name}"] = {f"x{k}": significant(float(x), 3) for k, x in enumerate(part)}
    return coefficients.frame(rows)

"""How good the hyperbola of Table 1 is, and why one of its columns cannot be a least-squares fit."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.loci import upper_end
from replicate.papers.krajewski.table_1 import (
    DECIMALS,
    MARGINS,
    hyperbola,
    hyperbola_fit,
    printed_coefficients,
    upper_ends,
)

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = ("b_u_error", "b_u_error_at", "omega_error", "omega_error_at", "r_squared")

table_1_errors = paper.table(
    "table-1-errors",
    "How good the hyperbola of Table 1 is",
    printed=False,
    rows=MARGINS,
    columns=COLUMNS,
    caption="The largest relative error of (22) on $0.1 \\le \\tau \\le 1$, with its sign, in $b_u$ and "
    "in the crossover frequency $\\omega_A^u$ that (21) derives from it, and the $\\tau$ where it occurs. "
    "Where (22) gives $b_u < 1$, (21) has no real value and the error is that of $\\omega_A^u = 0$. $R^2$ "
    "on the ten fitted points is what makes the fit look good.",
    labels={
        "b_u_error": "largest error of $b_u$",
        "b_u_error_at": "at $\\tau$",
        "omega_error": "largest error of $\\omega_A^u$",
        "omega_error_at": "at $\\tau$",
        "r_squared": "$R^2$",
        **{margin: f"{margin}°" for margin in MARGINS},
    },
)


class Extreme(NamedTuple):
    """The value of largest magnitude of a function of τ, and where it is."""

    value: float
    tau: float


def largest_error(error: Callable[[float], float]) -> Extreme:
    """Return the largest |error| on 0.1 <= τ <= 1, end points included."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(TAUS[0], TAUS[-1], 181)
    values = np.array([error(tau) for tau in grid])
    best = Extreme(float(values[np.argmax(np.abs(values))]), float(grid[np.argmax(np.abs(values))]))
    for i in np.flatnonzero(
        (np.abs(values[1:-1]) >= np.abs(values[:-2])) & (np.abs(values[1:-1]) >= np.abs(values[2:]))
    ):
        found = minimize_scalar(
            lambda tau: -abs(error(tau)), bounds=(grid[i], grid[i + 2]), method="bounded", options={"xatol": 1e-12}
        )
        if -found.fun > abs(best.value):
            best = Extreme(error(float(found.x)), float(found.x))
    return best


def crossover_at(b: float) -> float:
    """Return ω_A on the b axis, (21)."""
    return float(np.sqrt(max(b * b - 1.0, 0.0)))


@cache
def errors(margin: str, coefficients: tuple[float, float]) -> tuple[Extreme, Extreme]:
    """Return the largest relative errors of b_u and of ω_A^u for coefficients (μ, ν)."""

    def of_b(tau: float) -> float:
        return float(hyperbola(coefficients, tau)) / upper_end(tau, float(margin)) - 1.0

    def of_omega(tau: float) -> float:
        estimate = crossover_at(float(hyperbola(coefficients, tau)))
        return estimate / crossover_at(upper_end(tau, float(margin))) - 1.0

    return largest_error(of_b), largest_error(of_omega)


def r_squared(margin: str, coefficients: tuple[float, float]) -> float:
    """Return the coefficient of determination on the ten points."""
    exact = upper_ends(margin)
    residuals = hyperbola(coefficients, TAUS) - exact
    return float(1.0 - residuals @ residuals / np.sum((exact - exact.mean()) ** 2))


def _table(coefficients: Callable[[str], tuple[float, float]]) -> pd.DataFrame:
    rows = {}
    for margin in MARGINS:
        pair = coefficients(margin)
        of_b, of_omega = errors(margin, pair)
        rows[margin] = [*of_b, *of_omega, r_squared(margin, pair)]
    return table_1_errors.frame(rows)


@table_1_errors.reading("as-written", "Coefficients as printed")
def of_the_print() -> pd.DataFrame:
    """Errors of the printed coefficients."""
    return _table(printed_coefficients)


@table_1_errors.reading("least-squares", "Coefficients recomputed")
def of_the_fit() -> pd.DataFrame:
    """Errors of the least-squares coefficients."""
    return _table(lambda margin: hyperbola_fit(upper_ends(margin)))


SUMS = ("sum", "sum_over_tau", "sum_allowed", "sign_changes")

table_1_residuals = paper.table(
    "table-1-residuals",
    "Is it a least-squares fit?",
    printed=False,
    rows=(*(f"{tau:g}" for tau in TAUS), *SUMS),
    columns=MARGINS,
    caption="Residuals of Table 1 as printed, $\\mu/\\tau + \\nu - b_u$. The residuals $r$ of a "
    "least-squares fit satisfy $\\sum r = 0$ and $\\sum r/\\tau = 0$. For the printed coefficients, "
    "rounded to four decimals, the first sum can be off by no more than the third row from below. The "
    "residuals must also change sign at least twice: with one change at $\\tau_0$, all terms of $\\sum "
    "r\\,(1/\\tau - 1/\\tau_0)$ have the same sign. This holds for every choice of weights, so the column "
    "of 45 degrees is not a least-squares fit of the right data whatever the weights were.",
    labels={
        **{f"{tau:g}": f"$\\tau = {tau:g}$" for tau in TAUS},
        "sum": "$\\sum r$",
        "sum_over_tau": "$\\sum r/\\tau$",
        "sum_allowed": "$|\\sum r|$ from rounding, at most",
        "sign_changes": "sign changes",
        **{margin: f"{margin}°" for margin in MARGINS},
    },
)


def residuals(margin: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return printed hyperbola minus exact b_u on the ten points."""
    return np.asarray(hyperbola(printed_coefficients(margin), TAUS) - upper_ends(margin))


def sign_changes(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> int:
    """Return how often consecutive values differ in sign."""
    return int(np.count_nonzero(np.diff(np.sign(values))))


@table_1_residuals.reading("as-written", "Printed minus exact")
def residual_table() -> pd.DataFrame:
    """Tabulate the residuals and what they sum to."""
    import pandas as pd

    inverse = 1.0 / np.array(TAUS)
    allowed = 0.5 * 10.0**-DECIMALS * (inverse.sum() + len(TAUS))
    columns = {}
    for margin in MARGINS:
        r = residuals(margin)
        columns[margin] = [*r, r.sum(), r @ inverse, allowed, sign_changes(r)]
    return pd.DataFrame(columns, index=list(table_1_residuals.rows))


def single_digit_slips(margin: str) -> list[tuple[float, str, str]]:
    """Return which single wrong digit in the ten values of b_u gives both printed coefficients.

    The values are taken to four decimals, like the print.

    Returns
    -------
    list
        (τ, right value, value with the wrong digit), in the order of τ.
    """
    exact = upper_ends(margin)
    printed = np.array(printed_coefficients(margin))
    found = []
    for i, tau in enumerate(TAUS):
        right = f"{exact[i]:.{DECIMALS}f}"
        for place, digit in enumerate(right):
            for wrong in "0123456789" if digit != "." else "":
                text = right[:place] + wrong + right[place + 1 :]
                data = np.round(exact, DECIMALS)
                data[i] = float(text)
                off = np.abs(np.array(hyperbola_fit(data)) - printed)
                if wrong != digit and np.all(off <= 0.5 * 10.0**-DECIMALS):
                    found.append((tau, right, text))
    return found

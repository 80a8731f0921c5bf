"""Table 1: the hyperbola (22) that approximates the upper end of the phase margin curves."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.loci import upper_end

if TYPE_CHECKING:
    import pandas as pd

MARGINS = ("30", "45", "60", "75", "90", "120")  # degrees
COEFFICIENTS = ("mu", "nu")
DECIMALS = 4  # of the printed coefficients
LABELS = {"mu": "$\\mu$", "nu": "$\\nu$", **{margin: f"{margin}°" for margin in MARGINS}}

table_1 = paper.table(
    "table-1",
    "Coefficients of the hyperbola (22)",
    rows=COEFFICIENTS,
    columns=MARGINS,
    caption="$b_u \\approx \\mu/\\tau + \\nu$ for the upper end $b_u$ of the curve of a phase margin "
    "(columns), where the highest compatible crossover frequency is $\\sqrt{b_u^2 - 1}$ (21).",
    labels=LABELS,
)


def upper_ends(margin: str) -> NDArray[np.float64]:
    """Return b_u for τ = 0.1, 0.2, ..., 1."""
    return np.array([upper_end(tau, float(margin)) for tau in TAUS])


def hyperbola_fit(ends: ArrayLike) -> tuple[float, float]:
    """Return the least-squares coefficients (μ, ν) of (22) for b_u at τ = 0.1, 0.2, ..., 1."""
    matrix = np.column_stack([1.0 / np.array(TAUS), np.ones(len(TAUS))])
    solution = np.linalg.lstsq(matrix, np.asarray(ends, dtype=float), rcond=None)[0]
    return float(solution[0]), float(solution[1])


def hyperbola(coefficients: tuple[float, float], tau: ArrayLike) -> NDArray[np.float64]:
    """Evaluate (22)."""
    mu, nu = coefficients
    return np.asarray(mu / np.asarray(tau, dtype=float) + nu)


def printed_coefficients(margin: str) -> tuple[float, float]:
    """Return (μ, ν) as the paper prints them."""
    printed = paper.printed_numbers("table-1")
    return printed["mu", margin], printed["nu", margin]


def _frame(fits: Iterable[tuple[float, float]]) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(dict(zip(MARGINS, fits, strict=True)), index=list(COEFFICIENTS))


@table_1.reading(
    "as-written",
    "Least squares",
    note="“Mean square values”: $b_u$ fitted by least squares, all points with the same weight, on $\\tau "
    "= 0.1, 0.2, \\ldots, 1$, the dead times of the charts. The paper does not state the points; these "
    "give its columns for 30, 60, 90 and 120 degrees.",
)
def as_written() -> pd.DataFrame:
    """Fit the exact ends."""
    return _frame(hyperbola_fit(upper_ends(margin)) for margin in MARGINS)


@table_1.reading(
    "four-decimals",
    "Least squares on four decimals",
    note="The same fit, but on $b_u$ rounded to the four decimals that the table itself prints.",
)
def four_decimals() -> pd.DataFrame:
    """Fit the ends rounded to the printed number of decimals."""
    return _frame(hyperbola_fit(np.round(upper_ends(margin), DECIMALS)) for margin in MARGINS)

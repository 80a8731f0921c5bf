"""Equation (11): the cubic that was fitted to the integral times, refitted; and how far it is from its own data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from replicate.exhibits import AS_WRITTEN
from replicate.papers.ali import paper
from replicate.papers.ali.tuning import cubic, integral_time

if TYPE_CHECKING:
    import pandas as pd

COEFFICIENTS = ("cubic", "quadratic", "linear", "constant")
ROWS = tuple(str(float(Fraction(tenths, 10))) for tenths in range(1, 11))


def printed_integral_times() -> dict[str, float]:
    """Return the ten printed Ti by theta/T: nine from Table 1, the last from Table 2."""
    texts = {**paper.printed_cells("table-2"), **paper.printed_cells("table-1")}
    return {row: float(texts[row, "Ti"]) for row in ROWS}


def exact_integral_times() -> dict[str, float]:
    """Return the ten unrounded Ti by theta/T."""
    return {row: integral_time(Fraction(row)) for row in ROWS}


def printed_coefficients() -> tuple[float, float, float, float]:
    """Return the coefficients of (11) as printed."""
    texts = paper.printed_cells("eq-11")
    a, b, c, d = (float(texts[row, "coefficient"]) for row in COEFFICIENTS)
    return a, b, c, d


def fit(data: dict[str, float], rows: Sequence[str] = ROWS) -> tuple[float, float, float, float]:
    """Return the least-squares cubic through the given rows, descending powers."""
    a, b, c, d = np.polyfit([float(row) for row in rows], [data[row] for row in rows], 3).tolist()
    return a, b, c, d


eq_11 = paper.table(
    "eq-11",
    "The cubic (11), refitted",
    kind="formula",
    rows=COEFFICIENTS,
    columns=("coefficient",),
    caption="Least-squares cubic in $\\theta/T$ for $T_i/T$. (11) is printed for $T_i$; it holds for $T = 1$.",
    labels={
        "cubic": "$(\\theta/T)^3$",
        "quadratic": "$(\\theta/T)^2$",
        "linear": "$\\theta/T$",
        "constant": "1",
        "coefficient": "Coefficient",
    },
)

_FITS: tuple[tuple[str, str, Callable[[], tuple[float, float, float, float]], str], ...] = (
    (
        AS_WRITTEN,
        "The ten printed $T_i$",
        lambda: fit(printed_integral_times()),
        "Fitted to the integral times as printed, nine from Table 1 and that of row 1.0 from Table 2.",
    ),
    (
        "exact-data",
        "Ten unrounded $T_i$",
        lambda: fit(exact_integral_times()),
        "Fitted to the same ten integral times with all digits.",
    ),
    (
        "table-1-only",
        "The nine $T_i$ of Table 1",
        lambda: fit(printed_integral_times(), ROWS[:-1]),
        "Fitted without row 1.0 of Table 2.",
    ),
)
for _id, _title, _fit, _note in _FITS:

    def _compute(found: Callable[[], tuple[float, float, float, float]] = _fit) -> pd.DataFrame:
        import pandas as pd

        return pd.DataFrame({"coefficient": found()}, index=list(COEFFICIENTS))

    eq_11.reading(_id, _title, _note)(_compute)


eq_11_error = paper.table(
    "cubic-error",
    "The cubic (11) against its own data",
    printed=False,
    rows=ROWS,
    columns=("Ti_data", "Ti_cubic", "error"),
    caption="Rows: $\\theta/T$. The integral times that (11) was fitted to, those that it gives, and its "
    "relative error.",
    labels={"Ti_data": "$T_i$, data", "Ti_cubic": "$T_i$, (11)", "error": "relative error"},
)


def _errors(data: dict[str, float], coefficients: tuple[float, float, float, float]) -> pd.DataFrame:
    rows = {row: [data[row], value := cubic(float(row), coefficients), value / data[row] - 1.0] for row in ROWS}
    return eq_11_error.frame(rows)


@eq_11_error.reading("as-written", "(11) as printed, against the printed $T_i$")
def error_as_printed() -> pd.DataFrame:
    """Compare (11) as printed with the printed data."""
    return _errors(printed_integral_times(), printed_coefficients())


@eq_11_error.reading(
    "exact-data",
    "Refitted to the unrounded $T_i$, against the unrounded $T_i$",
    note="The best cubic is little better: the data have a step between 0.5 and 0.6, because $M_s^*$ moves "
    "in steps of 0.1.",
)
def error_refitted() -> pd.DataFrame:
    """Compare the cubic refitted to unrounded data with those data."""
    return _errors(exact_integral_times(), fit(exact_integral_times()))

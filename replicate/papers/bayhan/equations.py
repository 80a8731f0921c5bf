"""Equations (14) and (20) to (27): the pole assignment, evaluated exactly for the paper's three processes."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from replicate.loops.tune import Number
from replicate.papers.bayhan import paper
from replicate.papers.bayhan.pole_assignment import (
    Assignment,
    assign,
    assigned,
    c1_in_copy,
    characteristic,
    dominance_of,
    match_coefficients,
)
from replicate.papers.bayhan.processes import EXAMPLE_41, EXAMPLE_42, PT326, Process, trials

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = {"example-4-1": EXAMPLE_41, "example-4-2": EXAMPLE_42, "pt326": PT326}

equations = paper.table(
    "eq-21-24",
    "The pole assignment formulas",
    kind="formula",
    printed=False,
    rows=("Kp", "Ki", "c0", "c1", "s3", "margin_1", "margin_0", "root", "slope"),
    columns=tuple(COLUMNS),
    caption="Gains (21), (22) and residue polynomial (23), (24) for the paper's processes and choices of "
    "$a$, in exact rational arithmetic; the coefficient of $s^3$ in (20); the two margins of condition "
    "(27), both of which must be positive; and value and slope of the characteristic polynomial (14) at "
    "$-a/\\tau$, which are zero if the double pole is where it should be.",
    labels={
        "Kp": "$K_p$ (21)",
        "Ki": "$K_i$ (22)",
        "c0": "$c_0$ (23)",
        "c1": "$c_1$ (24)",
        "s3": "coefficient of $s^3$ (20)",
        "margin_1": "$c_1 - 2a/\\tau$ (27)",
        "margin_0": "$c_0 + (a/\\tau)^2 - c_1 a/\\tau$ (27)",
        "root": "$P_c(-a/\\tau)$ (14)",
        "slope": "$P_c'(-a/\\tau)$ (14)",
        "example-4-1": "Example 4.1",
        "example-4-2": "Example 4.2",
        "pt326": "PT326",
    },
)
equations.trials = lambda: {("Kp", column): trials(process, ["PA"])["PA"] for column, process in COLUMNS.items()}


def exact(process: Process) -> tuple[Fraction, Fraction, Fraction, Fraction]:
    """Return K, L, tau and a as the decimal fractions that the paper prints."""
    K, L, tau, a = (Fraction(repr(x)) for x in (process.K, process.L, process.tau, process.a))
    return K, L, tau, a


def _evaluate(
    solve: Callable[[Fraction, Fraction, Fraction, Fraction], Assignment],
    cubic: Callable[[Fraction, Fraction, Assignment], Number],
) -> pd.DataFrame:
    import pandas as pd

    columns = {}
    for column, process in COLUMNS.items():
        K, L, tau, a = exact(process)
        found = solve(K, L, tau, a)
        polynomial = characteristic(K, L, tau, (found.Kp, found.Ki))
        margins = dominance_of(found, tau, a)
        s = -a / tau
        values = (
            *found,
            cubic(tau, a, found),
            *margins,
            sum(c * s**n for n, c in enumerate(polynomial)),
            sum(n * c * s ** (n - 1) for n, c in enumerate(polynomial) if n),
        )
        columns[column] = [float(value) for value in values]
    return pd.DataFrame(columns, index=list(equations.rows))


def _cubic_as_printed(tau: Fraction, a: Fraction, found: Assignment) -> Number:
    return 2 * a / tau**2 + found.c1  # (20), as printed


def _cubic(tau: Fraction, a: Fraction, found: Assignment) -> Number:
    return assigned(tau, a, (found.c0, found.c1))[3]


@equations.reading(
    "as-written", "As in the copy at hand", note="Equation (24) without its last numerator; (20) with $2a/\\tau^2$."
)
def as_written() -> pd.DataFrame:
    """Evaluate the formulas as they stand on the page."""

    def solve(K: Fraction, L: Fraction, tau: Fraction, a: Fraction) -> Assignment:
        return assign(K, L, tau, a)._replace(c1=c1_in_copy(L, tau, a))

    return _evaluate(solve, _cubic_as_printed)


@equations.reading(
    "restored",
    "With the lost term of (24)",
    note="Equation (24) ends with $+\\,\\dfrac{864\\,\\tau^3 (aL + \\tau)}{L\\Delta}$, and the coefficient "
    "of $s^3$ in (20) is $2a/\\tau + c_1$. With these two changes every row agrees exactly with the direct "
    "solution.",
)
def restored() -> pd.DataFrame:
    """Evaluate the formulas with the two errors mended."""
    return _evaluate(assign, _cubic)


@equations.reading(
    "direct",
    "Direct solution of (14) = (20)",
    note="The four linear equations in $K_p, K_i, c_0, c_1$ solved by elimination, without the paper's formulas.",
)
def direct() -> pd.DataFrame:
    """Solve for the four unknowns directly."""
    return _evaluate(match_coefficients, _cubic)

"""Sections II and III: the Padé approximations, and the formulas of the pole assignment in exact arithmetic."""
# ruff: noqa: D103  -- the text of a claim documents its check

from __future__ import annotations

import math
from fractions import Fraction
from itertools import product

from replicate.exhibits import Finding
from replicate.exhibits.evidence import number
from replicate.papers.bayhan.claims import PROCESSES, claims
from replicate.papers.bayhan.equations import exact
from replicate.papers.bayhan.pole_assignment import (
    assign,
    assigned,
    c1_in_copy,
    characteristic,
    match_coefficients,
)

# Points at which the formulas are compared in exact arithmetic: K, L, tau, a.
_FRACTIONS = (Fraction(1, 3), Fraction(3, 4), Fraction(2), Fraction(7, 2))
GRID = tuple(product((Fraction(7, 8), Fraction(5)), _FRACTIONS, _FRACTIONS, _FRACTIONS))


@claims.claim(
    "eq-5-7",
    "(5) and (6) give the first- and second-order Padé approximations (7).",
    where="section II, (5) to (7)",
)
def eq_5_7() -> Finding:
    def h(n: int, k: int) -> Fraction:
        factorial = math.factorial
        return Fraction(
            factorial(2 * n - k) * factorial(n), factorial(2 * n) * factorial(k) * factorial(n - k)
        )  # (6), with (2n)!

    printed = {1: (1, Fraction(1, 2)), 2: (1, Fraction(1, 2), Fraction(1, 12))}  # (7)
    gap = max(abs(h(n, k) - value) for n, values in printed.items() for k, value in enumerate(values))
    return Finding(
        "holds" if gap == 0 else "fails",
        float(gap),
        "With $(2n)!$ in (6) the coefficients are exactly those of (7) (largest difference "
        f"{float(gap):g}). The print has $2n!$; the factor cancels in (5), so the slip is harmless.",
    )


@claims.claim(
    "eq-21-23", "$K_p$, $K_i$ and $c_0$ of (21) to (23) solve (14) = (20).", where="section III, (21) to (23)"
)
def eq_21_23() -> Finding:
    wrong = sum(assign(*point)[:3] != match_coefficients(*point)[:3] for point in GRID)
    return Finding(
        "fails" if wrong else "holds",
        wrong,
        f"In exact rational arithmetic the formulas differ from the direct solution at {wrong} of "
        f"{len(GRID)} points $(K, L, \\tau, a)$. (In the scan the “+” that opens each continuation line "
        "has become a “=”.)",
    )


@claims.claim("eq-24", "$c_1$ of (24) solves (14) = (20).", where="section III, (24)")
def eq_24() -> Finding:
    legible = sum(c1_in_copy(L, tau, a) != match_coefficients(K, L, tau, a).c1 for K, L, tau, a in GRID)
    restored = sum(assign(*point).c1 != match_coefficients(*point).c1 for point in GRID)
    return Finding(
        "fails" if restored else "undecided" if legible else "holds",
        restored,
        "Our copy breaks off inside the formula: after the last “+” the numerator is missing, while its denominator "
        "$L\\Delta$ follows two lines later. So a last line was printed, and what it said cannot be read. With the "
        f"numerator $864\\,\\tau^3(aL+\\tau)$ over that denominator (24) differs from the direct solution at "
        f"{restored} of {len(GRID)} points, without it at {legible}: what is legible is right.",
    )


@claims.claim("eq-20", "(20) is the expanded product $P_d(s)P_e(s)$.", where="section III, (20)")
def eq_20() -> Finding:
    tau, a, low, high = Fraction(2), Fraction(3, 4), Fraction(5), Fraction(7)
    s = Fraction(3)
    product_of_both = (s + a / tau) ** 2 * (s**2 + high * s + low)  # (18), (19)
    mended = sum(c * s**n for n, c in enumerate(assigned(tau, a, (low, high))))
    printed = mended + (2 * a / tau**2 - 2 * a / tau) * s**3
    gap, rest = float(printed - product_of_both), float(mended - product_of_both)
    used = all(assign(*point) == match_coefficients(*point) for point in GRID)
    return Finding(
        "holds" if not gap else "undecided" if not rest and used else "fails",
        gap,
        "At $s = 3$ for $\\tau = 2$, $a = 3/4$, $c_0 = 5$, $c_1 = 7$ the right-hand side in our copy is off by "
        f"{number(gap)}: the coefficient of $s^3$ is $2a/\\tau + c_1$, not $2a/\\tau^2 + c_1$. With it "
        f"the difference is {rest:g}. One exponent, in the paper or in the copy at hand; the paper's gains "
        f"{'follow' if used else 'do not follow'} from the right form. The sentence above (20) should refer to "
        "(17), not (16).",
    )


@claims.claim(
    "double-pole",
    "The controller (21), (22) puts two poles of the Padé loop at $-a/\\tau$.",
    where="section III, (14), (17), (18)",
)
def double_pole() -> Finding:
    worst = Fraction(0)
    for K, L, tau, a in (*GRID, *(exact(process) for process in PROCESSES)):
        found = assign(K, L, tau, a)
        polynomial = characteristic(K, L, tau, found[:2])
        s = -a / tau
        value = sum(c * s**n for n, c in enumerate(polynomial))
        slope = sum(n * c * s ** (n - 1) for n, c in enumerate(polynomial) if n)
        worst = max(worst, abs(Fraction(value)), abs(Fraction(slope)))
    return Finding(
        "holds" if worst == 0 else "fails",
        float(worst),
        f"Value and slope of (14) at $-a/\\tau$ are {float(worst):g} in exact arithmetic, at {len(GRID)} "
        "points and for the paper's three processes.",
    )

"""Equations (3) to (10): the derivation, evaluated in exact rational arithmetic.

Every step of the derivation is an identity between rational functions, so it can be refuted, and for practical purposes
confirmed, by evaluating both sides with fractions at many points. S(jw) is checked as a function of a real s with
w^2 = -s^2, which is the same identity.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from replicate.papers.ali import paper

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Point:
    """One choice of all symbols; g is the gain product KKp, w2 the squared frequency."""

    T: Fraction
    theta: Fraction
    g: Fraction
    Ti: Fraction
    y: Fraction
    w2: Fraction

    @property
    def b(self) -> Fraction:
        """Equation (6)."""
        return self.g * self.theta / 2 - self.T

    @property
    def q2(self) -> Fraction:
        """Equation (7)."""
        return self.b**2 - self.y**2 * self.T**2

    @property
    def c2(self) -> Fraction:
        """Equation (8)."""
        return 1 - self.y**2


def points() -> Iterator[Point]:
    """Yield the points of the comparison, both sides of every condition."""
    F = Fraction
    for T, theta, g, Ti, y, w2 in product(
        (F(1), F(5, 3)), (F(1, 5), F(7, 10), F(3, 2)), (F(1, 2), F(3, 2), F(3)), (F(1, 4), F(2), F(9)),
        (F(2, 5), F(3, 4)), (F(1, 3), F(5)),
    ):  # fmt: skip
        yield Point(T, theta, g, Ti, y, w2)


def loop_3(p: Point, s: Fraction) -> Fraction:
    """Return L(s) of (3)."""
    return p.g * (1 - p.theta * s / 2) * (1 + s * p.Ti) / (s * p.Ti * (p.T * s - 1))


def sensitivity_4(p: Point, s: Fraction) -> Fraction:
    """Return S of (4), with jw = s."""
    w2 = -(s**2)
    real = p.g * p.theta * w2 * p.Ti / 2 + p.g - w2 * p.Ti * p.T
    imaginary = p.g * (p.Ti - p.theta / 2) - p.Ti
    return (-w2 * p.Ti * p.T - s * p.Ti) / (real + s * imaginary)


def equation_5(p: Point, w2: Fraction, *, restored: bool = True) -> Fraction:
    """Return the left-hand side of (5); as scanned, its bracket closes before the last two terms of the coefficient."""
    inside = 2 * p.g * p.Ti * p.b + p.c2 * p.Ti**2 + p.g**2 * (p.Ti - p.theta / 2) ** 2
    late = -2 * p.g * p.Ti**2 + p.g * p.theta * p.Ti
    return w2**2 * p.Ti**2 * p.q2 + w2 * inside + late * (w2 if restored else 1) + p.g**2


def equation_9(p: Point, q: Fraction) -> Fraction:
    """Return the left-hand side of (9)."""
    return (
        p.Ti**2 * (p.g**2 + p.c2 - 2 * p.g)
        - p.Ti * p.g * (2 * q - 2 * p.b - p.theta + p.theta * p.g)
        + p.g**2 * p.theta**2 / 4
    )


def condition_10(p: Point) -> bool:
    """Return whether (10) holds."""
    return p.Ti / (p.Ti - p.theta / 2) < p.g < 2 * p.T / p.theta


def _holds_3(p: Point) -> bool:
    """Compare (3) with the product of controller, plant and 1/1 Padé approximation."""
    s = p.w2  # any number
    controller = p.g * (1 + 1 / (s * p.Ti)) * (1 + s * p.theta / 2)
    delay = (1 - p.theta * s / 2) / (1 + p.theta * s / 2)
    return loop_3(p, s) == controller * delay / (p.T * s - 1)


def _holds_4(p: Point) -> bool:
    s = p.w2
    return sensitivity_4(p, s) * (1 + loop_3(p, s)) == 1


def _holds_5(p: Point, *, restored: bool) -> bool:
    """Compare (5) with the difference of the squared magnitudes in (4)."""
    real = p.g * p.theta * p.w2 * p.Ti / 2 + p.g - p.w2 * p.Ti * p.T
    imaginary2 = p.w2 * (p.g * (p.Ti - p.theta / 2) - p.Ti) ** 2
    numerator2 = (p.w2 * p.Ti * p.T) ** 2 + p.w2 * p.Ti**2
    return real**2 + imaginary2 - p.y**2 * numerator2 == equation_5(p, p.w2, restored=restored)


def _discriminant_5(p: Point) -> Fraction:
    """Return the discriminant of (5) in w^2, from three of its values."""
    c0, at_1, at_2 = (equation_5(p, Fraction(w2)) for w2 in (0, 1, 2))
    c2 = (at_2 - 2 * at_1 + c0) / 2
    c1 = at_1 - c0 - c2
    return c1**2 - 4 * c2 * c0


def _with_rational_q(p: Point) -> tuple[Point, Fraction]:
    """Return a point like p for which q is rational: T and y chosen so that b, q and y T are as 5 : 4 : 3."""
    T = p.T + p.g * p.theta / 2
    b = p.g * p.theta / 2 - T
    y = abs(b) * Fraction(3, 5) / T
    return Point(T, p.theta, p.g, p.Ti, y, p.w2), abs(b) * Fraction(4, 5)


def _holds_9(p: Point) -> bool:
    """Check that the discriminant of (5) is the product of (9) for both signs of q."""
    point, q = _with_rational_q(p)
    products = equation_9(point, q) * equation_9(point, -q)
    return point.q2 == q**2 and _discriminant_5(point) == products


def _holds_root(p: Point) -> bool:
    """Check that the repeated root is w^2 = -KKp/(Ti q): there (5) equals w^2 times (9), for either sign of q."""
    point, q = _with_rational_q(p)
    return all(
        equation_5(point, w2) == w2 * equation_9(point, signed)
        for signed in (q, -q)
        for w2 in (-point.g / (point.Ti * signed),)
    )


def _stable(p: Point) -> bool:
    """Return whether the loop (3) is stable, from the roots of its characteristic polynomial."""
    integral = np.polymul([float(p.Ti), 0.0], [float(p.T), -1.0])
    forward = float(p.g) * np.polymul([-float(p.theta) / 2, 1.0], [float(p.Ti), 1.0])
    return bool(np.all(np.roots(np.polyadd(integral, forward)).real < 0.0))


def _holds_10(p: Point, *, restored: bool) -> bool:
    """Compare (10) with the roots; restored: with the condition Ti > theta/2, which the paper does not say."""
    if 2 * p.Ti == p.theta or p.g * p.theta == 2 * p.T:
        return True  # (10) is not defined there, or the loop is degenerate
    return (condition_10(p) and (not restored or p.Ti > p.theta / 2)) == _stable(p)


equations = paper.table(
    "eq-3-10",
    "The derivation, (3) to (10)",
    kind="formula",
    printed=False,
    rows=("3", "4", "5", "9", "root", "10"),
    columns=("points", "failures"),
    caption="Each step of the derivation evaluated in exact fractions at many points: at how many of them it "
    "fails. (5) fails as scanned and holds with its bracket closed two terms later. (10) needs "
    "$T_i > \\theta/2$, which the paper does not say. The repeated root of (5) is a frequency only if $q < "
    "0$.",
    labels={
        "3": "(3) loop with 1/1 Padé delay, $T_d = \\theta/2$",
        "4": "(4) $S(j\\omega)$",
        "5": "(5) from squaring (4)",
        "9": "(9) from a repeated root of (5)",
        "root": "repeated root $\\omega^2 = -KK_p/(T_i q)$",
        "10": "(10) stability of the loop (3)",
        "points": "Points",
        "failures": "Failures",
    },
)


def _count(restored: bool) -> pd.DataFrame:
    checks: dict[str, Callable[[Point], bool]] = {
        "3": _holds_3,
        "4": _holds_4,
        "5": lambda p: _holds_5(p, restored=restored),
        "9": _holds_9,
        "root": _holds_root,
        "10": lambda p: _holds_10(p, restored=restored),
    }
    grid = list(points())
    rows = {row: [len(grid), sum(not holds(p) for p in grid)] for row, holds in checks.items()}
    return equations.frame(rows)


@equations.reading("as-written", "As it stands on the page", note="(5) with its bracket as scanned; (10) as printed.")
def as_written() -> pd.DataFrame:
    """Check the equations as they stand."""
    return _count(restored=False)


@equations.reading(
    "restored",
    "With the two corrections",
    note="In (5) the bracket of the coefficient of $\\omega^2$ closes after $+KK_p\\theta T_i$, and only "
    "$K^2K_p^2$ stands outside; (10) is read with $T_i > \\theta/2$. The number (6), lost in the scan, "
    "belongs to $b = KK_p\\theta/2 - T$.",
)
def restored() -> pd.DataFrame:
    """Check the equations with the two corrections."""
    return _count(restored=True)

"""Ali and Majhi: the derivation in sympy, the search for the settings in exact fractions and mpmath."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import pytest
import sympy as sp

from replicate.exhibits import Table
from replicate.papers.ali import paper, tuning
from replicate.papers.ali.equations import Point, equation_5, equation_9

T, THETA, G, TI, Y, W2, Q, S = sp.symbols("T theta g T_i y W q s", positive=True)  # g = K Kp, W = w^2


B = G * THETA / 2 - T  # (6)


ROWS = [Fraction(k, 10) for k in range(1, 11)]


@pytest.fixture(scope="module")
def exhibits() -> dict[str, Table]:
    return {id: exhibit for id, exhibit in paper.load().exhibits.items() if isinstance(exhibit, Table)}


# ------------------------------------------------------------------------------------------- derivation, (3) to (10)


def design_loop() -> sp.Expr:
    """(3) from its parts: series controller without filter, plant, 1/1 Padé delay, Td = theta/2."""
    controller = G * (1 + 1 / (S * TI)) * (1 + S * THETA / 2)
    return controller / (T * S - 1) * (1 - THETA * S / 2) / (1 + THETA * S / 2)


def squared_condition() -> sp.Expr:
    """y^2 |numerator of S|^2 = |denominator of S|^2 as a polynomial in W = w^2, from the loop itself."""
    w = sp.symbols("w", positive=True)
    numerator, denominator = sp.fraction(sp.together(1 / (1 + sp.cancel(design_loop()))))

    def squared(expression: sp.Expr) -> sp.Expr:
        value = sp.expand(expression.subs(S, sp.I * w))
        return sp.expand(sp.re(value) ** 2 + sp.im(value) ** 2).subs(w, sp.sqrt(W2))

    polynomial = sp.expand(squared(denominator) - Y**2 * squared(numerator))
    return sp.expand(sp.cancel(polynomial / (W2 if polynomial.subs(W2, 0) == 0 else 1)))


#: The package's formulas take it like a point of fractions.
SYMBOLS = Point(T, THETA, G, TI, Y, W2)


def test_3_cancels_the_pade_pole() -> None:
    printed = G * (1 - THETA * S / 2) * (1 + S * TI) / (S * TI * (T * S - 1))
    assert sp.simplify(design_loop() - printed) == 0


def test_5_holds_with_the_bracket_closed_two_terms_later_and_only_so() -> None:
    condition = squared_condition()
    restored, scanned = (sp.expand(equation_5(SYMBOLS, W2, restored=r)) for r in (True, False))
    factor = sp.simplify(condition / restored)
    assert factor.free_symbols <= {T, THETA, G, TI}  # (5) up to a constant factor
    assert sp.simplify(restored - scanned) != 0


def test_9_times_9_with_the_other_sign_of_q_is_the_discriminant_of_5() -> None:
    quadratic = sp.Poly(equation_5(SYMBOLS, W2), W2)
    nines = [equation_9(SYMBOLS, q) for q in (Q, -Q)]
    product = sp.expand(nines[0] * nines[1]).subs(Q**2, B**2 - Y**2 * T**2)  # (7)
    assert sp.simplify(quadratic.discriminant() - product) == 0


def test_repeated_root_of_5_is_a_frequency_only_for_negative_q() -> None:
    # (5) = (Ti q w^2 + KKp)^2 + w^2 (9): where (9) holds, the root is w^2 = -KKp/(Ti q).
    five = equation_5(SYMBOLS, W2)
    nine = equation_9(SYMBOLS, Q)
    difference = sp.expand(five - (TI * Q * W2 + G) ** 2 - W2 * nine)
    assert sp.simplify(difference.subs(Y, sp.sqrt(B**2 - Q**2) / T)) == 0


def test_10_is_the_routh_condition_for_large_enough_integral_time() -> None:
    polynomial = sp.Poly(sp.numer(sp.together(1 + sp.cancel(design_loop()))), S)
    second, first, constant = polynomial.all_coeffs()
    ratio = second / constant  # one sign for all coefficients
    assert sp.simplify(ratio - TI * (T - G * THETA / 2) / G) == 0  # positive: KKp < 2T/theta
    assert sp.simplify(first / constant - (G * (TI - THETA / 2) - TI) / G) == 0  # KKp > Ti/(Ti - theta/2)


def test_exhibit_counts_what_fails(exhibits: dict[str, Table]) -> None:
    readings = exhibits["eq-3-10"].readings
    as_written, restored = (readings[id].compute()["failures"].to_dict() for id in ("as-written", "restored"))
    assert [row for row, failures in as_written.items() if failures] == ["5", "10"]
    assert not any(restored.values())


# ------------------------------------------------------------------------------------------------------------- search


def reference_search(x: Fraction) -> tuple[Fraction, mp.mpf, mp.mpf, mp.mpf]:
    """Ms*, |q| and the larger root of (9) for both signs of q, with 40 digits and the tie decided by sympy."""
    with mp.workdps(40):
        theta = sp.Rational(x.numerator, x.denominator)
        gain = sp.sqrt(2 / theta)
        steps = 12
        while True:
            q2 = sp.simplify((gain * theta / 2 - 1) ** 2 - sp.Rational(10, steps) ** 2)
            if q2.is_nonnegative:
                break
            steps += 1
        g, t, q = mp.mpf(str(sp.N(gain, 40))), mp.mpf(x.numerator) / x.denominator, mp.sqrt(mp.mpf(str(sp.N(q2, 40))))
        y = mp.mpf(10) / steps
        b, c2 = g * t / 2 - 1, 1 - y**2
        roots = [
            max(
                mp.polyroots([g**2 + c2 - 2 * g, -g * (2 * s * q - 2 * b - t + t * g), g**2 * t**2 / 4], extraprec=100),
                key=lambda r: r.real,
            )
            for s in (1, -1)
        ]
        return Fraction(steps, 10), q, *roots


@pytest.mark.parametrize("x", ROWS, ids=str)
def test_search_and_both_roots(x: Fraction) -> None:
    specified, q, printed, tangency = reference_search(x)
    assert tuning.specified_sensitivity(x) == specified
    assert tuning.q(x, specified) == pytest.approx(float(q), rel=1e-13)
    assert tuning.integral_time(x) == pytest.approx(float(printed), rel=1e-13)
    assert tuning.integral_time(x, "tangency") == pytest.approx(float(tangency), rel=1e-13)


def test_row_0_5_is_a_tie_decided_exactly() -> None:
    x = Fraction(1, 2)
    assert tuning.specified_sensitivity(x) == 2
    assert tuning.q(x, Fraction(2)) == 0.0
    assert tuning.integral_time(x) == pytest.approx(2 + math.sqrt(11 / 3), rel=1e-15)  # 3/4 Ti^2 - 3 Ti + 1/4 = 0
    # An arbitrarily small step to either side is decided for that side.
    tiny = Fraction(1, 10**30)
    assert tuning.specified_sensitivity(x - tiny) == 2
    assert tuning.specified_sensitivity(x + tiny) == Fraction(21, 10)


def test_specifications_out_of_reach_are_refused() -> None:
    with pytest.raises(ValueError, match="between 0 and 2"):
        tuning.specified_sensitivity(Fraction(2))
    with pytest.raises(ValueError, match="imaginary"):
        tuning.q(Fraction(1, 2), Fraction(19, 10))

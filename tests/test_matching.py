"""The interval logic against whole-number arithmetic that shares nothing with it.

A printed number is ``digits * 10**exponent``, a computed one ``steps * 10**(exponent - 2)``: hundredths of
the last printed digit. Rounding, truncation and nearness are then statements about integers.
"""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from synthetic import decimal_text

from replicate.errors import PrintedFileError
from replicate.exhibits.matching import Match, computed_text, format_like, match, meets
from replicate.exhibits.printed import PrintedValue

# 10 printed digits and 2 more are the 12 that survive the writing of the computed number.
DIGITS = st.integers(-(10**9), 10**9)
EXPONENTS = st.integers(-12, 0)


def computed(steps: int, exponent: int) -> float:
    """Return the double nearest to steps * 10**(exponent - 2)."""
    return float(Fraction(steps) * Fraction(10) ** (exponent - 2))


def expected(digits: int, steps: int) -> Match:
    rounds = abs(steps - 100 * digits) <= 50
    toward_zero = steps // 100 if steps >= 0 else -(-steps // 100)
    if rounds or toward_zero == digits:
        return Match("equal", "rounded" if toward_zero != digits else "either" if rounds else "truncated")
    near = abs(steps - 100 * digits) <= 200 or abs(steps - 100 * digits) <= abs(digits)
    return Match("near" if near else "differs")


@given(digits=DIGITS, exponent=EXPONENTS, offset=st.integers(-400, 400))
@example(digits=0, exponent=-2, offset=99)
@example(digits=0, exponent=-2, offset=-99)
@example(digits=0, exponent=0, offset=100)
@example(digits=6968, exponent=-3, offset=50)
@example(digits=6968, exponent=-3, offset=-50)
@example(digits=6968, exponent=-3, offset=51)
@example(digits=6968, exponent=-3, offset=-51)
@example(digits=-6968, exponent=-3, offset=-99)
@example(digits=-6968, exponent=-3, offset=99)
@example(digits=1, exponent=0, offset=-200)
@example(digits=1, exponent=0, offset=201)
def test_around_the_printed_digit(digits: int, exponent: int, offset: int) -> None:
    steps = 100 * digits + offset
    assert match(decimal_text(digits, exponent), computed(steps, exponent)) == expected(digits, steps)


@given(digits=DIGITS, exponent=EXPONENTS, fraction=st.floats(-0.03, 0.03))
def test_around_one_percent(digits: int, exponent: int, fraction: float) -> None:
    steps = 100 * digits + int(100 * digits * fraction)
    assert match(decimal_text(digits, exponent), computed(steps, exponent)) == expected(digits, steps)


@given(digits=st.integers(201, 10**9), exponent=EXPONENTS, sign=st.sampled_from([-1, 1]))
def test_one_percent_is_the_limit(digits: int, exponent: int, sign: int) -> None:
    # From 201 units on, 1 % is more than 2 units; hundredths of a unit make 1 % of `digits` a whole number.
    text = decimal_text(digits, exponent)
    assert match(text, computed(100 * digits + sign * digits, exponent)) == Match("near")
    assert match(text, computed(100 * digits + sign * (digits + 1), exponent)) == Match("differs")


@given(digits=st.integers(1, 10**6 - 1), exponent=st.integers(-9, 3), offset=st.integers(-300, 300))
def test_fixed_significant_digits(digits: int, exponent: int, offset: int) -> None:
    """Written with stripped zeros or in full, a number with n significant digits means the same."""
    digits = int(f"{digits:<06d}".ljust(6, "0"))
    steps = 100 * digits + offset
    stripped = decimal_text(digits, exponent)
    if "." in stripped:
        stripped = stripped.rstrip("0").rstrip(".")
    assert match(stripped, computed(steps, exponent), significant_digits=6) == expected(digits, steps)
    assert match(PrintedValue(stripped, significant_digits=6), computed(steps, exponent)) == expected(digits, steps)


def test_trailing_zeros_are_information() -> None:
    assert match("6.968", 6.96849).kind == "equal"
    assert match("6.9680", 6.96849).kind == "near"
    assert match("6.968", 6.96849, significant_digits=6).kind == "near"


@pytest.mark.parametrize("digits", [1, 6])
def test_zero_with_significant_digits(digits: int) -> None:
    half = 0.5 * 10.0**-digits
    assert match("0", half, digits) == Match("equal", "either")
    assert match("0", -1.9 * half, digits) == Match("equal", "truncated")
    assert match("0", 4 * half, digits) == Match("near")
    assert match("0", 4.1 * half, digits) == Match("differs")


@given(
    value=st.floats(allow_nan=False, allow_infinity=False),
    text=st.sampled_from(["6.968", "0.0", "-12", "1e3"]),
)
def test_a_match_can_be_recomputed_from_the_written_number(value: float, text: str) -> None:
    assert match(text, value) == match(text, float(computed_text(value)))


@given(digits=DIGITS, exponent=EXPONENTS, offset=st.integers(-400, 400))
def test_sign_is_symmetric(digits: int, exponent: int, offset: int) -> None:
    assume(digits)
    value = computed(100 * digits + offset, exponent)
    text, mirrored = decimal_text(digits, exponent), decimal_text(-digits, exponent)
    assert match(text, value) == match(mirrored, -value)
    assert match(text.replace("-", "\N{MINUS SIGN}"), value) == match(text, value)


def test_binary_rounding_decides_nothing() -> None:
    # 1.005 as a double lies below the tie; what the paper's author saw was 1.005.
    assert Fraction(1.005) < Fraction(1005, 1000)
    assert match("1.01", 1.005) == Match("equal", "rounded")
    assert match("1.00", 1.005) == Match("equal", "either")


@pytest.mark.parametrize("nothing", [None, math.nan])
def test_nothing_computed(nothing: float | None) -> None:
    assert match("1.0", nothing) == Match("none")
    assert computed_text(nothing) == ""


@pytest.mark.parametrize("infinite", [math.inf, -math.inf])
def test_infinite_differs(infinite: float) -> None:
    assert match("1.0", infinite) == Match("differs")


def test_bad_print_is_an_error() -> None:
    with pytest.raises(PrintedFileError, match="'1,2' is not a number"):
        match("1,2", 1.2)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_twelve_digits_are_written(value: float) -> None:
    text = computed_text(value)
    assert len(text.partition("e")[0].replace("-", "").replace(".", "").lstrip("0")) <= 12
    error = abs(Fraction(text) - Fraction(value))
    assert error <= abs(Fraction(value)) * Fraction(1, 2 * 10**11)
    assert text != "-0"


@given(digits=st.integers(1, 10**6), exponent=st.integers(-6, 0), value=st.floats(0.001, 1e4))
def test_format_like_has_the_printed_precision(digits: int, exponent: int, value: float) -> None:
    printed = PrintedValue(decimal_text(digits, exponent))
    text = format_like(printed, value)
    assert len(text.partition(".")[2]) == -exponent
    assert abs(Fraction(text) - Fraction(computed_text(value))) <= Fraction(10) ** exponent / 2


@given(digits=st.integers(1, 8), mantissa=st.integers(10**11, 10**12 - 1), exponent=st.integers(-17, -5))
def test_format_like_keeps_significant_digits(digits: int, mantissa: int, exponent: int) -> None:
    text = format_like(PrintedValue("1", significant_digits=digits), computed(mantissa, exponent + 2))
    unit = 10 ** (12 - digits)
    rounded = (mantissa + unit // 2) // unit * unit
    assert Fraction(text) == rounded * Fraction(10) ** exponent
    assert not ("." in text and text.endswith("0"))


def test_meets_rounds_and_truncates() -> None:
    assert meets("75.7", 75.7508)  # truncated
    assert meets("38.4", 38.351)
    assert not meets("7.23", 7.2406)

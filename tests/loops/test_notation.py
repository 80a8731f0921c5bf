"""Plants and controllers in text: what they mean, that they round-trip, and how a slip is reported."""

from __future__ import annotations

import cmath
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.loops import PI, PID, LoopError, Plant
from replicate.loops.errors import NotationError
from replicate.loops.notation import controller_notation, parse_controller, parse_plant, plant_notation

POINTS = (0.3 + 0.2j, 2j, 1.0 + 5j, 0.01j)

#: What a text means, written down in Python's own complex arithmetic.
MEANINGS: dict[str, Callable[[complex], complex]] = {
    "e^{-1.5s}/(s+1)^3": lambda s: cmath.exp(-1.5 * s) / (s + 1) ** 3,
    "2 e^{-s}/(s(s+1))": lambda s: 2 * cmath.exp(-s) / s / (s + 1),
    "1/(s^2+0.4s+1) e^{-0.5s}": lambda s: cmath.exp(-0.5 * s) / (s * s + 0.4 * s + 1),
    "1/(s**2 + .4*s + 1)*exp(-s/2)": lambda s: cmath.exp(-0.5 * s) / (s * s + 0.4 * s + 1),
    r"\frac{e^{-s}}{(s+1)(s+2)}": lambda s: cmath.exp(-s) / (s + 1) / (s + 2),
    "(1 − 2·s)e^{−s}/(s+1)²": lambda s: (1 - 2 * s) * cmath.exp(-s) / (s + 1) ** 2,
    "-3(s+1)^{-2}": lambda s: -3 / (s + 1) ** 2,
    "1/s - 1/(s+1)": lambda s: 1 / s / (s + 1),
    "-s^2/(s+1)^2": lambda s: -(s**2) / (s + 1) ** 2,
    "1e-3/(1e3s+1)": lambda s: 1e-3 / (1e3 * s + 1),
    "e^{-0.5}/(s+1)": lambda s: cmath.exp(-0.5) / (s + 1),
    "2^{0.5}/s": lambda s: 2**0.5 / s,
    "(1-e^{-s})/s": lambda s: (1 - cmath.exp(-s)) / s,
    "e^{-s} + 0.5 e^{-2s}": lambda s: cmath.exp(-s) + 0.5 * cmath.exp(-2 * s),
    "e^{-s}/(1-0.5e^{-2s})": lambda s: cmath.exp(-s) / (1 - 0.5 * cmath.exp(-2 * s)),
    "e^{-sqrt(s)}": lambda s: cmath.exp(-cmath.sqrt(s)),
    "1/(1+s^0.9) e^{-0.2s}": lambda s: cmath.exp(-0.2 * s) / (1 + s**0.9),
    "-e^{-s}(1 - sqrt(s))e^{-s}/(s+2)": lambda s: -cmath.exp(-2 * s) * (1 - cmath.sqrt(s)) / (s + 2),
    "sech(sqrt(s))": lambda s: 1 / cmath.cosh(cmath.sqrt(s)),
    "1/cosh(sqrt(s))": lambda s: 1 / cmath.cosh(cmath.sqrt(s)),
    "tanh(s)/s": lambda s: cmath.tanh(s) / s,
    "coth(s)/(s+1)": lambda s: 1 / cmath.tanh(s) / (s + 1),
    "sinh(0.5s)/sinh(s)": lambda s: cmath.sinh(0.5 * s) / cmath.sinh(s),
    "csch(sqrt(s))sqrt(s)": lambda s: cmath.sqrt(s) / cmath.sinh(cmath.sqrt(s)),
}


@pytest.mark.parametrize("text", MEANINGS)
def test_a_text_means_what_it_says(text: str) -> None:
    plant = parse_plant(text)
    for s in POINTS:
        assert complex(plant(s)) == pytest.approx(MEANINGS[text](s), rel=4e-15)


@pytest.mark.parametrize("text", MEANINGS)
def test_what_is_written_is_read_as_the_same_plant(text: str) -> None:
    plant = parse_plant(text)
    again = parse_plant(plant_notation(plant))
    assert again == plant
    assert plant_notation(again) == plant_notation(plant)


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("e^{-1.5s} / (s + 1)^3", "e^{-1.5s}/(s+1)^3"),
        ("2e^{-s}/(s(s+1))", "2 e^{-s}/(s(s+1))"),
        ("1/(s^2+0.4s+1) e^{-0.5s}", "e^{-0.5s}/(s^2+0.4s+1)"),
        ("0.1/(0.3s+1)^8", "0.1/(0.3s+1)^8"),
        ("2e^{-1.5s}/(10s-1)", "2 e^{-1.5s}/(10s-1)"),
        ("(1-s)/(s^2(s+2)^2)", "(-s+1)/(s^2(s+2)^2)"),
        ("-e^{-s}", "-e^{-s}"),
        ("6/2", "3"),
        ("1/( 1+s^{0.9} )*e^{-0.2s}", "1/(1+s^{0.9}) e^{-0.2s}"),
    ],
)
def test_a_plant_is_written_as_one_would_write_it(text: str, written: str) -> None:
    assert plant_notation(parse_plant(text)) == written


def test_a_hyperbolic_plant_does_not_overflow() -> None:
    # e^{-100} where cosh itself would be 1e43 at sqrt(s) = 100, and nothing but zero far beyond the range of a float
    plant = parse_plant("cosh(0.5sqrt(s))/cosh(sqrt(s))")
    assert abs(complex(plant(4e4))) == pytest.approx(np.exp(-100.0), rel=1e-12)
    assert complex(plant(1e12)) == 0.0


finite = st.floats(-1e9, 1e9).filter(lambda x: x == 0.0 or abs(x) > 1e-9)
positive = st.floats(1e-9, 1e9)


@given(num=st.lists(finite, min_size=1, max_size=4), den=st.lists(finite, min_size=1, max_size=3),
       leading=positive, dead_time=st.one_of(st.just(0.0), positive))  # fmt: skip
def test_any_plant_round_trips_bit_by_bit(num: list[float], den: list[float], leading: float, dead_time: float) -> None:
    if not np.any(num):
        num = [*num, 1.0]
    plant = Plant(num, [leading, *[0.0] * len(num), *den], dead_time)
    again = parse_plant(plant_notation(plant))
    assert (plant.num.tolist(), plant.den.tolist(), plant.dead_time) == (
        again.num.tolist(),
        again.den.tolist(),
        again.dead_time,
    )


@given(k=finite, ki=finite, b=finite, tf=positive, sp=st.one_of(positive, st.tuples(positive, positive)))
def test_any_controller_round_trips(k: float, ki: float, b: float, tf: float, sp: float | tuple[float, float]) -> None:
    setpoint_filter = sp if isinstance(sp, float) else ((1.0,), (*sp, 1.0))
    pi = PI(k, ki, b, measurement_filter=tf, setpoint_filter=setpoint_filter)
    pid = PID(k, ki, kd=k, b=b, c=ki, derivative_filter=tf, measurement_filter_order=2)
    for controller in (pi, pid, replace(pid, kd=0.0)):
        again = parse_controller(controller_notation(controller))
        assert again == controller
        assert type(again) is type(controller)


@given(st.text(alphabet="s0123456789.e^{}()+-*/ sqrtcoh\\fa,=k", max_size=14))
def test_any_text_is_a_plant_or_one_line_with_a_column(text: str) -> None:
    for slip in (_slip(parse_plant, text), _slip(parse_controller, text)):
        assert slip is None or ("\n" not in str(slip) and 1 <= slip.column <= len(text) + 1)


def _slip(read: Callable[[str], object], text: str) -> NotationError | None:
    try:
        read(text)
    except NotationError as error:
        return error
    return None


def test_the_forms_of_a_controller() -> None:
    assert parse_controller("k=0.6,ki=0.5,b=1") == PI(0.6, 0.5)
    assert parse_controller("Kp = 0.6, Ti = 2") == PI(0.6, 0.3)
    assert parse_controller("k=2,ti=4,td=0.5,c=1") == PID.ideal(2.0, 4.0, 0.5, c=1.0)
    assert parse_controller("k=2,ti=4,td=1,alpha=0.1") == PID.series(2.0, 4.0, 1.0, alpha=0.1)
    assert parse_controller("k=2,ti=inf") == PI(2.0)
    assert parse_controller("k=2,ki=1/3") == PI(2.0, 1 / 3)
    assert parse_controller("k=2,ki=1,setpoint_filter=1/(2s+1)") == PI(2.0, 1.0, setpoint_filter=((1.0,), (2.0, 1.0)))
    assert controller_notation(PID(1.0, 0.0, 0.0)) == "k=1,ki=0,kd=0"


@pytest.mark.parametrize(
    ("text", "column", "reason"),
    [
        ("", 1, "the text is empty"),
        ("1/(s+1)(s+2)", 8, "above or below"),
        ("1/2s", 4, "above or below"),
        ("s2", 2, r"a power is written \^"),
        ("e^-2s", 1, "e needs an exponent in braces"),
        ("e^{-1.5s/(s+1)", 15, "'}' is needed for column 3"),
        ("1/(s+1]", 7, r"'\)' is needed for column 3, not '\]'"),
        ("1/(s+1))", 8, r"'\)' is not expected"),
        ("1/(s+K)", 6, "'K' is not known; allowed are s"),
        ("0,5/(s+1)", 2, "a decimal point"),
        ("s/(s+1)^", 9, "an exponent is a number"),
        ("(s+1)/", 7, "the text ends too early"),
        ("1/(s-s)", 2, "division by zero"),
        ("sqrt(s)/0", 8, "division by zero"),
        ("2^{s}", 2, "an exponent is a number"),
        ("1e999", 1, "not a floating-point number"),
        ("1/(s+1)^99", 8, "at most 60"),
        ("s^2^3", 4, "needs parentheses"),
        ("s", 1, "must be proper"),
        ("e^{2s}/(s+1)", 1, "predicts"),
        ("sqrt s", 6, "in parentheses"),
        ("(" * 50 + "s", 41, "more than 40 parentheses"),
    ],
)
def test_a_slip_in_a_plant_is_one_line_with_its_column(text: str, column: int, reason: str) -> None:
    with pytest.raises(NotationError, match=reason) as caught:
        parse_plant(text)
    assert caught.value.column == column
    assert str(caught.value).startswith(f"plant '{text}', column {column}: ")


@pytest.mark.parametrize("text", ["e^{-s}" * 3000, "+".join(["1/(s+1)"] * 3000), "-" * 100_000, "s" * 100_000])
def test_a_text_without_end_is_one_short_line(text: str) -> None:
    with pytest.raises(NotationError) as caught:
        parse_plant(text)
    assert len(str(caught.value)) < 400
    assert caught.value.text == text


@pytest.mark.parametrize("column", [1, 150, 999])
def test_of_a_long_text_the_surroundings_are_quoted(column: int) -> None:
    text = "".join(chr(ord("a") + place % 26) for place in range(1000))
    said = str(NotationError("plant", text, column, "no"))
    assert text[column - 1 : column + 90] in said
    assert len(said) < 250


@pytest.mark.parametrize(
    ("text", "column", "reason"),
    [
        ("", 1, "'' is not known"),
        ("k=1, q=2", 6, "'q' is not known; allowed are k, ki, kd, b, c"),
        ("k=1,ki", 5, "a value is missing"),
        ("k=1,ki=", 8, "the text is empty"),
        ("k=1,k=2", 5, "given twice"),
        ("k=1,ki=1,ti=2", 10, "ki and ti cannot both"),
        ("ki=1", 1, "the gain is missing"),
        ("k=1,ki=x", 8, "'x' is not known"),
        ("k=1,ki=2s", 8, "ki must be a number"),
        ("k=1,ti=0", 1, "integral_time must be a number other than 0"),
        ("k=1,measurement_filter=-1", 1, "measurement_filter must be a time constant >= 0"),
    ],
)
def test_a_slip_in_a_controller_is_one_line_with_its_column(text: str, column: int, reason: str) -> None:
    with pytest.raises(NotationError, match=reason) as caught:
        parse_controller(text)
    assert caught.value.column == column


def test_what_is_no_text_and_what_has_none() -> None:
    with pytest.raises(NotationError, match="a text is needed, not float"):
        parse_plant(3.0)  # type: ignore[arg-type]
    with pytest.raises(NotationError, match="a text is needed, not int"):
        parse_controller(3)  # type: ignore[arg-type]
    with pytest.raises(LoopError, match="has no notation; write it as a text"):
        plant_notation(Plant.from_function(lambda s: np.exp(-np.sqrt(s))))

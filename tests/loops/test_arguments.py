"""Whatever is no number is refused in one line that says what is allowed, by every public function."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from replicate.loops import (
    PI,
    Circle,
    Loop,
    LoopError,
    Plant,
    SmithPredictor,
    Weight,
    design_pi,
    design_pid,
    gamma_norm,
    nu_gap,
    setpoint_weight,
    step_responses,
    sweep,
    tune,
)
from replicate.loops.inputs import PiecewisePolynomial, Pulse, Ramp, Sine, Step

PLANT = Plant.foptd(1.0, 1.0, 1.0)
LOOP = Loop(PLANT, PI(0.6, 0.5))
Y = LOOP.step(until=40.0)

NUMBERS: dict[str, Callable[[Any], Any]] = {
    "Signal.crossings": Y.crossings,
    "Signal.first_reach": Y.first_reach,
    "Signal.delayed": Y.delayed,
    "Signal.__mul__": lambda v: Y * v,
    "Signal.settling_time": Y.settling_time,
    "Signal.delay_time": Y.delay_time,
    "Loop.steady_state, setpoint": lambda v: LOOP.steady_state(v, 0.0),
    "Loop.steady_state, load": lambda v: LOOP.steady_state(0.0, v),
    "Loop.respond_to, until": lambda v: LOOP.respond_to(setpoint=1.0, until=v),
    "Loop.respond_to, setpoint": lambda v: LOOP.respond_to(setpoint=v, until=5.0),
    "tune.simc": lambda v: tune.simc(PLANT, v),
    "tune.lambda_": lambda v: tune.lambda_(PLANT, v),
    "Step": Step,
    "Pulse, duration": lambda v: Pulse(1.0, v),
    "Ramp, duration": lambda v: Ramp(1.0, duration=v),
    "Sine, frequency": lambda v: Sine(1.0, v),
    "PiecewisePolynomial, start": lambda v: PiecewisePolynomial([(v, [1.0])]),
    "Plant.__truediv__": lambda v: PLANT / v,
    "Plant.rescaled, time": lambda v: PLANT.rescaled(v, 1.0),
    "Plant.rescaled, gain": lambda v: PLANT.rescaled(1.0, v),
    "Signal.summary": Y.summary,
    "Circle": lambda v: Circle(v, 1.0),
}
OPTIONAL = {"tune.simc", "tune.lambda_", "Loop.respond_to, until"}


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [None, "1", "x", 1j, float("nan"), [1.0, 2.0]], ids=repr)
def test_what_is_no_number_is_named_in_one_line(name: str, value: Any) -> None:
    if value is None and name in OPTIONAL:
        pytest.skip("None is the default")
    with pytest.raises(LoopError) as caught:
        NUMBERS[name](value)
    assert "\n" not in str(caught.value)
    assert " must be " in str(caught.value)


@pytest.mark.parametrize("name", NUMBERS)
def test_every_real_number_is_a_number(name: str) -> None:
    one, other, third = (NUMBERS[name](v) for v in (0.5, Fraction(1, 2), Decimal("0.5")))
    if isinstance(one, float | tuple | PI):
        assert one == other == third


@pytest.mark.parametrize("value", ["1.4", 1j, [1.4], float("nan"), float("inf"), 1.0, True], ids=repr)
def test_a_bound_of_a_design_is_a_number_above_one(value: Any) -> None:
    for design in (design_pi, design_pid):
        with pytest.raises(LoopError, match="ms must be finite and greater than 1"):
            design(PLANT, ms=value)
    with pytest.raises(LoopError, match="mp must be finite and greater than 1"):
        Circle.of(mp=value)


@pytest.mark.parametrize("value", [None, "x", 1.0, [1, 2]], ids=repr)
def test_a_plant_is_a_plant(value: Any) -> None:
    with pytest.raises(LoopError, match="a plant of the gap must be a Plant"):
        nu_gap(value, PLANT)
    with pytest.raises(LoopError, match="term"):
        Plant.from_terms(value)


@pytest.mark.parametrize("value", [None, "x", ["a"], [None]], ids=repr)
def test_points_of_the_plane_are_complex_numbers(value: Any) -> None:
    for function in (LOOP, LOOP.S, LOOP.T, LOOP.PS, LOOP.CS):
        with pytest.raises(LoopError, match="s must be complex numbers"):
            function(value)
    with pytest.raises(LoopError, match=r"must be (positive finite|real) numbers"):
        LOOP.bode(value)


@pytest.mark.parametrize("value", [3, "x", np.array(1.0), PI(1.0), [1], np.array([1.0])], ids=repr)
def test_several_things_are_a_list_of_them(value: Any) -> None:
    calls: list[tuple[str, Callable[[], object]]] = [
        ("the terms of a plant|each term", lambda: Plant.from_terms(value)),
        ("the controllers|each controller", lambda: step_responses(PLANT, value, 5.0)),
        ("constraint", lambda: design_pid(PLANT, 1.4, constraints=value)),
        ("metric", lambda: sweep(PLANT, PI(0.2), metrics=value)),
    ]
    for named, call in calls:
        with pytest.raises(LoopError, match=named):
            call()


def test_one_name_is_a_list_of_one_and_no_frequencies_have_no_values() -> None:
    assert design_pid(PLANT, 1.4, constraints="phase") == design_pid(PLANT, 1.4, constraints=("phase",))
    assert LOOP.bode([]).magnitude.size == LOOP.nyquist([]).size == 0


def test_times_are_real_numbers() -> None:
    for value in (1j, "x", [None]):
        with pytest.raises(LoopError, match="the times of a data frame must be real numbers"):
            Y.to_frame(value)  # type: ignore[arg-type]


# ---- transfer functions where they have no value -------------------------------------------------------------------

INTEGRATOR = Plant([1.0], [1.0, 0.0], 1.0)
HELD = Plant.from_terms([([1.0], [1.0, 0.0], 0.0), ([-1.0], [1.0, 0.0], 1.0)])
HEAT = Plant.from_function(lambda s: np.exp(-np.sqrt(s)))


@pytest.mark.parametrize("where", [np.nan, np.inf, -np.inf, 1j * np.inf, complex(np.inf, np.inf)])
@pytest.mark.parametrize("plant", [PLANT, INTEGRATOR, HELD, HEAT], ids=["lag", "integrator", "sum", "function"])
def test_transfer_functions_are_nan_at_infinity_without_a_warning(plant: Plant, where: complex) -> None:
    loop = Loop(plant, PI(0.2, 0.1))
    for function in (plant, loop, loop.S, loop.T, loop.PS, loop.CS, loop.controller.feedback):
        assert np.isnan(complex(function(where)))
        values = function([1j, where])
        assert np.isfinite(values[0])
        assert np.isnan(values[1])


@pytest.mark.parametrize(
    ("loop", "expected"),
    [  # L, S, T, PS = 1/(1/P + C), CS = 1/(1/C + P) at rest
        (Loop(PLANT, PI(0.2, 0.1)), (np.inf, 0.0, 1.0, 0.0, 1.0)),
        (Loop(PLANT, PI(0.25)), (0.25, 0.8, 0.2, 0.8, 0.2)),
        (Loop(INTEGRATOR, PI(0.25)), (np.inf, 0.0, 1.0, 4.0, 0.0)),
        (Loop(INTEGRATOR, PI(0.25, 0.01)), (np.inf, 0.0, 1.0, 0.0, 0.0)),
        (Loop(HELD, PI(0.25, 0.01)), (np.inf, 0.0, 1.0, 0.0, 1.0)),
        (Loop(HEAT, PI(0.25, 0.01)), (np.inf, 0.0, 1.0, 0.0, 1.0)),
        (Loop(PLANT, PI(0.0)), (0.0, 1.0, 0.0, 1.0, 0.0)),
        (Loop(PLANT, SmithPredictor(PI(0.2, 0.1), PLANT)), (np.inf, 0.0, 1.0, 0.0, 1.0)),
    ],
)
def test_transfer_functions_at_rest(loop: Loop, expected: tuple[float, ...]) -> None:
    found = [complex(f(0.0)) for f in (loop, loop.S, loop.T, loop.PS, loop.CS)]
    assert found == pytest.approx(list(expected), rel=1e-14, abs=1e-14)


def test_what_is_added_to_a_plant_or_multiplied_with_it_is_a_number() -> None:
    wrong: Any
    for wrong in (None, "", [], True):
        with pytest.raises(LoopError, match="must be a finite number, not"):
            PLANT + wrong
        with pytest.raises(LoopError, match="must be a finite number other than 0, not"):
            PLANT * wrong
    with pytest.raises(LoopError, match="must be whole, from 1 to 10000, not True"):
        Loop(PLANT, PI(0.2)).poles(True)


def test_numbers_of_numpy_are_shown_as_one_types_them() -> None:
    wrong: Any
    for wrong, shown in ((np.int64(-1), "-1"), (np.True_, "True"), (np.float32(0.1), "0.1"), (np.float64(2.5), "2.5")):
        with pytest.raises(LoopError, match=f"must be whole, from 1 to 10000, not {shown}$"):
            Loop(PLANT, PI(0.2)).poles(wrong)


def test_complex_times_and_frequencies_are_refused_and_the_past_is_at_rest() -> None:
    loop = Loop(PLANT, PI(0.2, 0.1))
    y = loop.step(until=5.0)
    assert float(y(-np.inf)) == 0.0
    with pytest.raises(LoopError, match="the times must be real numbers"):
        y(np.complex128(0.5))
    with pytest.raises(LoopError, match="frequencies must be positive finite numbers"):
        loop.bode(np.complex128(0.5))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: LOOP.closest_approach(0.5), "center must be a finite number >= 1, not 0.5"),
        (lambda: PLANT / 0, "the divisor of a plant must be a finite number other than 0, not 0"),
        (lambda: PLANT.rescaled(0.0, 1.0), "the unit of time must be a finite number > 0"),
        (lambda: PLANT.rescaled(1.0, 0.0), "the unit of gain must be a finite number other than 0"),
        (lambda: Plant([1e308, 1.0], [1e-308, 1.0]), "exceed the range of floats"),
        (lambda: PI(1.0, measurement_filter_order=np.array([1, 2])), "measurement filter must be 1 or 2"),  # type: ignore[arg-type]
        (lambda: tune.simc(1.0), "the plant of a tuning rule must be a Plant, not float"),  # type: ignore[arg-type]
        (lambda: PI(10**400), "the controller's k must be a finite number"),
        (lambda: LOOP.poles(10**9), "the number of poles must be whole, from 1 to 10000"),
        (lambda: gamma_norm(PLANT, LOOP.controller, 3.0), "the weight must be a Weight, not float"),  # type: ignore[arg-type]
        (lambda: Weight.constant("a"), "a constant weight must be a positive number"),  # type: ignore[arg-type]
        (lambda: setpoint_weight(PLANT, "a", 1.0), "the controller's k must be a finite number"),  # type: ignore[arg-type]
        (lambda: tune.gain_phase_margins(1.0), "the plant of a tuning rule must be a Plant"),  # type: ignore[arg-type]
        (lambda: tune.half_rule(PLANT, 1.5), "the order of a model must be at least 1 and whole"),  # type: ignore[arg-type]
        (lambda: step_responses([PLANT], [PI(1.0)], 5.0), "the plant must be a Plant, not list"),  # type: ignore[arg-type]
        (lambda: Y.summary(-1.0), "the settling band must be a positive fraction"),
        (lambda: PiecewisePolynomial(5), "the pieces must be a list of"),  # type: ignore[arg-type]
        (lambda: PiecewisePolynomial([1.0]), "each piece must be"),  # type: ignore[list-item]
        (lambda: PiecewisePolynomial([(0.0, 1.0)]), "the coefficients of a piece must be"),  # type: ignore[list-item]
    ],
)  # fmt: skip
def test_what_is_not_allowed_is_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(LoopError, match=message):
        call()


@pytest.mark.parametrize(
    "function",
    [lambda _: "a", lambda _: None, lambda _: [1.0, 2.0], lambda s: abs(s) if s == 0 else s, lambda s: complex(s) + 1],
    ids=["text", "nothing", "another shape", "a branch on s", "one number only"],
)
def test_a_function_of_an_array_has_a_number_for_each_of_its_elements(function: Callable[[Any], Any]) -> None:
    with pytest.raises(LoopError, match="the plant's function must be callable with a complex array") as caught:
        Plant.from_function(function)
    assert "\n" not in str(caught.value)


def test_inputs_are_floats_whatever_kind_of_number_is_given() -> None:
    half: Any = Fraction(1, 2)
    two: Any = Decimal(2)
    assert Pulse(two, two, half) == Pulse(2.0, 2.0, 0.5)
    assert Pulse(two, two, half).events() == [(0.5, 0, 2.0), (2.5, 0, -2.0)]
    assert Ramp(half, duration=two).events() == [(0.0, 1, 0.5), (2.0, 1, -0.5)]
    assert PiecewisePolynomial([(half, [two])]) == PiecewisePolynomial(((0.5, (2.0,)),))
    exact = LOOP.respond_to(setpoint=Sine(two, half), until=5.0)
    np.testing.assert_array_equal(exact.output(3.0), LOOP.respond_to(setpoint=Sine(2.0, 0.5), until=5.0).output(3.0))


@pytest.mark.parametrize("factor", [49, 103, 0.11, -0.45])
def test_a_gain_is_multiplied_and_divided_to_the_last_digit(factor: float) -> None:
    assert PLANT * factor == factor * PLANT == Plant([factor], [1.0, 1.0], 1.0)
    assert PLANT / factor == Plant([1.0 / factor], [1.0, 1.0], 1.0)


def test_a_response_is_added_to_a_response() -> None:
    with pytest.raises(TypeError, match="unsupported operand"):
        Y + 1.0  # type: ignore[operator]

"""Whatever is no number is refused in one line that says what is allowed, by every public function."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest

from replicate.loops import PI, Circle, Loop, LoopError, Plant, design_pi, design_pid, nu_gap, tune
from replicate.loops.inputs import Step

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


def test_times_are_real_numbers() -> None:
    for value in (1j, "x", [None]):
        with pytest.raises(LoopError, match="the times of a data frame must be real numbers"):
            Y.to_frame(value)  # type: ignore[arg-type]

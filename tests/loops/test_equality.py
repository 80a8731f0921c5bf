"""Plants, controllers, loops and results are equal, hashed, copied and stored by what they are made of."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, Plant, SmithPredictor, sweep
from replicate.loops.design.gain_plane import gain_plane
from replicate.loops.notation import parse_plant
from replicate.loops.time_domain.slow_signal import SlowSignal


def heat(s: Any) -> Any:
    return np.exp(-np.sqrt(s))


LAG = Plant.foptd(1.0, 1.0, 1.0)
SEVERAL = Plant.from_terms([([1.0], [1.0, 1.0], 0.0), ([1.0], [1.0, 1.0], 1.0)])
FUNCTION = Plant.from_function(heat)
LOOP = Loop(LAG, PI(0.3, 0.2))

MADE: dict[str, Any] = {
    "lag": lambda: Plant.foptd(1.0, 1.0, 1.0),
    "several dead times": lambda: Plant.from_terms([([1.0], [1.0], 1.0), ([0.5], [1.0], 2.0)]),
    "function": lambda: Plant.from_function(heat, dead_time=0.5),
    "text": lambda: parse_plant("e^{-sqrt(s)}"),
    "function, sum": lambda: Plant.from_function(heat) + LAG,
    "function, product": lambda: Plant.from_function(heat) * LAG,
    "function, scaled": lambda: 2.0 * Plant.from_function(heat),
    "function, negative": lambda: -Plant.from_function(heat),
    "PI": lambda: PI(0.3, 0.2, b=0.5),
    "PID": lambda: PID(0.3, 0.2, 0.1, measurement_filter=((1.0,), (0.5, 1.0, 1.0))),
    "predictor": lambda: SmithPredictor(PI(1.0, 1.0), LAG),
    "loop": lambda: Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.3, 0.2)),
    "loop around a function": lambda: Loop(Plant.from_function(heat), PI(0.3, 0.2)),
    "loop with a predictor": lambda: Loop(LAG, SmithPredictor(PI(1.0, 1.0), LAG)),
    "signal": lambda: Loop(LAG, PI(0.3, 0.2)).step(),
    "signal without a final value": lambda: Loop(Plant([1.0, 0.0], [1.0, 1.0], 1.0), PI(0.3, 0.2)).step(until=3.0),
    "slow signal": lambda: Loop(FUNCTION, PI(0.3, 0.2)).step(),
    "response": lambda: Loop(LAG, PI(0.3, 0.2)).respond(),
    "limited response": lambda: Loop(LAG, PI(0.3, 0.2)).saturated(limits=(-0.5, 1.0)),
    "margins": lambda: Loop(LAG, PI(0.3, 0.2)).margins(),
    "summary": lambda: Loop(LAG, PI(0.3, 0.2)).summary(),
    "summary of an unstable loop": lambda: Loop(LAG, PI(9.0, 9.0)).summary(),
    "bode": lambda: Loop(LAG, PI(0.3, 0.2)).bode([0.1, 1.0]),
    "gain plane": lambda: gain_plane(LAG, [0.5, 9.0], [0.1, 0.2]),
    "sweep": lambda: sweep([LAG], [PI(0.3, 0.2), PI(9.0, 9.0)], metrics=["ms", "overshoot"]),
}  # fmt: skip


@pytest.mark.parametrize("name", MADE)
def test_what_is_made_alike_is_equal_and_stays_so_when_copied_and_stored(name: str) -> None:
    one = MADE[name]()
    for other in (MADE[name](), copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one))):  # noqa: S301
        assert one == other
        assert hash(one) == hash(other)
        assert repr(one) == repr(other)
    assert len({one, MADE[name]()}) == 1


def test_different_things_are_not_equal() -> None:
    made = [make() for make in MADE.values()]
    for i, one in enumerate(made):
        assert [one == other for other in made] == [i == j for j in range(len(made))]
        assert one != None  # noqa: E711  -- the operator is what is tested
        assert one != 3
        assert one != "one"


def test_a_pi_controller_is_a_pid_controller_without_derivative_part() -> None:
    assert PI(1.0, 2.0, b=0.5) == PID(1.0, 2.0, b=0.5)
    assert PID(1.0, 2.0) == PI(1.0, 2.0)
    assert hash(PI(1.0, 2.0)) == hash(PID(1.0, 2.0))
    assert PI(1.0, 2.0) != PID(1.0, 2.0, 0.1)
    assert Loop(LAG, PI(0.3, 0.2)) == Loop(LAG, PID(0.3, 0.2))


def test_changes_of_sign_and_scale_that_cancel_give_the_same_plant() -> None:
    for plant in (LAG, SEVERAL, FUNCTION):
        assert plant * -1.0 == -plant
        assert -plant * -1.0 == plant
        assert (plant * 2.0) * 0.5 == plant
        assert plant * 1.0 == plant == plant + 0.0


def test_a_stored_response_still_knows_whether_its_loop_is_stable() -> None:
    y = pickle.loads(pickle.dumps(LOOP.step()))  # noqa: S301
    assert y.settling_time() == LOOP.step().settling_time()
    with pytest.raises(ValueError, match="unstable"):
        pickle.loads(pickle.dumps(Loop(LAG, PI(9.0, 9.0)).step(until=3.0))).overshoot()  # noqa: S301
    slow = Loop(FUNCTION, PI(0.3, 0.2)).step()
    assert isinstance(slow, SlowSignal)
    assert pickle.loads(pickle.dumps(slow)).ie() == slow.ie()  # noqa: S301
    around_lambda = Loop(Plant.from_function(lambda s: 1.0 / (1.0 + np.sqrt(s))), PI(0.3)).step(until=3.0)
    assert pickle.loads(pickle.dumps(around_lambda)) == around_lambda  # noqa: S301  -- without its function


def test_what_results_were_computed_from_cannot_be_changed() -> None:
    for thing, name in ((LAG, "dead_time"), (SEVERAL, "dead_time"), (FUNCTION, "function"), (LOOP, "plant"),
                        (LOOP.controller, "k"), (LOOP.step(), "final")):  # fmt: skip
        with pytest.raises(AttributeError, match="cannot"):
            setattr(thing, name, 1.0)
        with pytest.raises(AttributeError, match="cannot"):
            delattr(thing, name)
    for array in (LAG.num, LAG.den, LOOP.step().breaks, LOOP.step().coefficients):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0.0

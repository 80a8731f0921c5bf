"""Responses of many pieces, which powers of one matrix carry on together, against closed forms."""

from __future__ import annotations

import tracemalloc

import mpmath as mp
import numpy as np
import pytest

from loops.closed_forms import pi_foptd, rational_step
from replicate.loops import PI, PID, Loop, LoopError, Plant, step_responses
from replicate.loops.time_domain import many_pieces
from replicate.loops.time_domain.method_of_steps import MOST_ALONE


@pytest.mark.parametrize("most", [1, 5, 40, 2000])
def test_a_vector_is_carried_as_far_as_by_one_step_after_the_other(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_pieces, "TOGETHER", most)
    fibonacci = [0, 1]
    while len(fibonacci) < 71:
        fibonacci.append(fibonacci[-1] + fibonacci[-2])  # up to 2e14: exact in floats
    for count in (1, 2, 3, 4, 7, 16, 33, 70):
        columns = many_pieces.carried(np.array([[1.0, 1.0], [1.0, 0.0]]), np.array([1.0, 0.0]), count)
        assert columns.tolist() == [fibonacci[1 : count + 1], fibonacci[:count]]


@pytest.mark.parametrize(("lag", "splits"), [(1.0, 1), (0.2, 2), (0.1, 3), (0.04, 8)])
@pytest.mark.parametrize("until", [1.5, 4.0, 4.3, 11.2, 30.5])
def test_dead_time_of_several_pieces(lag: float, splits: int, until: float) -> None:
    y = Loop(Plant.foptd(1.0, lag, 1.0), PI(0.2, 0.4)).step(until=until)
    assert abs(y.breaks[1] - 1.0 / splits) < 1e-15
    t = until * np.array([0.3, 0.77, 1.0])
    exact = [float(pi_foptd(1.0, lag, 1.0, k=0.2, ki=0.4, t=float(time))) for time in t]
    assert np.max(np.abs(y(t) - exact)) < 1e-12


def test_a_short_filter_takes_no_map_of_a_whole_dead_time() -> None:
    # of 300 pieces, which would be 250 MB and take some hundred times as long as one piece after the other
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PID(0.3, 0.4, 0.25, derivative_filter=1e-3))
    tracemalloc.start()
    try:
        assert loop.step(until=6.0).breaks.size > 1000
        assert tracemalloc.get_traced_memory()[1] < 2e7
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("dead_time", [0.0, 0.5])
def test_integrators_without_feedback(dead_time: float) -> None:
    # a pole at s = 0: the load is integrated once or twice, and nothing comes to rest
    t = np.array([0.3, 7.7, 60.0])
    for order in (1, 2):
        y = Loop(Plant([1.0], [1.0, *[0.0] * order], dead_time), PI(0.0)).load_step(until=60.0)
        exact = np.maximum(t - dead_time, 0.0) ** order / order
        assert np.max(np.abs(y(t) - exact)) < 1e-12 * exact.max()


def test_several_controllers_are_as_one_alone() -> None:
    plant, t = Plant.foptd(1.0, 0.1, 1.0), np.array([3.0, 11.2])
    gains = [(0.1 + 0.02 * j, 0.2 + 0.03 * j) for j in range(MOST_ALONE + 1)]
    for count in (3, MOST_ALONE + 1):
        found = step_responses(plant, [PI(k, ki) for k, ki in gains[:count]], until=11.2)
        exact = [[float(pi_foptd(1.0, 0.1, 1.0, k=k, ki=ki, t=float(at))) for at in t] for k, ki in gains[:count]]
        assert np.max(np.abs(np.array([y(t) for y in found]) - exact)) < 1e-12


@pytest.mark.parametrize("count", [1, MOST_ALONE + 1])
@pytest.mark.parametrize("until", [2.0, 30.0])
def test_controllers_without_gain(count: int, until: float) -> None:
    found = step_responses(Plant.foptd(1.0, 2.0, 1.0), [PI(0.0)] * count, until=until, setpoint=0.0, load=1.0)
    for y in found:
        assert abs(float(y(until)) + np.expm1(0.5 - 0.5 * until)) < 1e-14


@pytest.mark.parametrize("until", [3.0, 40.0, 900.0])
def test_loop_without_dead_time(until: float) -> None:
    # (0.6 s + 0.4) / (s (s + 1) (s + 2) (s + 8) + 0.6 s + 0.4)
    y = Loop(Plant([1.0], [1.0, 11.0, 26.0, 16.0]), PI(0.6, 0.4)).step(until=until)
    t = until * np.array([0.01, 0.1, 0.33, 0.72, 1.0])
    exact = [float(mp.re(rational_step([0.6, 0.4], [1.0, 11.0, 26.0, 16.6, 0.4], float(time)))) for time in t]
    assert np.max(np.abs(y(t) - exact)) < 1e-13


@pytest.mark.parametrize("until", [1500.0, 5000.0])
def test_an_unstable_loop_that_nothing_excites_stays_at_rest(until: float) -> None:
    growing = Loop(Plant([1.0], [1.0, -1.0]), PID(0.5, 0.0, b=0.0))
    assert not growing.is_stable()
    assert not growing.step(until=until).coefficients.any()
    with pytest.raises(LoopError, match="the response grows beyond"):
        growing.load_step(until=until)

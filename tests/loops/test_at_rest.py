"""Values and slopes at rest of functions with a branch point there, in closed form; what follows for loops."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, LoopError, Plant
from replicate.loops.plants.at_rest import slope_at_rest, value_at_rest
from replicate.loops.plants.cut import begin_of_cut

Function = Callable[[Any], Any]
INF = np.inf

#: Function, f(0), f'(0).
FUNCTIONS: dict[str, tuple[Function, float, float]] = {
    "lag": (lambda s: (3.0 - s) / (1.0 + 2.0 * s + s * s), 3.0, -7.0),
    "a power above one": (lambda s: 2.0 / (1.0 + s**1.2), 2.0, 0.0),
    "a power below one": (lambda s: 1.0 / (1.0 + s**0.8), 1.0, -INF),
    "one and a power above": (lambda s: 1.0 / (1.0 + s + s**1.2), 1.0, -1.0),
    "one and a power just above": (lambda s: 1.0 / (1.0 + s + s**1.01), 1.0, -1.0),
    "one and a power just below": (lambda s: 1.0 / (1.0 + s - s**0.99), 1.0, INF),
    "several powers": (lambda s: 1.0 / (1.0 + 2.0 * s + s**1.3 - s**1.7 + 2.0 * s**2), 1.0, -2.0),
    "one and a half": (lambda s: 1.0 / (1.0 + s + s**1.5), 1.0, -1.0),
    "a tenth": (lambda s: 1.0 / (1.0 + s**0.1), 1.0, -INF),
    "one and a logarithm above": (lambda s: 1.0 / (1.0 + s + s * s * np.log(1.0 + 1.0 / s)), 1.0, -1.0),
    "a logarithm": (lambda s: 1.0 / (1.0 + s * np.log(1.0 + 1.0 / s)), 1.0, -INF),
    "no cut at rest": (lambda s: (1.0 + s) ** -0.5, 1.0, -0.5),
    "diffusion": (lambda s: 1.0 / np.cosh(np.sqrt(s)), 1.0, -0.5),
    "digits lost": (lambda s: (1.0 - np.exp(-s)) / s, 1.0, -0.5),
    "an integrator": (lambda s: (1.0 - np.exp(-s)) / s**2, INF, np.nan),
    "half an integrator": (lambda s: s**-0.5, INF, np.nan),
    "a logarithm alone": (lambda s: np.log(1.0 + 1.0 / s), INF, np.nan),
    "the inverse of a logarithm": (lambda s: 1.0 / (1.0 + 1.0 / np.log(1.0 + 1.0 / s)), np.nan, np.nan),
}


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e12])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_value_and_slope_at_rest(name: str, unit: float) -> None:
    function, value, slope = FUNCTIONS[name]
    assert value_at_rest(lambda s: function(s * unit), 1.0 / unit) == pytest.approx(value, rel=1e-12, nan_ok=True)
    if not np.isnan(slope):
        found = slope_at_rest(lambda s: function(s * unit), 1.0 / unit) / unit
        assert found == pytest.approx(slope, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("function", "begin"),
    [
        (lambda s: 1.0 / np.cosh(np.sqrt(s)), INF),  # even in the square root
        (lambda s: np.exp(-s) / (1.0 + s * s), INF),
        (lambda s: (1.0 + s) ** -0.5, 1.0),
        (lambda s: np.exp(-np.sqrt(s)), 0.0),
        (lambda s: 1.0 / (1.0 + s + s**1.01), 0.0),
    ],
)
def test_where_a_cut_begins(function: Function, begin: float) -> None:
    assert begin_of_cut(function, 1.0) == pytest.approx(begin, rel=0.1, abs=1e-8)


@pytest.mark.parametrize("dead_time", [0.0, 0.2])
@pytest.mark.parametrize(
    "name", ["a power above one", "a power below one", "one and a power above", "several powers", "diffusion"]
)
def test_integrated_error_without_integral_action(name: str, dead_time: float) -> None:
    """The first coefficient of y_inf - s Y at s = 0, with G = e^{-sL} (g + g' s), C = k."""
    function, gain, slope = FUNCTIONS[name]
    k, slope = 0.3, slope - dead_time * gain
    loop = Loop(Plant.from_function(function, dead_time=dead_time), PI(k))
    assert loop.step().ie() == pytest.approx(-k * slope / (1.0 + k * gain) ** 2, rel=1e-11, abs=0.0)
    assert loop.load_step().ie() == pytest.approx(-slope / (1.0 + k * gain) ** 2, rel=1e-11, abs=0.0)


def test_integrated_error_with_filters() -> None:
    # G = 1/s^1.3 is at rest like an integrator that leaves no error: what is left are the filters' lags
    controller = PID(0.3, 0.0, 0.1, c=1.0, measurement_filter=0.1, setpoint_filter=0.2)
    loop = Loop(Plant.from_function(lambda s: s**-1.3), controller)
    assert loop.step().ie() == pytest.approx(0.2 - 0.1, rel=1e-12)  # y (1 - 0.1 s) = r (1 - 0.2 s), nearly


def test_a_function_that_loses_its_digits_towards_rest_is_named() -> None:
    loop = Loop(Plant.from_function(lambda s: (1.0 - np.exp(-np.sqrt(s))) / np.sqrt(s)), PI(0.3))
    with pytest.raises(LoopError, match="loses its digits at"):
        loop.step()


@pytest.mark.parametrize("k", [0.01, 0.3, 0.9])
def test_a_weak_loop_has_the_poles_near_those_of_its_function(k: float) -> None:
    loop = Loop(Plant.from_function(lambda s: 1.0 / np.cosh(np.sqrt(s))), PI(k))
    turns = np.array([np.arccos(-k), 2.0 * np.pi - np.arccos(-k), 2.0 * np.pi + np.arccos(-k)])
    assert loop.poles(3).real == pytest.approx(-(turns**2), rel=1e-12)  # cos(x) = -k at s = -x^2
    rational = Loop(Plant.from_function(lambda s: 1.0 / ((1.0 + s) * (1.0 + 0.1 * s))), PI(k))
    assert rational.poles(2).real == pytest.approx(np.sort(np.roots([0.1, 1.1, 1.0 + k]))[::-1], rel=1e-12)


def test_the_value_at_rest_belongs_to_every_peak() -> None:
    # 0/0 at s = 0, where the complementary sensitivity is largest
    loop = Loop(Plant.from_function(lambda s: np.tanh(np.sqrt(s)) / np.sqrt(s)), PI(0.4))
    peak = loop.complementary_peak()
    assert peak.value == pytest.approx(0.4 / 1.4, rel=1e-14)
    assert peak.frequency == 0.0

"""Bounds on the responses of all loops of a box, against single loops simulated in state space or by steps of Euler."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest
from scipy import signal

from replicate.loops import Plant
from replicate.loops.bounds.gain_boxes import GainBox
from replicate.loops.bounds.intervals import Interval, exactly
from replicate.loops.bounds.response_boxes import ResponseBox, load_responses, setpoint_errors

Array = np.ndarray
Triple = tuple[float, float, float]

LAGS = np.array([1.0, 3.0, 3.0, 1.0])  # (s + 1)^3
PLANT = Plant([1.0], LAGS)
MIDDLE: Triple = (1.2, 0.6, 0.7)
HALF: Triple = (0.0005, 0.0005, 0.0005)
T = np.linspace(0.0, 60.0, 12001)


def box(middle: Triple = MIDDLE, half: Triple = HALF) -> GainBox:
    k, ki, kd = (Interval(m - h, m + h) for m, h in zip(middle, half, strict=True))
    return GainBox(k, ki, kd)


def loops(middle: Triple = MIDDLE, half: Triple = HALF) -> list[Triple]:
    signs = [*product((-1.0, 1.0), repeat=3), *np.random.default_rng(2).uniform(-1.0, 1.0, (6, 3))]
    return [tuple(m + s * h for m, s, h in zip(middle, sign, half, strict=True)) for sign in signs]


@cache
def simulated(gains: Triple, numerator: tuple[float, ...]) -> Array:
    """Return a closed-loop step response: numerator over s (s+1)^3 + kd s^2 + k s + ki."""
    k, ki, kd = gains
    _, y = signal.step((numerator, np.polyadd([*LAGS, 0.0], [kd, k, ki])), T=T)
    return np.asarray(y)


def load(gains: Triple) -> Array:
    return simulated(gains, (1.0, 0.0))


def error(gains: Triple) -> Array:
    k, ki, kd = gains
    return 1.0 - simulated(gains, (kd, k, ki))


def found(kind: str, middle: Triple = MIDDLE, half: Triple = HALF) -> ResponseBox:
    made = (load_responses if kind == "load" else setpoint_errors)(PLANT, box(middle, half))
    assert made is not None
    return made


@pytest.mark.parametrize("kind", ["load", "error"])
def test_every_response_of_a_box_is_within_the_bounds(kind: str) -> None:
    bounds = found(kind)
    lower, upper = bounds.between(T)
    inside = bounds.middle.horizon >= T
    for gains in loops():
        y = load(gains) if kind == "load" else error(gains)
        assert np.all(np.abs(y - bounds.middle(T))[inside] <= bounds.spread(T)[inside] + 1e-9)
        assert np.all((lower <= y[:-1] + 1e-9) & (y[1:] <= upper + 1e-9) | ~inside[1:])
    assert bounds.spread(0.0) < 0.005  # and they say something
    assert bounds.spread(20.0) < 0.2 * bounds.spread(0.0)  # of the end more than of the beginning


def settled(y: Array, level: float, one_sided: bool = False) -> float:
    outside = np.nonzero((y if one_sided else np.abs(y)) > level)[0]
    return float(T[outside[-1]]) if outside.size else 0.0


@pytest.mark.parametrize(("level", "one_sided"), [(0.02, False), (0.05, True)])
def test_no_interval_in_which_some_loop_settles_is_excluded(level: float, one_sided: bool) -> None:
    bounds = found("load")
    times = [settled(load(gains), level, one_sided) for gains in loops()]
    for time in times:
        assert not bounds.never_settles_between(time - 0.01, time + 0.01, level, one_sided=one_sided)
    for factor in (0.9, 1.15):  # while others are
        wrong = factor * (min(times) if factor < 1.0 else max(times))
        assert bounds.never_settles_between(wrong, wrong + 0.02, level, one_sided=one_sided)


def test_a_response_below_the_level_settles_at_no_later_time() -> None:
    # with high gain the load never moves the output by 0.5
    assert max(float(load(gains).max()) for gains in loops()) < 0.5
    assert found("load").never_settles_between(1.0, 5.0, 0.5)


def test_peak_and_first_reach_hold_those_of_every_loop() -> None:
    errors = found("error")
    peaks = [float(error(gains).min()) for gains in loops()]
    assert errors.trough().low <= min(peaks)
    assert max(peaks) <= errors.trough().high + 1e-6  # the simulation has samples only
    assert errors.trough().high - errors.trough().low < 0.05
    for level in (0.9, 0.1):
        times = [float(T[np.nonzero(error(gains) <= level)[0][0]]) for gains in loops()]
        reached = errors.first_below(level)
        assert reached.low <= min(times)
        assert max(times) <= reached.high + T[1]
        assert reached.high - reached.low < 0.5


def test_a_level_that_is_never_reached_is_never_reached() -> None:
    assert found("error").first_below(-0.9).low == np.inf


def test_narrow_boxes_have_narrow_bounds() -> None:
    wide, narrow = (found("load", half=(size, size, size)).spread(5.0) for size in (1e-2, 1e-4))
    assert narrow == pytest.approx(wide / 100.0, rel=0.2)


def test_with_dead_time_against_steps_of_euler() -> None:
    # e^-s/(s + 1) under PI: y' = -y + u(t - 1) + 1(t - 1) for a load step, u = -k y - ki int y
    plant, half = Plant([1.0], [1.0, 1.0], dead_time=1.0), (0.003, 0.003)
    gains = GainBox(Interval(0.5 - half[0], 0.5 + half[0]), Interval(0.4 - half[1], 0.4 + half[1]))
    bounds = load_responses(plant, gains)
    assert bounds is not None
    step = 1e-3
    delay = round(1.0 / step)
    for k, ki in product((0.497, 0.503), (0.397, 0.403)):
        y, integral = np.zeros(20001), 0.0
        u = np.zeros(20001)
        for i in range(20000):
            late = 1.0 + u[i - delay] if i >= delay else 0.0
            y[i + 1] = y[i] + step * (late - y[i])
            integral += step * y[i]
            u[i + 1] = -k * y[i + 1] - ki * integral
        times = step * np.arange(20001)
        assert np.all(np.abs(y - bounds.middle(times)) <= bounds.spread(times) + 2e-3)  # Euler's error
    assert bounds.spread(0.0) < 0.1


def test_nothing_is_said_of_a_box_that_holds_an_unstable_loop() -> None:
    # (s + 1)^3 under proportional gain is unstable for k > 8
    assert load_responses(PLANT, box((7.0, 0.5, 0.0), (2.0, 0.1, 0.0))) is None
    assert setpoint_errors(PLANT, box((9.0, 0.5, 0.0), (0.1, 0.1, 0.0))) is None


def test_a_filter_is_refused() -> None:
    filtered = GainBox(Interval(1.0, 1.1), Interval(0.5, 0.6), exactly(0.5), exactly(0.1), 1)
    with pytest.raises(ValueError, match="filter; allowed: none"):
        load_responses(PLANT, filtered)

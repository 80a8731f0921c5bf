"""Closed-loop poles and stability: Lambert W, the argument principle, and Newton's method in mpmath."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from loops.closed_forms import foptd_p_pole, integrator_p_pole
from loops.problems import PROBLEMS, ROOT_PI, ROOT_POLES, STABLE, root_plant_function
from loops.references import characteristic, polished_root, zeros_right_of
from replicate.loops import PI, PID, Loop, Plant


def same_pole(pole: complex, expected: mp.mpc, rel: float = 1e-12) -> bool:
    expected = complex(expected)
    distance = abs(complex(pole.real, abs(pole.imag)) - complex(expected.real, abs(expected.imag)))
    return distance <= float(rel * abs(expected))


@pytest.mark.parametrize("dead_time", [0.05, 1.0, 20.0])
@pytest.mark.parametrize("product", [0.1, 0.36, 0.5, 1.5, 1.6, 5.0])
def test_integrating_plant_under_proportional_control(dead_time: float, product: float) -> None:
    k = product / dead_time  # stable for k L < pi/2; real poles for k L < 1/e
    loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=dead_time), PI(k=k))
    assert same_pole(loop.rightmost_pole(), integrator_p_pole(1.0, dead_time, k))
    assert loop.is_stable() == (product < np.pi / 2)


@pytest.mark.parametrize("dead_time", [0.05, 0.2, 1.0, 5.0, 50.0])
@pytest.mark.parametrize("k", [0.3, 0.95, 1.05, 3.0, -0.5])
def test_first_order_plant_under_proportional_control(dead_time: float, k: float) -> None:
    loop = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=dead_time), PI(k=k))
    pole = foptd_p_pole(1.0, 1.0, dead_time, k)
    assert same_pole(loop.rightmost_pole(), pole)
    assert loop.is_stable() == (pole.real < 0)


def test_multiple_poles() -> None:
    # k/(s (s + 4)) and e^{-s-1}/s have the double poles -2 and -1, 1/(s^3 + 3 s^2 + 3 s) a triple one at -1;
    # rounding splits an n-fold pole by the n-th root of 1e-16
    assert same_pole(Loop(Plant([1.0], [1.0, 4.0, 0.0]), PI(k=4.0)).rightmost_pole(), -2.0, rel=1e-6)
    loop = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(k=float(np.exp(-1.0))))
    assert same_pole(loop.rightmost_pole(), -1.0, rel=1e-6)
    loop = Loop(Plant([1.0], [1.0, 3.0, 3.0, 0.0]), PI(k=1.0))
    assert same_pole(loop.rightmost_pole(), -1.0, rel=1e-4)


@pytest.mark.parametrize("dead_time", [0.1, 10.0, 100.0, 1e4])
def test_a_double_pole_that_rounding_makes_a_pair(dead_time: float) -> None:
    # Ti = T leaves k e^{-sL}/s, with the double pole -1/L for k L = 1/e
    k = float(np.exp(-1.0)) / dead_time
    pole = Loop(Plant.foptd(1.0, 1.0, dead_time), PI(k, k)).rightmost_pole()
    assert same_pole(pole, -min(1.0, 1.0 / dead_time), rel=1e-7)
    assert pole.imag == 0.0


def test_a_pole_at_rest_that_the_controller_does_not_move() -> None:
    # s/(s + 1) under integral action, and an integrator without feedback
    assert Loop(Plant([1.0, 0.0], [1.0, 1.0], 1.0), PI(0.5, 0.3)).rightmost_pole() == 0.0
    assert Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(0.0)).rightmost_pole() == 0.0


@pytest.mark.parametrize("name", PROBLEMS)
def test_rightmost_pole_is_a_pole_and_none_lies_to_its_right(name: str) -> None:
    problem = PROBLEMS[name]
    pole = complex(problem.loop.rightmost_pole())
    function = characteristic(problem.reference)
    # (s+1)^8 has its open-loop poles in one place: no multiple poles in closed loop, so that Newton's method is safe
    assert same_pole(pole, polished_root(function, pole), rel=1e-10)
    margin = 1e-4 * abs(pole)
    assert zeros_right_of(function, pole.real + margin) == 0
    assert zeros_right_of(function, pole.real - margin) in (1, 2)
    assert problem.loop.is_stable() == (pole.real < 0)


def test_pole_of_root_plant() -> None:
    k, ki = ROOT_PI
    loop = Loop(Plant.from_function(root_plant_function), PI(k=k, ki=ki))
    pole = polished_root(lambda s: s + (k * s + ki) * mp.exp(-mp.sqrt(s)), ROOT_POLES[0])
    assert same_pole(loop.rightmost_pole(), pole, rel=1e-9)
    assert loop.is_stable()


def test_root_plant_limit_of_stability() -> None:
    # arg e^{-sqrt(iw)} = -sqrt(w/2) = -pi gives w = 2 pi^2, and there |P| = e^{-pi}
    limit = float(mp.exp(mp.pi))
    assert Loop(Plant.from_function(root_plant_function), PI(k=0.999 * limit)).is_stable()
    assert not Loop(Plant.from_function(root_plant_function), PI(k=1.001 * limit)).is_stable()


@pytest.mark.parametrize("order", [3, 4, 8])
def test_limit_of_stability_of_multiple_lags(order: int) -> None:
    # 1/(s+1)^n: arg = -pi at tan(pi/n), where the gain is cos(pi/n)^n
    limit = 1.0 / np.cos(np.pi / order) ** order
    plant = Plant([1.0], np.poly(-np.ones(order)))
    assert Loop(plant, PI(k=limit * (1 - 1e-6))).is_stable()
    assert not Loop(plant, PI(k=limit * (1 + 1e-6))).is_stable()


@given(st.floats(0.01, 1.55), st.floats(1e-3, 1e3), st.floats(1e-2, 1e2))
def test_limit_of_stability_of_integrating_plants(product: float, gain: float, dead_time: float) -> None:
    plant = Plant([gain], [1.0, 0.0], dead_time=dead_time)
    assert Loop(plant, PI(k=product / gain / dead_time)).is_stable()
    assert not Loop(plant, PI(k=(np.pi - product + 0.01) / gain / dead_time)).is_stable()


@pytest.mark.parametrize("excess", [1e-6, 1e-3, 0.1])
def test_unstable_plant_needs_enough_gain(excess: float) -> None:
    plant = Plant([1.0], [1.0, -1.0], dead_time=0.2)
    assert Loop(plant, PI(k=1 + excess)).is_stable()
    assert not Loop(plant, PI(k=1 - excess)).is_stable()


def test_hidden_mode_of_an_unstable_plant_counts() -> None:
    # the controller's zero cancels the plant's unstable pole: the loop transfer function 0.5 e^{-s}/s looks harmless
    loop = Loop(Plant([1.0], [1.0, -1.0], dead_time=1.0), PI(k=0.5, ki=-0.5))
    assert not loop.is_stable()


@pytest.mark.parametrize(("kd", "stable"), [(0.9, True), (0.999, True), (1.001, False)])
def test_neutral_loop_is_unstable_when_its_jumps_grow(kd: float, stable: bool) -> None:
    # jumps of u shrink by kd K / T from one dead time to the next; with k = kd, ki = 0 the loop is kd e^{-s}
    loop = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), PID(k=kd, ki=0.0, kd=kd))
    assert loop.is_stable() == stable


@pytest.mark.parametrize("name", STABLE)
def test_time_scaling_scales_poles(name: str) -> None:
    r, c = PROBLEMS[name].reference, 7.3
    den = [a * c ** (len(r.den) - 1 - i) for i, a in enumerate(r.den)]
    num = [a * c ** (len(r.num) - 1 - i) for i, a in enumerate(r.num)]
    slow = Loop(
        Plant(num, den, dead_time=c * r.dead_time),
        PID(
            k=r.k,
            ki=r.ki / c,
            kd=r.kd * c,
            derivative_filter=c * r.derivative_filter,
            measurement_filter=c * r.measurement_filter,
            measurement_filter_order=r.measurement_filter_order,
        ),
    )
    assert same_pole(slow.rightmost_pole(), PROBLEMS[name].loop.rightmost_pole() / c, rel=1e-8)


# ---- as many poles as are asked for, and all of them -----------------------------------------------------------------

#: Terms of a plant over a common denominator: the denominator, and (numerator, dead time) of each term.
MANY = {
    "lag": ([1.0, 1.0], [([1.0], 1.0)]),
    "eight lags": (np.poly([-1.0] * 8).tolist(), [([1.0], 1.0)]),
    "two dead times": ([2.0, 3.0, 1.0], [([2.0, 1.0], 0.5), ([0.5, 0.5], 1.3)]),
    "three dead times": (
        [1.0, 2.5, 2.0, 0.5],
        [([1.0, 1.5, 0.5], 1.0), ([0.7, 0.35], 2.0**0.5), ([0.3, 0.6, 0.3], 0.9)],
    ),
    "one term without": ([1.0, 1.0], [([1.0], 0.0), ([0.5], 1.0)]),
}


@pytest.mark.parametrize("count", [1, 3, 5, 12, 30])
@pytest.mark.parametrize("name", MANY)
def test_as_many_poles_as_are_asked_for_and_none_is_missing(name: str, count: int) -> None:
    den, terms = MANY[name]
    loop = Loop(Plant.from_terms([(num, den, dead_time) for num, dead_time in terms]), PI(0.3, 0.2))
    poles = loop.poles(count)
    assert poles.size == count

    def function(s: np.ndarray) -> np.ndarray:
        fed_back = sum(np.polyval(num, s) * np.exp(-s * dead_time) for num, dead_time in terms)
        return np.asarray(s * np.polyval(den, s) + (0.3 * s + 0.2) * fed_back)

    further = loop.poles(count + 6).real
    last = poles[-1].real
    line = 0.5 * (last + float(np.max(further[further < last - 1e-6 * abs(last)])))
    radius = 30.0 + 3.0 * float(np.max(np.abs(poles)))
    assert zeros_right_of(function, line, radius) == sum(2 if pole.imag else 1 for pole in poles)


def test_poles_of_a_hold_at_any_number() -> None:
    # (1 - e^{-s})/s under P: s = -k (1 - e^{-s}) in closed form, s + k = W_m(k e^k), without the removable s = 0
    k = 0.4
    loop = Loop(Plant.from_terms([([1.0], [1.0, 0.0], 0.0), ([-1.0], [1.0, 0.0], 1.0)]), PI(k))
    exact = [complex(mp.lambertw(k * mp.exp(k), m)) - k for m in range(-1, 40)]
    exact = sorted((s for s in exact if s.imag >= 0.0 and abs(s) > 1e-9), key=lambda s: -s.real)[:25]
    assert np.max(np.abs(loop.poles(25) - np.array(exact)) / np.abs(exact)) < 1e-12

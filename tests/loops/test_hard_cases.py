"""Loops that break solvers: multiple and missing poles, kinks, ties, static loops, short filters, state-space models.

Expected values are closed forms, given with each test, or come from mpmath.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import control
import mpmath as mp
import numpy as np
import pytest
import scipy.signal

from loops.references import de_hoog
from replicate.loops import PI, PID, Loop, LoopError, Plant, design_pi

FOPTD = Plant.foptd(1.0, 1.0, 1.0)
NAN, INF = float("nan"), float("inf")


# ---- poles -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_critically_damped_loop_has_its_double_pole(unit: float) -> None:
    # Ti = T leaves s + k e^{-s}, with k = 1/e a double zero at s = -1, on the cancelled pole of the plant
    k = 1.0 / math.e
    loop = Loop(Plant.foptd(1.0, unit, unit), PI(k, k / unit))
    assert abs(loop.rightmost_pole() * unit + 1.0) < 1e-10
    assert loop.horizon() / unit == pytest.approx(38.0, rel=1e-3)
    second = complex(mp.lambertw(-1 / mp.e, 1))
    assert abs(loop.poles(2)[1] * unit - second) < 1e-10 * abs(second)


def test_the_rightmost_poles_are_complete() -> None:
    # s + 1 + 3/2 e^{-s} = 0 at s = W_n(-3/2 e) - 1
    expected = [complex(mp.lambertw(mp.mpf(-1.5) * mp.e, n)) - 1.0 for n in range(12)]
    found = Loop(FOPTD, PI(1.5)).poles(12)
    assert np.max(np.abs(found - np.array(expected))) < 1e-10 * 70.0


def test_equal_real_parts_belong_to_the_lowest_frequency() -> None:
    # e^{-s} under k = 0.6: s = log(0.6) + i pi (2 n + 1)
    loop = Loop(Plant([1.0], [1.0], 1.0), PI(0.6))
    expected = np.log(0.6) + 1j * np.pi * np.array([1.0, 3.0, 5.0])
    assert np.max(np.abs(loop.poles(3) - expected)) < 1e-9


def test_pole_of_eight_equal_lags_cancelled_but_one() -> None:
    loop = Loop(Plant([1.0], np.poly([-1.0] * 8), 1.0), PI(0.25, 0.25))
    assert min(abs(loop.poles(6) + 1.0)) < 1e-9  # seven cancelled poles at -1


# ---- responses -------------------------------------------------------------------------------------------------------


def test_kinks_and_jumps_are_extrema() -> None:
    # on [0, 1] u = 1.5 + 0.2 t, then the output arrives and u falls
    extrema = Loop(FOPTD, PI(1.5, 0.2)).respond().control.extrema()
    assert extrema[0].value == pytest.approx(1.7, rel=1e-14)
    assert extrema[0].time == 1.0
    # e^{-s} under k = 0.5: the output is 0.5, 0.25, 0.375, ... on intervals of length one
    steps = Loop(Plant([1.0], [1.0], 1.0), PI(0.5)).step(until=4.5).extrema()
    assert [(round(float(e), 12), e.time) for e in steps] == [(0.5, 1.0), (0.25, 2.0), (0.375, 3.0)]


def test_a_load_step_in_a_fast_loop() -> None:
    slow = Loop(FOPTD, PI(0.6, 0.5)).respond(load=1.0, load_at=3.3).output
    fast = Loop(Plant.foptd(1.0, 1e-12, 1e-12), PI(0.6, 0.5e12)).respond(load=1.0, load_at=3.3e-12).output
    t = np.linspace(0.1, 30.0, 60)
    assert np.max(np.abs(slow(t) - fast(1e-12 * t))) < 1e-13


def test_a_short_dead_time_in_a_slow_loop() -> None:
    # Ti = T leaves s + k e^{-s L}, with k L = 0.5: the same response for every L, in units of it
    reference = Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(0.5)).step(until=30.0)
    for dead_time in (1e-3, 1e-5, 1e-7):
        y = Loop(Plant.foptd(1.0, 1.0, dead_time), PI(0.5 / dead_time, 0.5 / dead_time)).step()
        t = np.array([1.5, 2.3, 7.1, 19.0])
        assert np.max(np.abs(y(t * dead_time) - reference(t))) < 1e-10
        assert y.overshoot() == pytest.approx(reference.overshoot(), rel=1e-10)
    # a load step: IE = 1/ki, and for a response without sign change IAE is the same
    load = Loop(Plant.foptd(1.0, 1.0, 1e-3), PI(500.0, 500.0)).load_step()
    assert load.iae() == pytest.approx(1.0 / 500.0, rel=1e-10)
    # the integral of t y of a load step is -Y'(0) with Y = G/(1 + L)/s = (1 + s L + ..)/(ki (1 + s) (1 + s/k)...)
    assert load.itae() == pytest.approx((1.0 + 1.0 / 500.0) / 500.0, rel=1e-9)


@pytest.mark.parametrize("order", [11, 12, 13, 20])
def test_a_step_reaches_many_lags_on_time(order: int) -> None:
    # so many integrations make whatever passes them smooth; the pieces must still end where the steps arrive
    k, ki, dead_time = 0.2, 0.012, 0.0225
    loop = Loop(Plant([1.0], np.poly([-1.0] * order), dead_time), PI(k, ki))

    def plant(s: mp.mpc) -> mp.mpc:
        return mp.exp(-s * mp.mpf(dead_time)) / (s + 1) ** order

    def controller(s: mp.mpc) -> mp.mpc:
        return mp.mpf(k) + mp.mpf(ki) / s

    load, step = loop.load_step(until=100.0), loop.step(until=100.0)
    for t in (9.0, 30.0):
        expected = de_hoog(lambda s: plant(s) / s / (1 + plant(s) * controller(s)), t)
        assert load(t) == pytest.approx(float(expected), rel=1e-10)
        expected = de_hoog(lambda s: plant(s) * controller(s) / s / (1 + plant(s) * controller(s)), t)
        assert step(t) == pytest.approx(float(expected), rel=1e-10)


@pytest.mark.parametrize("lag", [1e-3, 1e-6, 1e-7, 1e-8, 1e-9])
def test_a_short_filter_changes_little(lag: float) -> None:
    plain = Loop(FOPTD, PID(1.0, 0.7, 0.3))
    for controller in (PID(1.0, 0.7, 0.3, measurement_filter=lag), PID(1.0, 0.7, 0.3, derivative_filter=lag)):
        loop = Loop(FOPTD, controller)
        assert loop.is_stable()
        step = loop.step(until=6.0)
        assert step.breaks.size < 2000  # not as many as filter constants fit in, whatever the kernels round
        assert abs(step.overshoot() - plain.step(until=6.0).overshoot()) < lag
        assert abs(loop.sensitivity_peak() - plain.sensitivity_peak()) < 2.0 * lag


def test_stiff_loop_without_dead_time() -> None:
    # two lags under unit feedback: s^2 T + s (1 + T) + 2, in closed form
    lag = 1e-8
    y = Loop(Plant([1.0], [lag, 1.0 + lag, 1.0]), PI(1.0)).step(until=12.0)
    slow, fast = (complex(r).real for r in mp.polyroots([lag, 1 + lag, 2], extraprec=200)[::-1])
    t = np.array([1e-8, 0.3, 2.0, 11.0])
    exact = 0.5 + (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (2.0 * (slow - fast))
    assert np.max(np.abs(y(t) - exact)) < 1e-12


def test_measurement_filter_by_polynomials() -> None:
    # 1/(1 + sT + (sT)^2/2), against the same filter as part of the plant under proportional control
    lag, t = 0.4, np.linspace(0.1, 20.0, 40)
    own = Loop(FOPTD, PID(1.0, 0.5, 0.3, b=0.0, measurement_filter=((1.0,), (lag**2 / 2, lag, 1.0))))
    plant = FOPTD * Plant([1.0], [lag**2 / 2, lag, 1.0])
    moved = Loop(plant, PID(1.0, 0.5, 0.3, b=0.0))
    assert abs(own.sensitivity_peak() / moved.sensitivity_peak() - 1.0) < 1e-12
    # a load step enters after the filter in one, before it in the other: the control signals are the same
    a, b = own.respond(setpoint=0.0, load=1.0, until=20.0), moved.respond(setpoint=0.0, load=1.0, until=20.0)
    assert np.max(np.abs(a.control(t) - b.control(t))) < 1e-12
    same = Loop(FOPTD, PI(0.6, 0.5, measurement_filter=((1.0,), (0.04, 0.4, 1.0)))).step(until=20.0)
    usual = Loop(FOPTD, PI(0.6, 0.5, measurement_filter=0.2, measurement_filter_order=2)).step(until=20.0)
    assert np.max(np.abs(same(t) - usual(t))) < 1e-13


# ---- frequency domain ------------------------------------------------------------------------------------------------


def test_limits_belong_to_the_peak() -> None:
    root = Loop(Plant.from_function(lambda s: s**-0.5), PI(1.0, 0.5)).sensitivity_peak()
    assert (root.value, root.frequency) == (1.0, INF)
    lag = Loop(Plant([1.0], [1.0, 1.0]), PI(1.0)).sensitivity_peak()  # (s + 1)/(s + 2)
    assert (lag.value, lag.frequency) == (1.0, INF)


def test_static_loops() -> None:
    loop = Loop(Plant([1.0], [1.0], 0.01), PI(0.0))
    assert loop.sensitivity_peak() == 1.0
    assert loop.poles().size == 0
    assert float(loop.load_step(until=1.0)(0.5)) == pytest.approx(1.0, rel=1e-14)
    with pytest.raises(LoopError, match="give a horizon"):
        loop.load_step()


@pytest.mark.parametrize("time_constant", [1e-8, 1e-4, 1.0, 1e6])
def test_design_for_a_function_with_its_corner_anywhere(time_constant: float) -> None:
    reference = design_pi(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), ms=1.4)
    design = design_pi(Plant.from_function(lambda s: np.exp(-np.sqrt(time_constant * s))), ms=1.4)
    assert design.k == pytest.approx(reference.k, rel=1e-9)
    assert design.ki * time_constant == pytest.approx(reference.ki, rel=1e-9)


# ---- python-control --------------------------------------------------------------------------------------------------


def test_state_space_models_are_the_transfer_functions_they_came_from() -> None:
    for num, den in (
        ([1.0], [1.0, 2.0, 1.0]),
        ([2.0, 1.0], [1.0, 3.0, 3.0, 1.0, 0.0]),
        ([1.0], [1.0, 0.2, 5.0, 0.0, 0.0]),
    ):
        plant = Plant.from_control(control.ss(control.tf(num, den)), 1.0)
        assert plant.num.size == len(num)
        assert plant.integrators == Plant(num, den).integrators
        assert np.allclose(plant.num, num, rtol=1e-12)
        assert np.allclose(plant.den, den, rtol=1e-12, atol=1e-12)


def test_coefficients_that_are_rounding_are_zero() -> None:
    random = np.random.default_rng(1)
    a = np.array([[-2.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # 1/(s (s + 1)^2)
    t = np.linalg.qr(random.normal(size=(3, 3)))[0]
    rotated = control.ss(t.T @ a @ t, t.T @ np.eye(3, 1), np.eye(1, 3, 2) @ t, 0.0)
    plant = Plant.from_control(rotated)
    assert (plant.num.size, plant.integrators) == (1, 1)
    assert np.allclose(plant.den, [1.0, 2.0, 1.0, 0.0], atol=1e-13)
    noisy = Plant.from_control(control.tf([3e-16, -2e-16, 1.0], [1.0, 2.0, 1.0, 1e-16]))
    assert (noisy.num.size, noisy.integrators) == (1, 1)
    # a slow pole that the model really has stays
    assert Plant.from_control(control.ss(np.diag([-1e-9, -1.0]), [[1.0], [1.0]], [[1.0, 1.0]], 0.0)).integrators == 0


# ---- arguments -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [10, 30, 40])
def test_large_state_space_models_keep_all_their_coefficients(order: int) -> None:
    random = np.random.default_rng(order)
    a = -np.diag(np.linspace(0.1, 20.0, order)) + 0.01 * random.normal(size=(order, order))
    system = control.ss(a, random.normal(size=(order, 1)), random.normal(size=(1, order)), 0.0)
    plant = Plant.from_control(system, 0.5)
    for w in (0.01, 0.3, 1.0, 7.0, 50.0):
        direct = (system.C @ np.linalg.solve(1j * w * np.eye(order) - system.A, system.B)).item() * np.exp(-0.5j * w)
        assert complex(plant(1j * w)) == pytest.approx(direct, rel=1e-10)


def test_every_real_number_is_a_number() -> None:
    half: Any = Fraction(1, 2)
    quarter: Any = Decimal("0.25")
    third = Loop(Plant([half], [half, 1], quarter), PI(half, quarter))
    floats = Loop(Plant([0.5], [0.5, 1.0], 0.25), PI(0.5, 0.25))
    assert third.sensitivity_peak() == floats.sensitivity_peak()
    assert third.step(until=7 * half).horizon == 3.5


def refused(ask: Callable[[Any], object], values: tuple[object, ...], words: str) -> dict[str, tuple[Any, str]]:
    return {f"{words.split(' must', maxsplit=1)[0]}: {value!r}": ((lambda v=value: ask(v)), words) for value in values}


WRONG: dict[str, tuple[Callable[[], object], str]] = {
    **refused(
        lambda v: Loop(FOPTD, PI(0.5)).step(until=v),
        (-1.0, NAN, INF, "x", 1j),
        "the horizon until must be a finite time",
    ),
    **refused(PID, (1j, "1", None, [1.0], True), "the controller's k must be a finite number"),
    **refused(
        lambda v: Plant([1.0], [1.0, 1.0], v), ("1", None, 1j, -1.0, NAN), "the dead time must be a finite number >= 0"
    ),
}
WRONG |= {
    "coefficients complex": (lambda: Plant([1j], [1.0, 1.0]), "the plant's numerator must be a list of finite real"),
    "coefficients text": (lambda: Plant("12", [1.0, 1.0]), "the plant's numerator must be"),
    "coefficients none": (lambda: Plant([1.0], None), "the plant's denominator must be"),  # type: ignore[arg-type]
    "a transfer function for a plant": (lambda: Loop(control.tf([1], [1, 1]), PI(1.0)), "must be a Plant"),
    "a number for a controller": (lambda: Loop(FOPTD, 1.0), "must be a PI, PID or SmithPredictor, not float"),  # type: ignore[arg-type]
    "frequency data": (lambda: Plant.from_control(control.frd([1, 2], [1, 2])), "not FrequencyResponseData"),
    "scipy": (lambda: Plant.from_control(scipy.signal.TransferFunction([1], [1, 1])), "not TransferFunctionContinuous"),
    "a number for a system": (lambda: Plant.from_control(3.0), "not float"),
    "a number for a function": (lambda: Plant.from_function(3.0), "must be callable"),  # type: ignore[arg-type]
    "a plant for a design": (lambda: design_pi(3.0, ms=1.4), "must be a Plant, not float"),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_argument_is_named_in_one_line(name: str) -> None:
    ask, words = WRONG[name]
    with pytest.raises(LoopError, match=words) as caught:
        ask()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("unit", [1.0, 1e-9, 2.0**20])
def test_a_gain_crossover_on_the_grid_to_rounding(unit: float) -> None:
    # |L| = 1 to rounding at a frequency of the grid, seen on one side of one computed alone and on the other in a row
    plant = Plant([-unit, 1.0], [unit**2, 2.0 * unit, 1.0], 0.5 * unit)
    for k in np.linspace(0.1, 1.0, 10):
        for ki in np.linspace(0.1, 1.0, 10):
            loop = Loop(plant, PI(k, ki / unit))
            assert loop.is_stable() == (loop.rightmost_pole().real < 0.0)

"""Gain, phase and delay margins against closed forms; every crossover is found, not the first one only."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from loops.problems import PROBLEMS, STABLE, root_plant_function
from loops.references import ReferenceLoop, characteristic, crossing, zeros_right_of
from replicate.loops import PI, PID, Loop, Plant


@given(st.floats(0.02, 1.5), st.floats(0.05, 20.0))
def test_integrating_plant(product: float, dead_time: float) -> None:
    # L = k e^{-sL}/s: w180 = pi/(2 L), wc = k
    k = product / dead_time
    m = Loop(Plant([1.0], [1.0, 0.0], dead_time=dead_time), PI(k=k)).margins()
    assert m.gain == pytest.approx(np.pi / 2 / product, rel=1e-11)
    assert m.phase_crossover == pytest.approx(np.pi / 2 / dead_time, rel=1e-11)
    assert m.phase == pytest.approx(90 - np.degrees(product), rel=1e-10)
    assert m.gain_crossover == pytest.approx(k, rel=1e-11)
    assert m.delay == pytest.approx(np.pi / 2 / k - dead_time, rel=1e-10)
    assert m.gain_reduction == 0.0


@pytest.mark.parametrize("dead_time", [0.05, 0.2, 1.0, 5.0, 50.0])
def test_first_order_plant_with_cancelled_lag(dead_time: float) -> None:
    # Ti = T makes L = (k/T) e^{-sL}/s
    k = 0.5 / dead_time
    m = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=dead_time), PI(k=k, ki=k)).margins()
    assert m.gain == pytest.approx(np.pi, rel=1e-10)
    assert m.phase == pytest.approx(90 - np.degrees(0.5), rel=1e-10)
    assert m.delay == pytest.approx((np.pi / 2 - 0.5) / k, rel=1e-10)


@pytest.mark.parametrize("order", [3, 4, 8])
def test_multiple_lags(order: int) -> None:
    m = Loop(Plant([1.0], np.poly(-np.ones(order))), PI(k=1.1)).margins()
    assert m.gain == pytest.approx(1 / np.cos(np.pi / order) ** order / 1.1, rel=1e-10)
    assert m.phase_crossover == pytest.approx(np.tan(np.pi / order), rel=1e-10)
    wc = np.sqrt(1.1 ** (2 / order) - 1)
    assert m.gain_crossover == pytest.approx(wc, rel=1e-10)
    assert m.phase == pytest.approx(180 - order * np.degrees(np.arctan(wc)), rel=1e-10)


def test_second_order_without_dead_time_has_no_gain_margin() -> None:
    m = Loop(Plant([1.0], [1.0, 1.0, 0.0]), PI(k=1.0)).margins()
    wc = np.sqrt((np.sqrt(5) - 1) / 2)
    assert m.gain == np.inf
    assert m.phase == pytest.approx(90 - np.degrees(np.arctan(wc)), rel=1e-11)
    assert m.delay == pytest.approx((np.pi / 2 - np.arctan(wc)) / wc, rel=1e-11)


def test_no_gain_crossover_means_any_delay_is_tolerated() -> None:
    m = Loop(Plant.foptd(gain=0.5, time_constant=1.0, dead_time=1.0), PI(k=1.0)).margins()
    assert m.phase == np.inf
    assert m.delay == np.inf
    assert m.gain_crossovers == ()
    # w + atan(w) L = pi with T = L = 1
    w = float(crossing(lambda x: x + mp.atan(x) - mp.pi, 1.0, 3.0))
    assert m.gain == pytest.approx(2 * np.sqrt(1 + w * w), rel=1e-11)


def test_unstable_plant_has_two_gain_margins() -> None:
    # L = -k e^{-iwL}/(1 - iw): arg L = -pi at w = 0, and where w L = atan(w)
    k, dead_time = 2.5, 0.2
    m = Loop(Plant([1.0], [1.0, -1.0], dead_time=dead_time), PI(k=k)).margins()
    w = float(crossing(lambda x: x * mp.mpf(dead_time) - mp.atan(x), 2.0, 20.0))
    assert m.gain == pytest.approx(np.sqrt(1 + w * w) / k, rel=1e-11)
    assert m.phase_crossover == pytest.approx(w, rel=1e-11)
    assert m.gain_reduction == pytest.approx(1 / k, rel=1e-11)
    wc = np.sqrt(k * k - 1)
    assert m.phase == pytest.approx(np.degrees(np.arctan(wc) - wc * dead_time), rel=1e-11)
    assert m.delay == pytest.approx(np.arctan(wc) / wc - dead_time, rel=1e-11)


def test_positive_feedback_loses_stability_at_steady_state() -> None:
    m = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=0.3), PI(k=-0.6)).margins()
    assert m.gain == pytest.approx(1 / 0.6, rel=1e-11)


def test_root_plant() -> None:
    # arg e^{-sqrt(iw)} = -sqrt(w/2): -pi at w = 2 pi^2, where |P| = e^{-pi}
    k = 2.0
    m = Loop(Plant.from_function(root_plant_function), PI(k=k)).margins()
    assert m.gain == pytest.approx(np.exp(np.pi) / k, rel=1e-10)
    assert m.phase_crossover == pytest.approx(2 * np.pi**2, rel=1e-10)
    wc = 2 * np.log(k) ** 2
    assert m.gain_crossover == pytest.approx(wc, rel=1e-10)
    assert m.phase == pytest.approx(180 - np.degrees(np.log(k)), rel=1e-10)


def test_three_gain_crossovers_of_a_resonance() -> None:
    problem = PROBLEMS["oscillating"]
    r, m = problem.reference, problem.loop.margins()
    with mp.workdps(30):
        level = lambda w: abs(r.loop_transfer(mp.mpc(0, w))) - 1  # noqa: E731
        expected = [crossing(level, *bracket) for bracket in ((0.05, 0.5), (0.5, 1.0), (1.0, 1.5))]
        lags = [mp.arg(-r.loop_transfer(mp.mpc(0, w))) % (2 * mp.pi) for w in expected]
        delays = [lag / w for lag, w in zip(lags, expected, strict=True)]
    assert m.gain_crossovers == pytest.approx([float(w) for w in expected], rel=1e-11)
    assert m.phase == pytest.approx(float(mp.degrees(min(lags))), rel=1e-10)
    assert m.delay == pytest.approx(float(min(delays)), rel=1e-10)


@pytest.mark.parametrize("name", [name for name in STABLE if name not in ("lag-8", "no-dead-time")])
def test_margins_are_where_stability_ends(name: str) -> None:
    """Scale the gain or the dead time by a bit less and a bit more than the margin and count unstable poles."""
    problem = PROBLEMS[name]
    r, m = problem.reference, problem.loop.margins()

    def unstable(factor: float = 1.0, delay: float = 0.0) -> int:
        changed = ReferenceLoop(
            tuple(factor * a for a in r.num),
            r.den,
            r.dead_time + delay,
            r.k,
            r.ki,
            kd=r.kd,
            derivative_filter=r.derivative_filter,
            measurement_filter=r.measurement_filter,
            measurement_filter_order=r.measurement_filter_order,
        )
        return zeros_right_of(characteristic(changed), 1e-9)

    if np.isfinite(m.gain) and np.isfinite(m.phase_crossover):
        assert unstable(1 + 0.999 * (m.gain - 1)) == 0
        assert unstable(1 + 1.001 * (m.gain - 1)) > 0
    if m.gain_reduction > 0:
        assert unstable(1 - 0.999 * (1 - m.gain_reduction)) == 0
        assert unstable(1 - 1.001 * (1 - m.gain_reduction)) > 0
    if np.isfinite(m.delay):
        assert unstable(delay=0.999 * m.delay) == 0
        assert unstable(delay=1.001 * m.delay) > 0


def test_neutral_loop_loses_stability_in_its_tail() -> None:
    # |L| tends to kd K/T = 0.3; the smallest factor of the finite crossovers competes with 1/0.3
    m = PROBLEMS["neutral"].loop.margins()
    assert m.gain <= 1 / 0.3
    pure = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), PID(k=0.4, ki=0.0, kd=0.4)).margins()
    assert pure.gain == pytest.approx(2.5, rel=1e-11)  # L = 0.4 e^{-s}

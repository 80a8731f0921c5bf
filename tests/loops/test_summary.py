"""Summaries, total variation, data frames and python-control systems against closed forms and single metrics."""

from __future__ import annotations

import math

import control
import mpmath as mp
import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, LoopError, Plant
from replicate.loops.frames import signal_frame
from replicate.loops.summary import summarize_loop, summarize_signal
from replicate.loops.time_domain.total_variation import total_variation
from replicate.loops.to_control import controller_to_control, loop_to_control, plant_to_control

FIRST_ORDER = Loop(Plant([1.0], [1.0, 1.0]), PI(1.0))  # y = (1 - e^{-2t})/2, u = (1 + e^{-2t})/2
OSCILLATING = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.9, 0.7))


def test_the_summary_of_a_first_order_response_is_its_closed_form() -> None:
    y = summarize_signal(FIRST_ORDER.step())
    assert y.final == 0.5
    assert (y.overshoot, y.undershoot, y.trough_time) == (0.0, 0.0, 0.0)
    assert y.trough == pytest.approx(0.0, abs=1e-14)
    assert y.rise_time == pytest.approx(np.log(9) / 2, rel=1e-12)
    assert y.delay_time == pytest.approx(np.log(2) / 2, rel=1e-12)
    assert y.settling_time == pytest.approx(np.log(50) / 2, rel=1e-12)
    assert (y.ie, y.iae, y.ise) == pytest.approx((0.25, 0.25, 1 / 16), rel=1e-12)
    assert (y.itae, y.itse) == pytest.approx((0.125, 1 / 64), rel=1e-11)
    assert (y.settling_min, y.settling_max) == pytest.approx((0.45, 0.5), rel=1e-12)
    assert y.total_variation == pytest.approx(0.5, rel=1e-12)


def test_the_control_signal_of_a_first_order_loop_jumps_and_falls_back() -> None:
    u = FIRST_ORDER.respond().control
    assert total_variation(u) == pytest.approx(1.5, rel=1e-12)


def test_the_total_variation_of_a_critically_damped_loop_is_twice_its_gain() -> None:
    # e^{-s}/s under k <= 1/e: y rises to 1 without overshoot, u = k (1 - y) jumps to k and falls to zero
    u = Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(1 / math.e)).respond().control
    assert total_variation(u) == pytest.approx(2 / math.e, rel=1e-11)


def test_the_total_variation_of_a_ringing_loop_is_a_geometric_series() -> None:
    # 1/(s(s+1)) under unit feedback: extrema 1 +- q^n, q = exp(-pi/sqrt(3)); ups and downs 1 + 2 (q + q^2 + ...)
    y = Loop(Plant([1.0], [1.0, 1.0, 0.0]), PI(1.0)).step()
    q = float(mp.exp(-mp.pi / mp.sqrt(3)))
    assert total_variation(y) == pytest.approx(1 + 2 * q / (1 - q), rel=1e-11)


def test_a_summary_holds_the_single_metrics() -> None:
    y = OSCILLATING.step()
    found = summarize_signal(y)
    assert (found.overshoot, found.settling_time, found.iae) == (y.overshoot(), y.settling_time(), y.iae())
    assert found.settling_max == found.peak == y.peak()
    after = y(np.linspace(y.first_reach(0.9), y.horizon, 100_001))
    assert found.settling_min == pytest.approx(after.min(), abs=1e-8)
    assert found.to_dict()["overshoot"] == found.overshoot
    assert "overshoot" in str(found)
    assert found._repr_html_().startswith("<table><tr><th>final</th>")


def test_what_a_load_response_does_not_have_is_nan() -> None:
    d = summarize_signal(OSCILLATING.load_step())
    assert np.isnan([d.overshoot, d.undershoot, d.rise_time, d.settling_min]).all()
    assert d.ie == pytest.approx(1 / 0.7, rel=1e-9)


def test_an_inverse_response_has_an_undershoot() -> None:
    y = Loop(Plant([-1.0, 1.0], [1.0, 2.0, 1.0], 0.7), PI(0.3, 0.25)).step()
    assert summarize_signal(y).undershoot == -float(y.trough())
    assert summarize_signal(y * -1.0).undershoot == pytest.approx(-float(y.trough()), rel=1e-12)


def test_the_summary_of_a_loop() -> None:
    found = summarize_loop(OSCILLATING)
    margins = OSCILLATING.margins()
    assert found.stable
    assert (found.ms, found.mp) == (OSCILLATING.sensitivity_peak(), OSCILLATING.complementary_peak())
    assert (found.gain_margin, found.phase_margin, found.delay_margin) == (margins.gain, margins.phase, margins.delay)
    assert found.to_dict()["step.overshoot"] == OSCILLATING.step().overshoot()
    assert "load.iae" in str(found)
    assert "<th>stable</th><td>yes</td>" in found._repr_html_()


def test_the_summary_of_a_static_loop_has_no_mode_and_no_response() -> None:
    summary = Loop(Plant([1.0], [1.0], 0.01), PI(0.0)).summary()
    assert summary.stable
    assert np.isnan(summary.rightmost_pole)
    assert (summary.ms, summary.mp, summary.gain_margin) == (1.0, 0.0, float("inf"))
    assert summary.step is None
    assert summary.load is None


def test_the_summary_of_a_loop_with_a_pole_at_rest_has_it() -> None:
    assert Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(0.0)).summary().rightmost_pole == 0.0


@pytest.mark.parametrize("dead_time", [1.0, 1.0 / 3.0, 1e-9, 12345.678901])
def test_what_a_plant_is_shown_as_makes_it_again(dead_time: float) -> None:
    for plant in (
        Plant([1.0], [3.0, 1.0], dead_time),
        Plant.from_terms([([1.0], [1.0, 1.0], 0.0), ([1.0], [2.0, 1.0], dead_time)]),
    ):
        assert eval(repr(plant), {"Plant": Plant}) == plant  # noqa: S307


def test_the_summary_of_an_unstable_loop_says_so() -> None:
    found = summarize_loop(Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(2.0)))
    assert not found.stable
    assert found.rightmost_pole == pytest.approx(complex(mp.lambertw(-2)), rel=1e-12)
    assert np.isnan([found.ms, found.gain_margin]).all()
    assert found.step is None
    assert "step" not in " ".join(found.to_dict())


def test_a_frame_holds_the_values() -> None:
    y = OSCILLATING.step(until=10.0)
    frame = signal_frame(y, [0.0, 1.5, 2.5])
    assert frame.index.name == "t"
    assert frame["value"].tolist() == y([0.0, 1.5, 2.5]).tolist()
    assert len(signal_frame(y)) == 501
    with pytest.raises(LoopError, match="beyond the response's horizon"):
        signal_frame(y, [11.0])


S = 1j * np.geomspace(0.01, 10.0, 7)
PADE = (1 - S / 2 + S**2 / 12) / (1 + S / 2 + S**2 / 12)  # second order, dead time 1


def test_a_plant_becomes_a_transfer_function_with_pade() -> None:
    system = plant_to_control(Plant.foptd(2.0, 3.0, 1.0), pade=2)
    assert isinstance(system, control.TransferFunction)
    np.testing.assert_allclose(system(S), 2 / (3 * S + 1) * PADE, rtol=1e-12)
    np.testing.assert_allclose(plant_to_control(Plant([2.0], [3.0, 1.0]))(S), 2 / (3 * S + 1), rtol=1e-13)


@pytest.mark.parametrize(
    "controller",
    [
        PI(0.6, 0.5, 0.7),
        PID(0.6, 0.5, 0.2, b=0.7, c=0.3, derivative_filter=0.1, measurement_filter=0.2, measurement_filter_order=2),
        PID(0.6, 0.0, 0.2, c=1.0, derivative_filter=0.1, setpoint_filter=0.5),
        PI(0.6, measurement_filter=0.3),
    ],
)
def test_a_loop_becomes_its_transfer_functions(controller: PID) -> None:
    loop = Loop(Plant.foptd(2.0, 3.0, 1.0), controller)
    P, C, F = 2 / (3 * S + 1) * PADE, controller.feedback(S), controller.feedforward(S)
    np.testing.assert_allclose(loop_to_control(loop, 2)(S), P * F / (1 + P * C), rtol=1e-11)
    np.testing.assert_allclose(loop_to_control(loop, 2, "load")(S), P / (1 + P * C), rtol=1e-11)
    np.testing.assert_allclose(loop_to_control(loop, 2, "loop")(S), P * C, rtol=1e-11)
    np.testing.assert_allclose(controller_to_control(controller)(S), C, rtol=1e-12)


def test_what_has_no_transfer_function() -> None:
    with pytest.raises(LoopError, match="give the order of its Padé approximation"):
        plant_to_control(Plant.foptd(1.0, 1.0, 1.0))
    with pytest.raises(LoopError, match="n >= 1"):
        plant_to_control(Plant.foptd(1.0, 1.0, 1.0), pade=0)
    with pytest.raises(LoopError, match="only a plant that is one rational function"):
        plant_to_control(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), pade=2)
    with pytest.raises(LoopError, match="must be setpoint, load or loop"):
        loop_to_control(OSCILLATING, 2, "noise")  # type: ignore[arg-type]

"""Responses to any input against closed forms, quadrature of the convolution integral, and steady-state amplitudes."""

from __future__ import annotations

from typing import Any, cast

import mpmath as mp
import numpy as np
import pytest

from loops import closed_forms
from replicate.loops import PI, PID, Loop, LoopError, Plant, UnstableLoopError
from replicate.loops.experiments import respond_to
from replicate.loops.inputs import PiecewisePolynomial, Pulse, Ramp, Sine, Step

FIRST_ORDER = Loop(Plant([1.0], [1.0, 1.0]), PI(1.0))  # T = 1/(s+2), S = (s+1)/(s+2)
DELAYED = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))
T = np.array([0.3, 1.7, 4.2, 9.9])


def test_a_ramp_in_closed_form() -> None:
    y = respond_to(FIRST_ORDER, setpoint=Ramp(3.0, at=0.5), until=10.0).output
    x = np.maximum(T - 0.5, 0.0)
    np.testing.assert_allclose(y(T), 3 * (x / 2 - (1 - np.exp(-2 * x)) / 4), rtol=1e-12, atol=1e-14)
    assert np.isnan(y.final)


def test_a_sine_in_closed_form() -> None:
    w, phase = 3.0, 0.4
    y = respond_to(FIRST_ORDER, setpoint=Sine(2.0, w, phase, at=1.0), until=10.0).output
    x = np.maximum(T - 1.0, 0.0)
    # (s + 2) Y = R: particular solution 2 Im[e^{i(wt + phase)}/(2 + iw)], and its negative at rest times e^{-2t}
    gain = 2 * np.exp(1j * phase) / (2 + 1j * w)
    expected = (gain * np.exp(1j * w * x)).imag - gain.imag * np.exp(-2 * x)
    np.testing.assert_allclose(y(T), np.where(x > 0, expected, 0.0), rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("w", [0.05, 2.0, 60.0])
def test_a_sine_settles_to_the_frequency_response(w: Any) -> None:
    y = respond_to(DELAYED, load=Sine(1.0, w), until=90.0).output
    steady = complex(DELAYED.plant(1j * w) / (1 + DELAYED(1j * w)))
    t = np.linspace(80.0, 90.0, 23)
    np.testing.assert_allclose(y(t), (steady * np.exp(1j * w * t)).imag, rtol=0, atol=1e-11)


def test_a_sine_on_a_loop_with_dead_time_by_quadrature() -> None:
    # y = w int s(tau) cos(w (t - tau)) dtau with the closed-form step response of e^{-s}/(s+1) under k = 1.5
    loop, w, t = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(1.5)), 2.0, 3.6
    y = respond_to(loop, setpoint=Sine(1.0, w), until=4.0).output
    expected = mp.quad(
        lambda x: closed_forms.p_foptd(1.0, 1.0, 1.0, 1.5, x) * w * mp.cos(w * (t - x)), [1, 2, 3, mp.mpf(t)]
    )
    assert float(y(t)) == pytest.approx(float(expected), rel=1e-12)


def test_a_pulse_is_two_steps_and_dies_out() -> None:
    y = respond_to(DELAYED, load=Pulse(2.0, 3.0, at=1.0)).output
    step = DELAYED.load_step(until=40.0)
    expected = 2 * (step(np.maximum(T - 1, 0)) - step(np.maximum(T - 4, 0)))
    np.testing.assert_allclose(y(T), expected, rtol=1e-12, atol=1e-14)
    assert y.final == 0.0
    assert y.iae() > 0.0


def test_a_ramp_that_ends_has_a_final_value_and_metrics() -> None:
    y = respond_to(DELAYED, setpoint=Ramp(0.5, at=1.0, duration=4.0)).output
    assert y.final == pytest.approx(2.0, rel=1e-14)
    assert y.settling_time() > 5.0
    # the integral of a ramp's error: T(0) = 1, so IE = int (2 - r) dt + 2/ki
    assert y.ie() == pytest.approx(2.0 + 4.0 + 2 * (1 / 0.5), rel=1e-9)


def test_a_piecewise_polynomial_is_its_pieces() -> None:
    # 1 + t up to 2, then 3 + (t-2)^2 up to 3, then 0
    shape = PiecewisePolynomial(((0.0, (1.0, 1.0)), (2.0, (3.0, 0.0, 1.0)), (3.0, (0.0,))))
    y = respond_to(FIRST_ORDER, setpoint=shape, until=10.0).output

    def r(x: Any) -> Any:
        return 1 + x if x < 2 else 3 + (x - 2) ** 2 if x < 3 else 0.0

    for t in T:
        points = [p for p in (0, 2, 3, float(t)) if p <= t]
        expected = mp.quad(lambda x, t=t: r(x) * mp.exp(-2 * (t - x)), points)
        assert float(y(t)) == pytest.approx(float(expected), rel=1e-12)
    assert y.final == 0.0


def test_the_output_disturbance_is_answered_by_the_sensitivity() -> None:
    # S = (s+1)/(s+2): step response (1 + e^{-2t})/2, u = -(1 + e^{-2t})/2 ... C S = (s+1)/(s+2), too
    response = respond_to(FIRST_ORDER, output=1.0, until=10.0)
    np.testing.assert_allclose(response.output(T), (1 + np.exp(-2 * T)) / 2, rtol=1e-12)
    np.testing.assert_allclose(response.control(T), -(1 + np.exp(-2 * T)) / 2, rtol=1e-12)


def test_noise_is_answered_by_the_complementary_sensitivity() -> None:
    controller = PID(0.6, 0.5, 0.2, b=0.3, derivative_filter=0.1, measurement_filter=0.2, measurement_filter_order=2)
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), controller)
    w, t = 1.3, np.linspace(80.0, 90.0, 23)
    response = respond_to(loop, noise=Sine(1.0, w), until=90.0)
    L, C = complex(loop(1j * w)), complex(controller.feedback(1j * w))
    turn = np.exp(1j * w * t)
    np.testing.assert_allclose(response.output(t), (-L / (1 + L) * turn).imag, rtol=0, atol=1e-11)
    np.testing.assert_allclose(response.control(t), (-C / (1 + L) * turn).imag, rtol=0, atol=1e-11)
    disturbed = respond_to(loop, output=Sine(1.0, w), until=90.0)
    np.testing.assert_allclose(disturbed.output(t), (1 / (1 + L) * turn).imag, rtol=0, atol=1e-11)


def test_everything_at_once_is_a_sum() -> None:
    both = respond_to(DELAYED, setpoint=Step(1.0), load=[Step(-0.5, at=5.0), Pulse(0.2, 1.0, at=7.0)], until=12.0)
    known = DELAYED.respond(setpoint=1.0, load=-0.5, load_at=5.0, until=12.0)
    pulse = respond_to(DELAYED, load=Pulse(0.2, 1.0, at=7.0), until=12.0)
    np.testing.assert_allclose(both.output(T), known.output(T) + pulse.output(T), rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(both.control(T), known.control(T) + pulse.control(T), rtol=1e-12, atol=1e-13)
    assert both.output.final == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: respond_to(DELAYED, load=cast("Any", "x")), "the load must be a number or inputs such as Step"),
        (lambda: respond_to(DELAYED, setpoint=cast("Any", [1.0])), "the setpoint must be a number or inputs"),
        (lambda: respond_to(DELAYED, setpoint=Sine(1.0, 1.0)), "give a horizon"),
        (lambda: respond_to(DELAYED, setpoint=1.0, until=-1.0), "must be positive and finite"),
        (lambda: Step(at=-1.0), "the time of a step must be a finite number >= 0"),
        (lambda: Step(cast("Any", "1")), "the height of a step must be a finite number, not '1'"),
        (lambda: Pulse(1.0, 0.0), "the duration of a pulse must be a finite number > 0"),
        (lambda: Ramp(1.0, duration=-2.0), "the duration of a ramp must be a finite number > 0"),
        (lambda: Sine(1.0, 0.0), "the frequency of a sine must be a finite number > 0"),
        (lambda: PiecewisePolynomial(()), "ascending starts"),
        (lambda: PiecewisePolynomial(((1.0, (1.0,)), (1.0, (2.0,)))), "ascending starts"),
    ],
)
def test_what_is_no_input(call: Any, message: Any) -> None:
    with pytest.raises(LoopError, match=message):
        call()


def test_an_unstable_loop_needs_a_horizon() -> None:
    with pytest.raises(UnstableLoopError):
        respond_to(Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(2.0)), setpoint=Ramp(1.0))

"""Controller forms and their conversions, compared as transfer functions written down separately."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from replicate.loops import PI, PID, Loop, LoopError, Plant

S = np.array([0.3 + 2.0j, 1e-3j, 40j, 2.0 + 0.1j])  # points anywhere off the poles

positive = st.floats(0.05, 20.0)


def close(values: NDArray[Any], expected: NDArray[Any]) -> bool:
    return bool(np.abs(values - expected).max() <= 1e-12 * np.abs(expected).max())


@given(positive, positive, st.floats(0.0, 2.0))
def test_pi(k: float, ki: float, b: float) -> None:
    pi = PI(k=k, ki=ki, b=b)
    assert close(pi.feedback(S), k + ki / S)
    assert close(pi.feedforward(S), b * k + ki / S)
    assert pi.integral_time == pytest.approx(k / ki, rel=1e-15)
    same = PI.from_integral_time(k, k / ki, b)
    assert close(same.feedback(S), k + ki / S)


@given(positive, positive, positive)
def test_ideal_form(gain: float, integral_time: float, derivative_time: float) -> None:
    pid = PID.ideal(gain, integral_time, derivative_time, b=0.4, c=0.1)
    assert close(pid.feedback(S), gain * (1 + 1 / (S * integral_time) + S * derivative_time))
    assert close(pid.feedforward(S), gain * (0.4 + 1 / (S * integral_time) + 0.1 * S * derivative_time))
    assert pid.integral_time == pytest.approx(integral_time, rel=1e-14)
    assert pid.derivative_time == pytest.approx(derivative_time, rel=1e-14)


@given(positive, positive, positive, st.floats(0.0, 0.5))
def test_series_form(gain: float, integral_time: float, derivative_time: float, alpha: float) -> None:
    pid = PID.series(gain, integral_time, derivative_time, alpha=alpha)
    series = gain * (1 + 1 / (S * integral_time)) * (1 + S * derivative_time) / (1 + alpha * S * derivative_time)
    assert close(pid.feedback(S), series)
    assert close(pid.feedforward(S), series)  # a series controller acts on the error


@given(positive, positive, st.floats(0.01, 0.99))
def test_series_to_parallel_and_back(gain: float, integral_time: float, share: float) -> None:
    # of the two series forms of a PID controller the conversion returns the one with Td <= Ti; where the two times
    # are close to each other they are the double root of a quadratic and lose half of the digits
    derivative_time = share * integral_time
    pid = PID.series(gain, integral_time, derivative_time)
    k, ti, td = pid.to_series()
    assert close(k * (1 + 1 / (S * ti)) * (1 + S * td), pid.feedback(S))
    assert (k, ti, td) == pytest.approx((gain, integral_time, derivative_time), rel=1e-11 / (1 - share) ** 2)


@pytest.mark.parametrize("time", [0.05, 0.1, 0.3, 1.0, 4.0, 7.3])
def test_series_form_with_two_equal_times(time: float) -> None:
    # as in the SIMC rule for double integrators
    pid = PID.series(0.25, time, time)
    k, ti, td = pid.to_series()
    assert (k, ti, td) == pytest.approx((0.25, time, time), rel=1e-7)


def test_complex_zeros_have_no_series_form() -> None:
    with pytest.raises(LoopError, match="series"):
        PID.ideal(1.0, 1.0, 0.3).to_series()


@given(positive, positive, positive, st.floats(0.01, 1.0), st.sampled_from([1, 2]))
def test_measurement_filter(k: float, ki: float, kd: float, lag: float, order: int) -> None:
    pid = PID(k=k, ki=ki, kd=kd, b=0.5, measurement_filter=lag, measurement_filter_order=order)
    assert close(pid.feedback(S), (k + ki / S + kd * S) / (1 + S * lag) ** order)
    assert close(pid.feedforward(S), 0.5 * k + ki / S)  # the set point is not filtered with the measurement


@given(positive, positive, positive, st.floats(0.01, 1.0))
def test_derivative_filter(k: float, ki: float, kd: float, lag: float) -> None:
    pid = PID(k=k, ki=ki, kd=kd, c=0.3, derivative_filter=lag)
    assert close(pid.feedback(S), k + ki / S + kd * S / (1 + S * lag))
    assert close(pid.feedforward(S), k + ki / S + 0.3 * kd * S / (1 + S * lag))


def test_set_point_filter() -> None:
    pid = PID(k=2.0, ki=0.5, b=0.7, setpoint_filter=1.5)
    assert close(pid.feedforward(S), (1.4 + 0.5 / S) / (1 + 1.5 * S))
    assert close(pid.feedback(S), 2 + 0.5 / S)
    general = PID(k=2.0, ki=0.5, setpoint_filter=((0.2, 1.0), (0.5, 1.1, 1.0)))
    assert close(general.feedforward(S), (2 + 0.5 / S) * (0.2 * S + 1) / (0.5 * S**2 + 1.1 * S + 1))


def test_set_point_weight_is_a_set_point_filter() -> None:
    # b k + ki/s = (k + ki/s)(1 + b Ti s)/(1 + Ti s): the two loops respond alike
    plant = Plant.foptd(gain=1.0, time_constant=1.0, dead_time=0.4)
    k, ki, b = 0.9, 0.6, 0.35
    weighted = Loop(plant, PI(k=k, ki=ki, b=b)).respond(until=8.0)
    filtered = Loop(plant, PI(k=k, ki=ki, setpoint_filter=((b * k / ki, 1.0), (k / ki, 1.0)))).respond(until=8.0)
    t = np.linspace(0.05, 7.9, 40)
    assert np.abs(weighted.output(t) - filtered.output(t)).max() < 1e-12
    assert np.abs(weighted.control(t) - filtered.control(t)).max() < 1e-12


@pytest.mark.parametrize("derivative_filter", [0.0, 0.1])
@pytest.mark.parametrize("measurement_filter", [0.0, 0.2])
@pytest.mark.parametrize("order", [1, 2])
def test_polynomials_are_the_transfer_function(derivative_filter: float, measurement_filter: float, order: int) -> None:
    for k, ki, kd in ((1.0, 0.5, 0.3), (1.0, 0.0, 0.3), (1.0, 0.5, 0.0), (0.0, 0.5, 0.0), (1.0, 0.0, 0.0)):
        pid = PID(
            k=k,
            ki=ki,
            kd=kd,
            derivative_filter=derivative_filter,
            measurement_filter=measurement_filter,
            measurement_filter_order=order,
        )
        num, den = pid.feedback_polynomials()
        expected = (k + ki / S + kd * S / (1 + S * derivative_filter)) / (1 + S * measurement_filter) ** order
        assert close(np.polyval(num, S) / np.polyval(den, S), expected)


@pytest.mark.parametrize(
    "wrong",
    [
        {"k": float("nan")},
        {"k": 1.0, "ki": float("inf")},
        {"k": 1.0, "derivative_filter": -0.1},
        {"k": 1.0, "measurement_filter": -1.0},
        {"k": 1.0, "measurement_filter": 0.1, "measurement_filter_order": 3},
        {"k": 1.0, "setpoint_filter": -0.5},
    ],
)
def test_wrong_parameters_are_named(wrong: dict[str, Any]) -> None:
    with pytest.raises(LoopError, match=list(wrong)[-1].replace("measurement_filter_order", "order")):
        PID(**wrong)


def test_controllers_with_equal_parameters_are_equal() -> None:
    assert PI(k=1.0, ki=0.5) == PI(k=1.0, ki=0.5)
    assert PI(k=1.0, ki=0.5) != PI(k=1.0, ki=0.6)

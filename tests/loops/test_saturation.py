"""Loops whose control signal has limits: closed forms, an independent integration, and laws."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq

from loops.limited_reference import Reference
from replicate.loops import PI, PID, ImproperLoopError, Loop, LoopError, Plant, Signal, UnstableLoopError
from replicate.loops.inputs import Input, Pulse, Ramp, Step

SCHEMES = ("none", "back-calculation", "clamping")
FOPTD = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(1.2, 0.8))


def largest_difference(one: Signal, two: Signal, until: float) -> float:
    """Return the largest difference on a grid, relative to the largest value."""
    t = np.linspace(0.0, until, 997)
    return float(np.max(np.abs(one(t) - two(t))) / np.max(np.abs(one(t))))


# ---- closed forms --------------------------------------------------------------------------------------------------


def test_an_integrator_rises_at_its_limit_and_then_follows_its_exponential() -> None:
    response = Loop(Plant([1.0], [1.0, 0.0]), PI(2.0)).saturated(limits=(-0.5, 0.5))
    # y = t/2 until 2 (1 - y) = 1/2 at t = 3/2, then 1 - y = exp(-2 (t - 3/2)) / 4
    (interval,) = response.at_limit
    assert interval.start == 0.0
    assert interval.end == pytest.approx(1.5, rel=1e-13)
    t = np.linspace(0.0, 6.0, 301)
    exact = np.where(t < 1.5, t / 2, 1 - np.exp(-2 * np.maximum(t - 1.5, 0)) / 4)
    np.testing.assert_allclose(response.output(t), exact, atol=1e-13)
    np.testing.assert_allclose(response.control(t), np.minimum(0.5, 2 * (1 - exact)), atol=1e-13)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_static_plant_moves_from_dead_time_to_dead_time(scheme: Any) -> None:
    response = Loop(Plant([2.0], [1.0], 1.0), PI(0.4)).saturated((-0.3, 0.3), scheme, until=8.0)
    control = 0.0
    for n in range(8):
        output, control = 2.0 * control, float(np.clip(0.4 * (1.0 - 2.0 * control), -0.3, 0.3))
        assert float(response.output(n + 0.5)) == pytest.approx(output, abs=1e-14)
        assert float(response.control(n + 0.5)) == pytest.approx(control, abs=1e-14)


def test_wind_up_ends_when_the_integral_of_the_error_says_so() -> None:
    k, ki, high = 1.2, 0.8, 1.05
    response = FOPTD.saturated((0.0, high), until=30.0)

    def command(t: float) -> float:  # at the limit y = h (1 - exp(-(t - 1))) for t > 1
        y = high * (1 - np.exp(-(t - 1)))
        integral = t - high * ((t - 1) - (1 - np.exp(-(t - 1))))
        return float(k * (1 - y) + ki * integral)

    leaves = brentq(lambda t: command(t) - high, 3.0, 29.0, xtol=1e-13)
    assert response.at_limit[0].end == pytest.approx(leaves, rel=1e-12)
    for t in (1.5, 4.0, leaves):
        assert float(response.output(t)) == pytest.approx(high * (1 - np.exp(-(t - 1))), abs=1e-12)
        assert float(response.command(t)) == pytest.approx(command(t), abs=1e-12)
    # it rises for one dead time more, and a moment longer while the control signal falls to where the output is
    assert response.output.overshoot() == pytest.approx(high * (1 - np.exp(-leaves)) - 1.0, abs=1e-10)


def test_back_calculation_lets_the_command_settle_beside_its_limit() -> None:
    # at rest at the limit: ki (1 - y) + (h - v)/Tt = 0 with y = h
    response = FOPTD.saturated((0.0, 0.9), "back-calculation", tracking_time=0.7)
    assert float(response.command(response.command.horizon)) == pytest.approx(0.9 + 0.7 * 0.8 * 0.1, abs=1e-12)
    assert response.output.final == pytest.approx(0.9)
    assert response.output.settling_time() < 20.0


def test_clamping_holds_the_integral_part() -> None:
    response = FOPTD.saturated((0.0, 1.05), "clamping", until=3.0)
    # the command starts beyond the limit and stays there, at k, until the output moves at t = 1
    assert float(response.command(0.999)) == pytest.approx(1.2, abs=1e-13)
    assert response.at_limit[0].end == pytest.approx(1.0 - np.log(1.0 - 0.125 / 1.05), rel=1e-12)  # 1.2 (1 - y) = 1.05


@pytest.mark.parametrize(
    ("k", "high", "lag", "delay"), [(2.0, 0.8, 1.0, 1e-4), (2.0, 0.8, 1e3, 400.0), (3.3, 0.9, 2e-3, 1e-5)]
)
def test_a_command_that_touches_its_limit_without_slope_slides_on_it(
    k: float, high: float, lag: float, delay: float
) -> None:
    # y = h (1 - exp(-(t - L)/T)); the held command k (1 - y) falls to h where the running one is stationary
    error = high / k
    ki = k * (high - 1.0 + error) / (lag * error)
    touches = delay + lag * np.log(high / (high - 1.0 + error))
    end = touches + 3.0 * lag
    limited = Loop(Plant.foptd(1.0, lag, delay), PI(k, ki)).saturated((-0.3, high), "clamping", until=end)
    (interval,) = limited.at_limit
    assert (interval.start, interval.end) == (0.0, end)
    t = np.linspace(0.0, end, 301)
    exact = np.where(t < delay, 0.0, -high * np.expm1(-np.maximum(t - delay, 0.0) / lag))
    np.testing.assert_allclose(limited.output(t), exact, atol=1e-12)
    np.testing.assert_allclose(limited.command(t), np.where(t < touches, k * (1.0 - exact), high), atol=1e-12)


def test_a_command_that_touches_its_limit_and_curves_back_goes_free() -> None:
    # as above, with k (h - 1 + h/k) > h: the running command curves down, back between its limits
    k, high, delay = 2.0, 1.25, 0.5
    ki = k * (high - 1.0 + high / k) / (high / k)
    touches = delay + np.log(high / (high - 1.0 + high / k))
    limited = Loop(Plant.foptd(1.0, 1.0, delay), PI(k, ki)).saturated((-0.3, high), "clamping", until=6.0)
    assert limited.at_limit[0].end == pytest.approx(touches, rel=1e-7)  # a double root
    reference = Reference([1.0], [1.0, 1.0], delay, k, ki, (-0.3, high), "clamping")
    reference.run(5.0)
    t = np.linspace(0.013, 4.98, 120)
    np.testing.assert_allclose(limited.output(t), [reference.output(x) for x in t], atol=2e-11)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("ki", [1e-5, 1e-9])
def test_weak_integral_action_meets_a_limit_after_a_million_dead_times(scheme: Any, ki: float) -> None:
    # when all else has decayed, the control signal is 1 - r exp(p t) with the slow pole p
    with mp.workdps(40):

        def closed(s: mp.mpf) -> mp.mpf:
            return s * (1 + s) + (mp.mpf(0.6) * s + mp.mpf(ki)) * mp.exp(-s)

        pole = ki * mp.findroot(lambda share: closed(ki * share) / ki, -mp.mpf("0.625"))
        residue = (mp.mpf(0.6) * pole + mp.mpf(ki)) * (1 + pole) / (pole * mp.diff(closed, pole))
        meets = float(mp.log(-residue / mp.mpf("0.3")) / -pole)
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, ki))
    limited = loop.saturated((-0.7, 0.7), scheme)
    assert limited.at_limit[-1].start == pytest.approx(meets, rel=1e-10)
    assert float(limited.output(limited.output.horizon)) == pytest.approx(0.7, rel=1e-12)
    free = loop.saturated((-2.0, 2.0), scheme, setpoint=0.0, load=1.0)
    assert free.output.ie() == pytest.approx(1.0 / ki, rel=1e-10)
    assert max(limited.output.breaks.size, free.output.breaks.size) < 300


# ---- an independent integration ------------------------------------------------------------------------------------

CASES: dict[str, dict[str, Any]] = {
    "wind-up and a load": {"num": [1.0], "den": [1.0, 1.0], "k": 1.1, "ki": 0.8, "limits": (-0.2, 1.1), "load": 0.6, "load_at": 4.0},  # noqa: E501
    "an integrator": {"num": [1.0], "den": [1.0, 0.0], "k": 0.55, "ki": 0.16, "limits": (-0.2, 0.4)},
    "second order": {"num": [1.0], "den": [0.5, 1.4, 1.0], "k": 1.0, "ki": 0.8, "limits": (0.0, 1.15)},
    "PID": {"num": [1.0], "den": [0.8, 1.0], "k": 0.7, "ki": 0.7, "kd": 0.2, "lag": 0.2, "c": 1.0, "limits": (-0.4, 1.2)},  # noqa: E501
}  # fmt: skip


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", CASES)
def test_the_response_equals_that_of_an_independent_integration(name: str, scheme: str) -> None:
    case = CASES[name]
    reference = Reference(**case, delay=0.8, scheme=scheme, tracking=0.9)
    reference.run(9.0)
    controller = PID(
        case["k"], case["ki"], case.get("kd", 0.0), c=case.get("c", 0.0), derivative_filter=case.get("lag", 0.0)
    )
    response = Loop(Plant(case["num"], case["den"], 0.8), controller).saturated(
        case["limits"], scheme,  # type: ignore[arg-type]
        tracking_time=0.9 if scheme == "back-calculation" else None,
        load=case.get("load", 0.0), load_at=case.get("load_at", 0.0), until=9.0,
    )  # fmt: skip
    assert response.at_limit
    t = np.linspace(0.013, 8.98, 120)
    np.testing.assert_allclose(response.output(t), [reference.output(x) for x in t], atol=2e-11)
    np.testing.assert_allclose(response.control(t), [reference.control(x) for x in t], atol=2e-11)


# ---- laws ----------------------------------------------------------------------------------------------------------

LOOPS = [
    FOPTD,
    Loop(Plant([1.0], [1.0, 0.6, 1.0], 0.3), PID(0.4, 0.3, 0.5, derivative_filter=0.1, measurement_filter=0.05)),
    Loop(Plant([1.0], [1.0], 1.0), PI(0.3, 0.4)),
    Loop(Plant([1.0], np.poly([-1.0] * 4)), PID.series(1.1, 2.0, 0.5, alpha=0.1)),
    Loop(Plant.from_terms([([1.0], [1.0, 1.0], 0.5), ([0.5], [1.0, 1.0], 1.2)]), PI(0.4, 0.3)),
    Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5, setpoint_filter=0.5)),
    Loop(Plant([1.0], [1.0, 1.0], 1e-3), PI(2.0, 2.0)),
]


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("loop", LOOPS)
def test_limits_that_are_not_met_change_nothing(loop: Loop, scheme: Any) -> None:
    linear = loop.respond(load=0.3, load_at=2.0, until=20.0)
    for limits in ((-np.inf, np.inf), (-1e3, 50.0)):
        limited = loop.saturated(limits, scheme, load=0.3, load_at=2.0, until=20.0)
        assert limited.at_limit == ()
        assert largest_difference(linear.output, limited.output, 20.0) < 1e-11
        assert largest_difference(linear.control, limited.control, 20.0) < 1e-11
        assert limited.output.final == linear.output.final


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("loop", LOOPS)
def test_a_change_of_sign_and_of_units_changes_nothing_else(loop: Loop, scheme: Any) -> None:
    one = loop.saturated((-0.2, 1.1), scheme, load=0.3, load_at=4.0, until=12.0)
    other = loop.saturated((-1.1, 0.2), scheme, setpoint=-1.0, load=-0.3, load_at=4.0, until=12.0)
    assert largest_difference(one.output, other.output * -1.0, 12.0) < 1e-12
    time, gain = 3e-7, 4e5
    plant = loop.plant.rescaled(1.0 / time, 1.0 / gain)
    c = loop.controller
    scaled = PID(
        c.k / gain, c.ki / gain / time, c.kd / gain * time, c.b, c.c, derivative_filter=c.derivative_filter * time,
        measurement_filter=c.measurement_filter * time,  # type: ignore[operator]
        setpoint_filter=c.setpoint_filter * time,  # type: ignore[operator]
    )  # fmt: skip
    third = Loop(plant, scaled).saturated(
        (-0.2 / gain, 1.1 / gain), scheme, load=0.3 / gain, load_at=4.0 * time, until=12.0 * time
    )
    t = np.linspace(0.0, 12.0, 500)
    np.testing.assert_allclose(third.output(t * time), one.output(t), atol=1e-10)
    np.testing.assert_allclose(third.control(t * time) * gain, one.control(t), atol=1e-10)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_control_signal_is_the_command_within_the_limits(scheme: Any) -> None:
    response = FOPTD.saturated((0.1 - 0.1, 1.05), scheme, setpoint=[Step(1.0), Pulse(-0.8, 3.0, at=9.0)], until=25.0)
    t = np.linspace(0.0, 25.0, 2001)
    np.testing.assert_allclose(response.control(t), np.clip(response.command(t), 0.0, 1.05), atol=1e-12)
    assert {interval.limit for interval in response.at_limit} <= {0.0, 1.05}


def test_steps_and_pulses_add_up_without_limits() -> None:
    setpoint: list[Input] = [Step(1.0), Pulse(-0.5, 2.0, at=5.0)]
    load = Step(0.2, at=7.0)
    linear = FOPTD.respond_to(setpoint=setpoint, load=load, until=20.0)
    limited = FOPTD.saturated((-9.0, 9.0), setpoint=setpoint, load=load, until=20.0)
    assert largest_difference(linear.output, limited.output, 20.0) < 1e-12
    assert largest_difference(linear.control, limited.control, 20.0) < 1e-12


def test_an_unstable_plant_under_too_tight_limits_runs_away() -> None:
    loop = Loop(Plant([1.0], [1.0, -1.0], 0.1), PI(3.0, 1.0))
    with pytest.raises(LoopError, match=r"come to rest|grows beyond|settle there"):
        loop.saturated((-0.2, 0.2))
    assert loop.saturated((-9.0, 9.0)).output.settling_time() > 0.0


# ---- what is refused -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"limits": (1.0, 2.0)}, r"the limits must be two numbers \(low, high\).*not \(1.0, 2.0\)"),
        ({"limits": (0.0, 0.0)}, "the limits must be"),
        ({"limits": (1.0, -1.0)}, "the limits must be"),
        ({"limits": 3.0}, "the limits must be"),
        ({"limits": ("a", 1.0)}, "the limits must be"),
        ({"limits": (np.nan, 1.0)}, "the limits must be"),
        ({"anti_windup": "clamp"}, "anti_windup must be one of none, back-calculation, clamping, not 'clamp'"),
        ({"anti_windup": None}, "anti_windup must be one of"),
        ({"tracking_time": 1.0}, "tracking_time belongs to"),
        ({"anti_windup": "back-calculation", "tracking_time": 0.0}, "tracking_time must be a time > 0"),
        ({"setpoint": Ramp(1.0)}, "the setpoint must be piecewise constant"),
        ({"setpoint": "1"}, "the setpoint must be"),
        ({"load": 1j}, "the load must be"),
        ({"load_at": -1.0}, "load_at must be"),
        ({"until": 0.0}, "the horizon until must be"),
    ],
)  # fmt: skip
def test_a_wrong_argument_is_named_in_one_line(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(LoopError, match=message) as caught:
        FOPTD.saturated(**({"limits": (-1.0, 1.0)} | arguments))
    assert "\n" not in str(caught.value)


def test_what_has_no_exact_response_is_refused() -> None:
    function = Loop(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), PI(1.0, 0.5))
    with pytest.raises(LoopError, match="rational plant"):
        function.saturated((-1.0, 1.0))
    ideal = Loop(Plant([1.0], [1.0, 2.0, 1.0], 1.0), PID(0.5, 0.2, 0.3, c=1.0))
    with pytest.raises(LoopError, match="ideal derivative"):
        ideal.saturated((-1.0, 1.0))
    with pytest.raises(UnstableLoopError):
        Loop(Plant.foptd(1.0, 1.0, 1.0), PI(9.0)).saturated((-1.0, 1.0))
    with pytest.raises(ImproperLoopError, match="well posed under limits"):
        Loop(Plant([-3.0], [1.0]), PI(1.0)).saturated((-1.0, 1.0))
    with pytest.raises(LoopError, match="tracking_time has no default"):
        Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.0, 0.3)).saturated((-1.0, 2.0), "back-calculation")
    with pytest.raises(LoopError, match="does not settle there"):
        Loop(Plant([1.0], [1.0, 0.0], 1.0), PI(0.3, 0.02)).saturated((-1.0, 1.0), load=-2.0)


def test_every_real_number_is_a_limit() -> None:
    limits: Any = (Fraction(0), Fraction(21, 20))
    response = FOPTD.saturated(limits, "clamping", until=5.0)
    assert response.at_limit[0].limit == 1.05


@pytest.mark.parametrize("scheme", ["none", "back-calculation", "clamping"])
def test_a_control_signal_that_ends_on_its_limit_comes_to_rest_there(scheme: Any) -> None:
    # y = 1 - e^-t while u = 1, its value at rest; without anti-windup v = 2 (1 - y) + (1 - e^-t) = 1 + e^-t
    response = Loop(Plant([1.0], [1.0, 1.0]), PI(2.0, 1.0)).saturated((0.0, 1.0), scheme)
    t = np.array([0.1, 0.5, 0.69])  # up to log 2, where clamping lets v fall below the limit
    np.testing.assert_allclose(response.output(t), 1.0 - np.exp(-t), rtol=1e-12)
    assert float(response.output(response.output.horizon)) == pytest.approx(1.0, rel=1e-12)
    if scheme == "none":
        np.testing.assert_allclose(response.command(t), 1.0 + np.exp(-t), rtol=1e-12)
        assert response.at_limit[0].end == response.output.horizon
    delayed = Loop(Plant.foptd(1.0, 2.0, 3.0), PI(0.1, 0.2)).saturated((-1.0, 1.0), scheme)
    assert delayed.output.overshoot() == 0.0
    assert float(delayed.output(delayed.output.horizon)) == pytest.approx(1.0, rel=1e-12)

"""Loops at the limits: marginal, static, ill-posed, with gain at infinite frequency; and arguments that make no sense.

Expected values are closed forms, given with each test.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from loops.references import talbot
from replicate.loops import (
    PI,
    PID,
    Constraint,
    ImproperLoopError,
    Loop,
    LoopError,
    Plant,
    SmithPredictor,
    UnstableLoopError,
    design_pi,
    design_pid,
    step_responses,
)

NAN, INF = float("nan"), float("inf")
FOPTD = Plant.foptd(1.0, 1.0, 1.0)
LOOP = Loop(FOPTD, PI(0.6, 0.5))


# ---- gain at infinite frequency, no dead time ------------------------------------------------------------------------


def test_loop_gain_above_one_at_infinite_frequency() -> None:
    # L = 2 (s + 2)/(s + 1): S = (s + 1)/(3 s + 5) grows to 1/3, T = (2 s + 4)/(3 s + 5) falls from 4/5
    loop = Loop(Plant([1.0, 2.0], [1.0, 1.0]), PI(2.0))
    ms, mp, margins = loop.sensitivity_peak(), loop.complementary_peak(), loop.margins()
    assert ms.value == pytest.approx(1.0 / 3.0, rel=1e-14)
    assert ms.frequency == INF
    assert mp.value == pytest.approx(0.8, rel=1e-14)
    assert mp.frequency == 0.0
    # with any dead time the loop would be neutral with |L| = 2 at infinite frequency: unstable
    assert margins.delay == 0.0
    assert not Loop(Plant([1.0, 2.0], [1.0, 1.0], dead_time=1e-3), PI(2.0)).is_stable()


def test_ideal_pid_on_a_lag() -> None:
    # L = (2 s^2 + 2 s + 1)/(s (s + 1)), so |S|^2 = (x^2 + x)/((1 - 3x)^2 + 9x) with x = w^2
    loop = Loop(Plant([1.0], [1.0, 1.0]), PID(2.0, 1.0, 2.0))
    found = minimize_scalar(
        lambda x: -(x**2 + x) / ((1 - 3 * x) ** 2 + 9 * x), bounds=(0.0, 5.0), options={"xatol": 1e-12}
    )
    peak = loop.sensitivity_peak()
    assert peak.value == pytest.approx(np.sqrt(-found.fun), rel=1e-12)
    assert peak.frequency == pytest.approx(np.sqrt(found.x), rel=1e-5)
    assert loop.complementary_peak().value == pytest.approx(1.0, rel=1e-12)


def test_gain_reduction_through_an_algebraic_loop() -> None:
    # L = -2 (s + 2)/(s + 1) has the closed-loop pole -3; half the gain makes 1 + L(inf) vanish
    margins = Loop(Plant([-2.0, -4.0], [1.0, 1.0]), PI(1.0)).margins()
    assert margins.gain == INF
    assert margins.gain_reduction == pytest.approx(0.5, rel=1e-14)


def test_ill_posed_loop_is_refused() -> None:
    with pytest.raises(ImproperLoopError, match="not well posed"):
        Loop(Plant([-1.0, 2.0], [1.0, 1.0]), PI(1.0))


# ---- on the limit of stability ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("plant", "gain"),
    [
        (Plant([1.0], [1.0, 3.0, 3.0, 1.0]), 8.0),  # (s + 1)^3 + 8 has the roots +-i sqrt(3)
        (Plant([1.0], [1.0, 2.0, 1.0, 0.0]), 2.0),  # s (s + 1)^2 + 2 has the roots +-i
        (Plant([1.0], [1.0, 0.0], dead_time=1.0), np.pi / 2),
        (Plant([1.0], [1.0, 0.0, 1.0]), 0.0),
    ],
)
def test_marginal_loop_has_no_peaks_and_margins(plant: Plant, gain: float) -> None:
    loop = Loop(plant, PID(gain))
    assert not loop.is_stable()
    for quantity in (loop.sensitivity_peak, loop.complementary_peak, loop.margins, loop.step, loop.horizon):
        with pytest.raises(UnstableLoopError):
            quantity()


def test_diverging_response_says_where_it_leaves_the_range() -> None:
    for plant in (FOPTD, Plant([1.0], [1.0, -1.0])):
        with pytest.raises(LoopError, match="choose a shorter horizon"):
            Loop(plant, PI(5.0 if plant.dead_time else 0.5, 0.1)).step(until=3000.0)


# ---- loops without feedback or without memory ------------------------------------------------------------------------


def test_controller_without_gain() -> None:
    loop = Loop(FOPTD, PID(0.0))
    assert (loop.sensitivity_peak().value, loop.complementary_peak().value) == (1.0, 0.0)
    assert loop.margins().gain == INF
    # the load response is the plant's own: 1 - e^{-(t - 1)}
    assert loop.load_step(until=4.0)(3.0) == pytest.approx(1.0 - np.exp(-2.0), rel=1e-13)


def test_static_loop() -> None:
    loop = Loop(Plant([1.0], [1.0]), PID(0.5))
    assert loop.sensitivity_peak().value == pytest.approx(2.0 / 3.0, rel=1e-15)
    with pytest.raises(LoopError, match="static"):
        loop.rightmost_pole()


# ---- the horizon covers every mode -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "controller",
    [
        PI(0.6, 0.5, b=0.4, setpoint_filter=20.0),
        PI(0.6, 0.5, b=0.4, setpoint_filter=((3.0, 1.0), (23.0, 1.0))),
        # the poles of a neutral loop tend to Re s = log(kd)/L = -0.05, nearer to the axis than those at low frequency
        PID(0.1, 0.3, 0.95, b=0.4),
    ],
)
def test_integrated_error_of_slow_filters_and_neutral_tails(controller: PID) -> None:
    """u(inf) = k (b - 1) + ki IE(r_f - y) = 1/K, and the filter adds the difference of its time constants."""
    loop = Loop(FOPTD, controller)
    assert loop.is_stable()
    y = loop.step()
    lag = 20.0 if controller.setpoint_filter else 0.0
    assert y.ie() == pytest.approx((1.0 + controller.k * 0.6) / controller.ki + lag, rel=1e-10)
    assert y(y.horizon) == pytest.approx(1.0, abs=1e-12)


# ---- plants given by a function ----------------------------------------------------------------------------------


def sech_root(s: np.ndarray) -> np.ndarray:
    """1/cosh(sqrt(s)), heat conduction through a wall, without overflow."""
    decay = np.exp(-np.sqrt(s))
    return np.asarray(2.0 * decay / (1.0 + decay**2))


def test_heat_conduction_through_a_wall() -> None:
    y = Loop(Plant.from_function(sech_root), PI(2.0, 8.0, b=0.6)).step()

    def transform(s: mpmath.mpc) -> mpmath.mpc:
        g = 1 / mpmath.cosh(mpmath.sqrt(s))
        return (mpmath.mpf(0.6) * 2 + 8 / s) * g / s / (1 + (2 + 8 / s) * g)

    with mpmath.workdps(30):
        for t in (0.1, 0.5, 1.2):
            assert y(t) == pytest.approx(float(talbot(transform, t, 40)), abs=1e-11)


def test_function_that_overflows_is_named() -> None:
    def ratio(s: np.ndarray) -> np.ndarray:
        return np.asarray(np.sinh(np.sqrt(s)) / np.cosh(np.sqrt(s)) / np.sqrt(s))

    with pytest.raises(LoopError, match="does not overflow"):
        Loop(Plant.from_function(ratio), PI(2.0, 8.0)).step()


def test_function_that_is_zero_over_zero_at_rest() -> None:
    # sqrt(s)/sinh(sqrt(s)) tends to 1 there
    plant = Plant.from_function(lambda s: 2.0 * np.sqrt(s) * np.exp(-np.sqrt(s)) / (1.0 - np.exp(-2.0 * np.sqrt(s))))
    response = Loop(plant, PI(0.8, 9.0)).respond()
    assert plant.gain == pytest.approx(1.0, rel=1e-12)
    assert response.output.final == 1.0
    assert response.control.final == pytest.approx(1.0, rel=1e-12)


# ---- plants of negative gain -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "plant", [FOPTD, Plant([1.0], [1.0, 2.0, 1.0, 0.0]), Plant.from_function(lambda s: np.exp(-np.sqrt(s)))]
)
def test_design_for_the_negated_plant_has_negated_gains(plant: Plant) -> None:
    pi, negated = design_pi(plant, ms=1.6), design_pi(-plant, ms=1.6)
    assert (negated.k, negated.ki, negated.b) == (-pi.k, -pi.ki, pi.b)
    w = np.geomspace(1e-3, 1e3, 200001)
    curve = (negated.k + negated.ki / (1j * w)) * -plant(1j * w)
    assert 1.0 / np.min(np.abs(1.0 + curve)) == pytest.approx(1.6, rel=1e-6)
    pid, mirrored = design_pid(plant, ms=1.6), design_pid(-plant, ms=1.6)
    assert (mirrored.k, mirrored.ki, mirrored.kd) == (-pid.k, -pid.ki, -pid.kd)
    assert mirrored.status == "optimal"


# ---- nonsense --------------------------------------------------------------------------------------------------------

Y = LOOP.step(until=20.0)
NONSENSE: dict[str, tuple[Callable[[], object], str]] = {
    "band nan": (lambda: Y.settling_time(NAN), "settling band"),
    "band negative": (lambda: Y.settling_time(-0.02), "settling band"),
    "rise reversed": (lambda: Y.rise_time(0.9, 0.1), "rise time"),
    "rise nan": (lambda: Y.rise_time(NAN, 0.9), "rise time"),
    "delay negative": (lambda: Y.delay_time(-0.5), "delay time"),
    "time nan": (lambda: Y(NAN), "not a number"),
    "time late": (lambda: Y(INF), "beyond"),
    "horizon inf": (lambda: LOOP.step(until=INF), "horizon"),
    "horizon nan": (lambda: LOOP.step(until=NAN), "horizon"),
    "setpoint nan": (lambda: LOOP.respond(setpoint=NAN, until=5.0), "setpoint step"),
    "load inf": (lambda: LOOP.respond(load=INF, until=5.0), "load step"),
    "load early": (lambda: LOOP.respond(load=1.0, load_at=-1.0, until=5.0), "0 <= load_at"),
    "load late": (lambda: LOOP.respond(load=1.0, load_at=9.0, until=5.0), "0 <= load_at"),
    "no poles": (lambda: LOOP.poles(0), "whole, from 1 to 10000"),
    "ms inf": (lambda: design_pi(FOPTD, ms=INF), "ms must be finite"),
    "mp inf": (lambda: design_pi(FOPTD, mp=INF), "mp must be finite"),
    "Ti zero": (lambda: PID.ideal(1.0, 0.0), "integral_time"),
    "Ti zero, PI": (lambda: PI.from_integral_time(1.0, 0.0), "integral_time"),
    "Ti zero, series": (lambda: PID.series(1.0, 0.0, 1.0), "integral_time"),
    "filter inf": (lambda: PID(1.0, setpoint_filter=INF), "setpoint_filter"),
    "filter a word": (lambda: PID(1.0, setpoint_filter="x"), "setpoint_filter"),  # type: ignore[arg-type]
    "filter improper": (lambda: PID(1.0, setpoint_filter=((1.0, 0.0), (1.0,))), "proper"),
    "filter unstable": (lambda: PID(1.0, setpoint_filter=((1.0,), (-1.0, 1.0))), "stable"),
    "filter an integrator": (lambda: PID(1.0, setpoint_filter=((1.0,), (1.0, 0.0))), "stable"),
    "filter zero": (lambda: PID(1.0, setpoint_filter=((0.0,), (1.0, 1.0))), "non-zero"),
    "filter without denominator": (lambda: PID(1.0, setpoint_filter=((1.0,), ())), "non-zero"),
    "plant a matrix": (lambda: Plant([[1.0]], [[1.0, 1.0]]), "two lists"),
    "constraint unknown": (lambda: Constraint("slope"), "'slope' is unknown"),  # type: ignore[arg-type]
    "constraint reversed": (lambda: Constraint("phase", 5.0, 2.0), "low < high"),
    "constraint a number": (lambda: Constraint(3), "constraint 3 is unknown"),  # type: ignore[arg-type]
    "constraint of arrays": (lambda: Constraint(np.ones(2)), "constraint array.* is unknown"),  # type: ignore[arg-type]
    "constraint from a word": (lambda: Constraint("phase", "a"), "range of the phase constraint must be numbers"),  # type: ignore[arg-type]
    "constraint to nothing": (lambda: Constraint("phase", 0.0, None), "0 <= low < high, not 0.0 to None"),  # type: ignore[arg-type]
    "constraint margin a word": (lambda: Constraint("curvature", margin="x"), "margin of the curvature"),  # type: ignore[arg-type]
    "constraint margin": (lambda: Constraint("curvature", margin=NAN), "margin"),
}


@pytest.mark.parametrize("name", NONSENSE)
def test_nonsense_is_refused_in_one_line(name: str) -> None:
    ask, words = NONSENSE[name]
    with pytest.raises(LoopError, match=words) as caught:
        ask()
    assert "\n" not in str(caught.value)


def test_no_controllers_no_responses() -> None:
    assert step_responses(FOPTD, [], 5.0) == []


@pytest.mark.parametrize("unit", [1.0, 1e-3, 1e6])
def test_a_response_that_grows_out_of_range_says_when_in_the_unit_of_its_loop(unit: float) -> None:
    one = Plant.foptd(1.0, unit, unit)
    control = PI(50.0, 10.0 / unit)
    unstable = Loop(Plant([1.0], [unit, -1.0], unit), PI(3.0, 1.0 / unit))
    asks: list[Callable[[], object]] = [
        lambda: Loop(one, control).step(until=1000.0 * unit),
        lambda: step_responses(one, [control], 1000.0 * unit),
        lambda: Loop(one + Plant.foptd(0.5, unit, 1.7 * unit), control).step(until=1000.0 * unit),
        lambda: Loop(one, SmithPredictor(control, Plant.foptd(2.0, unit, 2.0 * unit))).step(until=1000.0 * unit),
        lambda: unstable.saturated((-0.1, 0.1), until=1000.0 * unit),
    ]
    for ask in asks:
        with pytest.raises(LoopError, match="grows beyond") as caught:
            ask()
        said = re.search(r"by t = (\S+):", str(caught.value))
        assert said is not None
        # a dead time multiplies by 150 at the most
        assert 20.0 * unit < float(said[1]) <= 1000.0 * unit

"""Plants given by functions: Talbot's inversion in mpmath, exact poles, limits at rest, and refusals that say why."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import cache
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from loops.references import polished_root, talbot
from replicate.loops import PI, PID, Loop, LoopError, Plant, Signal

Function = Callable[[Any], Any]

#: Function for numpy, the same for mpmath, dead time.
FUNCTIONS: dict[str, tuple[Function, Function, float]] = {
    "diffusion": (lambda s: np.exp(-np.sqrt(s)), lambda s: mp.exp(-mp.sqrt(s)), 0.0),
    "fractional lag": (lambda s: 1 / (1 + s**0.9), lambda s: 1 / (1 + s ** mp.mpf("0.9")), 0.2),
    "half integrator": (lambda s: 1 / np.sqrt(s), lambda s: 1 / mp.sqrt(s), 0.0),
    "half integrator, dead time": (lambda s: 1 / np.sqrt(s), lambda s: 1 / mp.sqrt(s), 0.5),
    "sech": (
        lambda s: 2.0 * np.exp(-np.sqrt(s)) / (1.0 + np.exp(-2.0 * np.sqrt(s))), lambda s: mp.sech(mp.sqrt(s)), 0.0,
    ),
    "sech that overflows": (lambda s: 1.0 / np.cosh(np.sqrt(s)), lambda s: mp.sech(mp.sqrt(s)), 0.0),
    "tanh": (lambda s: np.tanh(np.sqrt(s)) / np.sqrt(s), lambda s: mp.tanh(mp.sqrt(s)) / mp.sqrt(s), 0.0),
    "half lag, dead time": (lambda s: 1 / (1 + np.sqrt(s)), lambda s: 1 / (1 + mp.sqrt(s)), 1.0),
    "a lag after all": (lambda s: 1 / (s + 1), lambda s: 1 / (s + 1), 1.0),
    "an integrator after all": (lambda s: 1 / s, lambda s: 1 / s, 1.0),
    "power of a lag": (lambda s: 1 / (s + 1) ** 1.5, lambda s: 1 / (s + 1) ** mp.mpf("1.5"), 0.3),
}  # fmt: skip

CONTROLLERS = {
    "P": PI(0.4),
    "PI": PI(0.5, 0.3),
    "PID, filter": PID(0.5, 0.3, 0.1, derivative_filter=0.05),
    "PI, filter of second order": PI(0.5, 0.3, measurement_filter=((1.0,), (0.005, 0.1, 1.0))),
}

TIMES = (0.05, 0.7, 2.3, 6.0)


def feedback(controller: PID, s: mp.mpc) -> mp.mpc:
    num, den = controller.measurement_filter_polynomials()
    derivative = mp.mpf(controller.kd) * s / (1 + s * mp.mpf(controller.derivative_filter))
    bare = mp.mpf(controller.k) + mp.mpf(controller.ki) / s + derivative
    return bare * mp.polyval(num.tolist(), s) / mp.polyval(den.tolist(), s)


def step(function: Function, dead_time: float, controller: PID, t: float) -> float:
    """Sum what has gone around the loop n times; each term is inverted on its own."""
    total, late = mp.mpf(0), mp.mpf(dead_time)
    with mp.workdps(40):

        def drive(s: mp.mpc) -> mp.mpc:
            return (controller.b * mp.mpf(controller.k) + mp.mpf(controller.ki) / s) * function(s) / s

        def around(n: int) -> Function:
            return lambda s: drive(s) * (-feedback(controller, s) * function(s)) ** n

        if not dead_time:
            return float(talbot(lambda s: drive(s) / (1 + feedback(controller, s) * function(s)), t))
        n = 0
        while t > late:
            total += talbot(around(n), t - late, 50)
            n, late = n + 1, late + mp.mpf(dead_time)
    return float(total)


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("plant", FUNCTIONS)
def test_step_response_against_talbot(plant: str, controller: str) -> None:
    function, exact, dead_time = FUNCTIONS[plant]
    loop = Loop(Plant.from_function(function, dead_time), CONTROLLERS[controller])
    y = loop.step(until=TIMES[-1])
    for t in TIMES:
        assert abs(float(y(t)) - step(exact, dead_time, CONTROLLERS[controller], t)) < 1e-12
    assert loop.is_stable()
    assert loop.horizon() > TIMES[-1]


def test_a_loop_without_poles_settles() -> None:
    # k/(1 + sqrt s + k) has no pole: its step response is k/(1+k) (1 - exp(a^2 t) erfc(a sqrt t)), a = 1 + k
    loop = Loop(Plant.from_function(lambda s: 1.0 / (1.0 + np.sqrt(s))), PI(1.0))
    with pytest.raises(LoopError, match="no pole off the negative real axis"):
        loop.rightmost_pole()
    assert loop.poles(3).size == 0
    y = loop.step()
    for t in (1e-3, 0.1, 3.0, 1e4):
        exact = (1 - mp.exp(4 * mp.mpf(t)) * mp.erfc(2 * mp.sqrt(t))) / 2
        assert float(y(t)) == pytest.approx(float(exact), rel=1e-11)
    tail = mp.findroot(lambda t: mp.exp(4 * t) * mp.erfc(2 * mp.sqrt(t)) - mp.mpf("0.02"), 199)
    assert y.settling_time() == pytest.approx(float(tail), rel=1e-9)
    assert y.overshoot() == 0.0


@pytest.mark.parametrize("k", [1e-9, 1e3, 1e6, 1e9, 1e12])
def test_a_response_much_faster_than_the_plant(k: float) -> None:
    # a load at 1/(1 + sqrt s) under k: (1 - exp(a^2 t) erfc(a sqrt t))/a, a = 1 + k
    d = Loop(Plant.from_function(lambda s: 1.0 / (1.0 + np.sqrt(s))), PI(k)).load_step()
    with mp.workdps(40):
        a = 1 + mp.mpf(k)
        for t in (1e-2 / a**2, 1.0 / a**2, 100.0 / a**2, 1e-3):
            exact = (1 - mp.exp(a**2 * mp.mpf(float(t))) * mp.erfc(a * mp.sqrt(float(t)))) / a
            assert float(d(float(t))) == pytest.approx(float(exact), rel=1e-12)
    assert d.peak() <= float(1 / a) * (1.0 + 1e-12)


@pytest.mark.parametrize("k", [30.0, 60.0, -3.0])
def test_unstable_loops_grow_as_their_poles_say(k: float) -> None:
    # k e^{-sqrt s} has the poles (ln(-k))^2; what is left of them is inverted on a contour of its own
    loop = Loop(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), PI(k))
    assert not loop.is_stable()
    y = loop.step(until=1.5)
    with mp.workdps(40):
        pole = (mp.log(abs(k)) + (mp.pi * 1j if k > 0 else 0)) ** 2

        def closed(s: mp.mpc) -> mp.mpc:
            return k * mp.exp(-mp.sqrt(s)) / (1 + k * mp.exp(-mp.sqrt(s))) / s

        for t in (0.05, 0.4, 1.5):
            # 1 + k e^{-sqrt s} has the slope 1/(2 sqrt s) at its zero, k e^{-sqrt s} the value -1
            residue = -2 * mp.sqrt(pole) * mp.exp(pole * t) / pole
            grown = residue if k < 0 else 2 * residue.real
            shifted = talbot(lambda s: closed(s + 60), t, 120)
            exact = shifted * mp.exp(60 * mp.mpf(t))
            assert float(y(t)) == pytest.approx(float(mp.re(exact)), rel=1e-9)
            if t == 1.5:
                assert abs(float(mp.re(exact - grown))) < 10.0  # what grows is the pole's


@pytest.mark.parametrize("controller", [PI(0.5, 0.3), PI(0.0, 0.1), PID(0.5, 0.3, 0.1, derivative_filter=0.05)])
def test_real_poles_of_a_function_without_a_cut(controller: PID) -> None:
    loop = Loop(Plant.from_function(lambda s: 1.0 / (s + 1.0) ** 2, 1.0), controller)
    rational = Loop(Plant([1.0], [1.0, 2.0, 1.0], 1.0), controller).rightmost_pole()
    with mp.workdps(30):
        pole = polished_root(lambda s: 1 + feedback(controller, s) * mp.exp(-s) / (s + 1) ** 2, rational)
    assert abs(loop.rightmost_pole() - complex(pole)) < 1e-12 * abs(pole)


def test_a_double_pole_where_the_controller_cancels_the_function_s() -> None:
    k = float(np.exp(-1.0))
    loop = Loop(Plant.from_function(lambda s: 1.0 / (s + 1.0), 1.0), PI(k, k))
    assert loop.rightmost_pole() == pytest.approx(-1.0, rel=1e-7)


@pytest.mark.parametrize("missed", [0.0, 1e-6, -1e-4, 0.03])
@pytest.mark.parametrize("damping", [0.2, 0.8])
def test_zeros_of_the_controller_on_or_beside_poles_of_the_function(damping: float, missed: float) -> None:
    polynomial, dead_time, ki = [1.0, 2.0 * damping, 1.0], 0.3, 0.4
    beside = damping * (1.0 + missed)
    controller = PID(2.0 * beside * ki, ki, ki, derivative_filter=0.01)
    loop = Loop(Plant.from_function(lambda s: 1.0 / np.polyval(polynomial, s), dead_time), controller)
    rational = Loop(Plant([1.0], polynomial, dead_time), controller)
    start = rational.poles(1)[0]

    def characteristic(s: mp.mpc) -> mp.mpc:
        lag = 1 + mp.mpf(controller.derivative_filter) * s
        top = (controller.k * s + mp.mpf(controller.ki)) * lag + controller.kd * s**2
        return s * lag * mp.polyval(polynomial, s) + top * mp.exp(-mp.mpf(dead_time) * s)

    with mp.workdps(30):
        pole = complex(polished_root(characteristic, start))
    assert loop.rightmost_pole() == pytest.approx(pole, rel=1e-10)
    times = np.array([0.7, 3.0, 11.0])
    np.testing.assert_allclose(loop.load_step(until=12.0)(times), rational.load_step(until=12.0)(times), atol=1e-11)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e6])
@pytest.mark.parametrize(
    ("function", "gain"),
    [
        (lambda s: (1.0 - np.exp(-s)) / s, 1.0),
        (lambda s: (1.0 - np.exp(-np.sqrt(s))) / np.sqrt(s), 1.0),
        (lambda s: np.tanh(np.sqrt(s)) / np.sqrt(s), 1.0),
        (lambda s: s / (s + 1.0), 0.0),
        (lambda s: 1.0 / s, np.inf),
        (lambda s: s**-0.1, np.inf),
    ],
)
def test_the_gain_is_the_limit_at_rest(function: Function, gain: float, unit: float) -> None:
    assert Plant.from_function(lambda s: function(s * unit)).gain == pytest.approx(gain, rel=1e-11)


@pytest.mark.parametrize(
    ("function", "reason"),
    [
        (lambda s: (1.0 - np.exp(-s)) / s, "holds a dead time of about"),
        (lambda s: np.exp(-np.sqrt(s) * np.sqrt(s + 1.0)), "holds a dead time of about 1:"),
        (lambda s: np.exp(-3.0 * s) / (s + 1.0), "holds a dead time of about"),
        (lambda s: np.where(np.abs(s) > 20.0, np.nan, 1.0 / (s + 1.0)), "is not finite at"),
    ],
)
def test_what_cannot_be_inverted_is_refused_with_the_right_reason(function: Function, reason: str) -> None:
    loop = Loop(Plant.from_function(function), PI(0.0, 1e-7))
    with pytest.raises(LoopError, match=reason):
        loop.step(until=30.0)


@pytest.mark.parametrize("controller", [PI(0.4), PI(0.5, 0.3), PID(0.5, 0.3, 0.1, derivative_filter=0.05)])
def test_a_function_that_overflows_without_vanishing_is_named(controller: PID) -> None:
    plant = Plant.from_function(lambda s: np.sinh(np.sqrt(s)) / np.cosh(np.sqrt(s)) / np.sqrt(s))
    with pytest.raises(LoopError, match="is not finite at"):
        Loop(plant, controller).step(until=6.0)


# ---- integrals over all time -----------------------------------------------------------------------------------------


@cache
def absolute_error(error: Function, whole: float, guesses: tuple[float, ...]) -> float:
    """Integrate |e| from the transform of e: between its sign changes, and what is left of its whole integral."""
    with mp.workdps(40):
        zeros = [mp.findroot(lambda t: talbot(error, t), (0.98 * g, 1.02 * g), tol=1e-20) for g in guesses]
        running = [mp.mpf(0), *(talbot(lambda s: error(s) / s, t) for t in zeros), mp.mpf(whole)]
        return float(sum(abs(b - a) for a, b in itertools.pairwise(running)))


def where_it_crosses_one(y: Signal, unit: float) -> tuple[float, ...]:
    """Return where to look for sign changes of the error, in units of time; three digits, the same in every unit."""
    return tuple(float(f"{t / unit:.3g}") for t in y.crossings(1.0) if t < 1e4 * unit)


def diffusion_error(s: mp.mpc) -> mp.mpc:
    """Return the error's transform of e^{-sqrt s} under 0.9 + 5/s."""
    return 1 / (s + (mp.mpf(0.9) * s + 5) * mp.exp(-mp.sqrt(s)))


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e6])
def test_absolute_error_of_a_response_that_ends_like_a_power_of_time(unit: float) -> None:
    k, ki = 0.9, 5.0
    plant = Plant.from_function(lambda s: np.exp(-np.sqrt(s * unit)))
    y = Loop(plant, PI(k, ki / unit)).step()
    crossings = where_it_crosses_one(y, unit)
    assert crossings
    assert y.ie() / unit == pytest.approx(1.0 / ki, rel=1e-11)
    assert y.iae() / unit == pytest.approx(absolute_error(diffusion_error, 1.0 / ki, crossings), rel=1e-10)
    assert (2.0 * y).iae() == pytest.approx(2.0 * y.iae(), rel=1e-13)
    for refused in (y.itae, y.itse, (y + y).iae):
        with pytest.raises(LoopError, match=r"like a power of time: its \w+ cannot be computed"):
            refused()
    d = Loop(plant, PI(k, ki / unit)).load_step()
    assert d.ie() / unit == pytest.approx(1.0 / ki, rel=1e-11)
    later = Loop(plant, PI(k, ki / unit)).respond(load=1.0, load_at=unit)
    with pytest.raises(LoopError, match="cannot be computed"):
        later.output.iae()


def test_absolute_error_of_a_response_that_decays() -> None:
    # tanh(sqrt s)/sqrt s has poles, but no cut
    k, ki = 0.5, 0.3
    y = Loop(Plant.from_function(lambda s: np.tanh(np.sqrt(s)) / np.sqrt(s)), PI(k, ki)).step()
    assert y.horizon < 1e4
    assert y.iae() == pytest.approx(1.0 / ki, rel=1e-11)  # it never exceeds its final value
    with mp.workdps(40):
        slope = mp.diff(lambda s: 1 / (s + (k * s + ki) * mp.tanh(mp.sqrt(s)) / mp.sqrt(s)), mp.mpf("1e-3"), h=1e-15)
    assert y.itae() > 0.0
    assert abs(y.itae() / float(-slope) - 1.0) < 0.1


#: Functions that begin like a power of s other than one half; their gain at rest.
POWERS: dict[str, tuple[Function, Function, float]] = {
    "0.3": (lambda s: 1 / (1 + s**0.3), lambda s: 1 / (1 + s ** mp.mpf("0.3")), 1.0),
    "0.1": (lambda s: 1 / (1 + s**0.1), lambda s: 1 / (1 + s ** mp.mpf("0.1")), 1.0),
    "0.3 and 1": (lambda s: 1 / (1 + 2 * s**0.3 + s), lambda s: 1 / (1 + 2 * s ** mp.mpf("0.3") + s), 1.0),
    "-0.3": (lambda s: s**-0.3, lambda s: s ** -mp.mpf("0.3"), np.inf),
    "-0.7": (lambda s: s**-0.7, lambda s: s ** -mp.mpf("0.7"), np.inf),
}


@cache
def error_of_power(name: str) -> Function:
    """Return the error's transform of a function of ``POWERS`` under 0.5 + 0.3/s."""
    exact = POWERS[name][1]
    return lambda s: 1 / (s + (0.5 * s + 0.3) * exact(s))


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e6])
@pytest.mark.parametrize("name", POWERS)
def test_integrals_of_responses_that_end_like_other_powers_of_time(name: str, unit: float) -> None:
    function, _, gain = POWERS[name]
    plant = Plant.from_function(lambda s: function(s * unit))
    loop = Loop(plant, PI(0.5, 0.3 / unit))
    y, d = loop.step(), loop.load_step()
    # the error's transform at rest: (1 + (b - 1) k G) / (ki G) for set-points, G / (ki G) for loads
    assert y.ie() / unit == pytest.approx(1.0 / (0.3 * gain), rel=1e-12, abs=1e-30)
    assert d.ie() / unit == pytest.approx(1.0 / 0.3, rel=1e-12)
    weighted = Loop(plant, PI(0.5, 0.3 / unit, b=0.2)).step()
    assert weighted.ie() / unit == pytest.approx(1.0 / (0.3 * gain) + 0.8 * 0.5 / 0.3, rel=1e-12)

    expected = absolute_error(error_of_power(name), 1.0 / (0.3 * gain), where_it_crosses_one(y, unit))
    assert y.iae() / unit == pytest.approx(expected, rel=1e-10)
    for never in (Loop(plant, PI(0.5)).step(), Loop(plant, PI(0.5)).load_step()):  # falls like a power above -1
        assert never.ie() == np.inf
        assert never.iae() == np.inf


def test_an_error_that_falls_like_a_power_of_the_logarithm_of_time() -> None:
    k, ki = 0.5, 0.3
    y = Loop(Plant.from_function(lambda s: np.log(1.0 + 1.0 / s)), PI(k, ki)).step()
    assert y.ie() == 0.0  # the limit of 1/(s + (k s + ki) G)

    def error(s: mp.mpc) -> mp.mpc:
        return 1 / (s + (k * s + ki) * mp.log(1 + 1 / s))

    assert y.iae() == pytest.approx(absolute_error(error, 0.0, where_it_crosses_one(y, 1.0)), rel=1e-10)


def test_integrals_that_do_not_converge() -> None:
    # k/(1 + k + sqrt s): the error falls like 1/sqrt(t)
    y = Loop(Plant.from_function(lambda s: 1.0 / (1.0 + np.sqrt(s))), PI(1.0)).step()
    assert y.ie() == np.inf
    assert y.iae() == np.inf
    with pytest.raises(LoopError, match="ISE cannot be computed"):
        y.ise()


@cache
def metrics(name: str, unit: float, gain: float) -> np.ndarray:
    """Return metrics of a loop in other units of time and gain, in those of the function."""
    function, _, dead_time = FUNCTIONS[name]
    plant = Plant.from_function(lambda s: gain * function(s * unit), dead_time * unit)
    loop = Loop(plant, PI(0.5 / gain, 0.6 / gain / unit))
    y, d, m = loop.step(), loop.load_step(), loop.margins()
    return np.array([
        1.0 + y.overshoot(), y.settling_time() / unit, y.rise_time() / unit, y.iae() / unit,
        d.iae() / unit / gain, float(d.peak()) / gain, float(loop.sensitivity_peak()),
        m.gain, m.phase, m.delay / unit, (loop.rightmost_pole() * unit).real,
    ])  # fmt: skip


@pytest.mark.parametrize(("unit", "gain"), [(1e-12, 1e-9), (1e12, 1e9), (1e-3, 1e6), (1e6, 1e-9)])
@pytest.mark.parametrize("name", ["diffusion", "fractional lag", "tanh"])
def test_a_function_in_other_units_is_the_same_function(name: str, unit: float, gain: float) -> None:
    assert metrics(name, unit, gain) == pytest.approx(metrics(name, 1.0, 1.0), rel=1e-10)

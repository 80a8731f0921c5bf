"""Smith predictors: closed forms where model and plant agree, independent methods where they do not."""

from __future__ import annotations

from itertools import pairwise, product
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from replicate.loops import PI, PID, ImproperLoopError, Loop, LoopError, Plant, SmithPredictor, UnstableLoopError
from replicate.loops.inputs import Sine

Array = NDArray[np.float64]

MODEL = Plant.foptd(1.0, 1.0, 2.0)
PRIMARY = PI(2.0, 2.0)
MATCHED = Loop(MODEL, SmithPredictor(PI(3.0, 3.0), MODEL))
ACTUAL = {"gain": 1.2, "time_constant": 1.1, "dead_time": 2.3}
MISMATCHED = Loop(Plant.foptd(**ACTUAL), SmithPredictor(PRIMARY, MODEL))


# ---- model and plant agree -----------------------------------------------------------------------------------------


def test_the_set_point_response_is_that_without_dead_time_delayed() -> None:
    t = np.linspace(0.0, 9.0, 200)
    y, u = MATCHED.respond(until=9.0).output, MATCHED.respond(until=9.0).control
    np.testing.assert_allclose(y(t), np.where(t < 2.0, 0.0, 1.0 - np.exp(-3.0 * (t - 2.0))), atol=1e-13)
    np.testing.assert_allclose(u(t), 1.0 + 2.0 * np.exp(-3.0 * t), atol=1e-13)
    plant = Plant([1.0], np.poly([-1.0, -2.0, -0.5]), 1.7)
    primary = PID(1.0, 0.4, 0.6, b=0.7, derivative_filter=0.1, measurement_filter=0.05)
    predicted = Loop(plant, SmithPredictor(primary, plant)).step(until=20.0)
    free = Loop(Plant(plant.num, plant.den), primary).step(until=20.0)
    t = np.linspace(1.7, 20.0, 200)
    np.testing.assert_allclose(predicted(t), free(t - 1.7), atol=1e-12)


def test_poles_are_those_without_dead_time_and_those_of_the_model() -> None:
    np.testing.assert_allclose(MATCHED.poles(), [-1.0, -3.0], rtol=1e-12)
    assert MATCHED.rightmost_pole() == pytest.approx(-1.0)


def test_a_load_shows_for_a_dead_time_before_anything_can_be_done() -> None:
    # y = G (1 - T e^{-2s}) / s with T = 3/(s+3)
    d = MATCHED.load_step(until=12.0)

    def late(t: float) -> float:
        # 3 / (s (s+1) (s+3)): 1 - 3/2 e^{-t} + 1/2 e^{-3t}
        return 0.0 if t < 0 else 1.0 - 1.5 * np.exp(-t) + 0.5 * np.exp(-3.0 * t)

    t = np.linspace(0.0, 12.0, 121)
    exact = [(1.0 - np.exp(-(x - 2.0)) if x > 2.0 else 0.0) - late(x - 4.0) for x in t]
    np.testing.assert_allclose(d(t), exact, atol=1e-13)
    assert MATCHED.load_step().ie() == pytest.approx(1.0 / 3.0 + 2.0, rel=1e-12)  # 1/ki of the predictor


def test_without_dead_time_in_the_model_it_is_the_controller_itself() -> None:
    plant = Plant.foptd(1.0, 1.0, 0.5)
    plain, predicted = Loop(plant, PRIMARY), Loop(plant, SmithPredictor(PRIMARY, Plant.foptd(1.0, 1.0, 0.0)))
    np.testing.assert_allclose(predicted.poles(), plain.poles(), rtol=1e-12)
    assert predicted.sensitivity_peak() == pytest.approx(plain.sensitivity_peak(), rel=1e-12)
    assert repr(predicted.margins()) == repr(plain.margins())  # nan among them


def test_an_integrating_plant_keeps_an_offset_under_a_load() -> None:
    # G_0 - G has the gain K L at rest: y = r + K L d
    plant = Plant([0.5], [1.0, 0.0], 2.0)
    loop = Loop(plant, SmithPredictor(PI(1.0, 0.2), plant))
    response = loop.respond(load=0.3)
    assert response.output.final == pytest.approx(1.0 + 0.5 * 2.0 * 0.3)
    assert float(response.output(response.output.horizon)) == pytest.approx(response.output.final, abs=1e-10)
    assert float(response.control(response.output.horizon)) == pytest.approx(-0.3, abs=1e-10)


# ---- model and plant differ ----------------------------------------------------------------------------------------


def equivalent(s: Any) -> tuple[Any, Any]:
    """Return L and 1 + C (G + G_0 - G_m) from the formula of the predictor, at mpmath's precision."""
    model = 1 / (s + 1)
    plant = mp.mpf("1.2") * mp.exp(-s * mp.mpf("2.3")) / (mp.mpf("1.1") * s + 1)
    controller = 2 + 2 / s
    difference = model * (1 - mp.exp(-2 * s))
    return plant * controller / (1 + controller * difference), 1 + controller * (plant + difference)


def test_loop_transfer_and_sensitivities_are_those_of_the_formula() -> None:
    for w in (1e-3, 0.1, 0.8, 3.0, 40.0):
        exact = complex(equivalent(mp.mpc(0, w))[0])
        assert complex(MISMATCHED(1j * w)) == pytest.approx(exact, rel=1e-11)
        assert complex(MISMATCHED.S(1j * w)) == pytest.approx(1 / (1 + exact), rel=1e-11)
        assert complex(MISMATCHED.transfer(1j * w)) == pytest.approx(exact, rel=1e-11)
        assert complex(MISMATCHED.controller.feedback(1j * w) * MISMATCHED.plant(1j * w)) == pytest.approx(exact)


def test_every_pole_is_a_zero_of_the_formula_and_none_is_missing() -> None:
    poles = MISMATCHED.poles(6)
    for pole in poles:
        root = mp.findroot(lambda s: equivalent(s)[1], mp.mpc(complex(pole)))
        assert complex(root) == pytest.approx(complex(pole), rel=1e-11)
    # the argument principle to the right of the last one: f has poles at 0 (left of the contour's side at -0.45 not)
    left = float(poles[2].real) - 0.02
    top = 60.0
    corners = [complex(left, -top), complex(30, -top), complex(30, top), complex(left, top), complex(left, -top)]
    path = np.concatenate([np.linspace(a, b, 6000) for a, b in pairwise(corners)])
    c, g = 2 + 2 / path, 1.2 * np.exp(-2.3 * path) / (1.1 * path + 1)
    f = path * (1 + c * (g + (1 - np.exp(-2 * path)) / (path + 1)))  # times s: entire right of -1/1.1
    turns = np.sum(np.angle(f[1:] / f[:-1])) / (2 * np.pi)
    assert round(turns) == sum(2 if p.imag else 1 for p in poles if p.real > left)


def test_peak_and_margins_are_those_of_the_formula() -> None:
    w = np.geomspace(1e-3, 40.0, 200_001)
    s = 1j * w
    c = 2 + 2 / s
    loop = 1.2 * np.exp(-2.3 * s) / (1.1 * s + 1) * c / (1 + c * (1 - np.exp(-2 * s)) / (s + 1))
    peak = MISMATCHED.sensitivity_peak()
    assert peak.value == pytest.approx(np.max(1 / np.abs(1 + loop)), rel=1e-7)
    assert MISMATCHED.complementary_peak().value == pytest.approx(np.max(np.abs(loop / (1 + loop))), rel=1e-7)
    margins = MISMATCHED.margins()
    # at a margin the loop is on the edge of stability
    at_gain = complex(equivalent(mp.mpc(0, margins.phase_crossover))[0])
    assert margins.gain * at_gain == pytest.approx(-1.0, rel=1e-9)
    at_delay = complex(equivalent(mp.mpc(0, margins.delay_crossover))[0])
    assert at_delay * np.exp(-1j * margins.delay_crossover * margins.delay) == pytest.approx(-1.0, rel=1e-9)
    for factor, stable in ((0.999, True), (1.001, False)):
        more = Plant.foptd(ACTUAL["gain"] * (1 + (margins.gain - 1) * factor), 1.1, 2.3)
        assert Loop(more, SmithPredictor(PRIMARY, MODEL)).is_stable() is stable
        later = Plant.foptd(1.2, 1.1, 2.3 + margins.delay * factor)
        assert Loop(later, SmithPredictor(PRIMARY, MODEL)).is_stable() is stable


def by_integration(end: float, load: float) -> tuple[Any, Any]:
    """Return output and control signal by `solve_ivp`, between all sums of the two dead times."""
    gain, lag, delay, own = ACTUAL["gain"], ACTUAL["time_constant"], ACTUAL["dead_time"], MODEL.dead_time
    sums = sorted({round(i * delay + j * own, 12) for i, j in product(range(9), repeat=2)})
    stops = [t for t in sums if 0 < t < end] + [end]
    segments: list[tuple[float, float, Any]] = []

    def past(t: float) -> Array:
        if t < 0:
            return np.zeros(3)
        return next(np.asarray(sol(t)) for start, _, sol in reversed(segments) if start <= t)

    def control(t: float, x: Array) -> float:
        measured = x[0] + x[1] - past(t - own)[1]
        return float(2.0 * (1.0 - measured) + x[2])

    def delayed_control(t: float) -> float:
        return control(t, past(t)) if t >= 0 else 0.0

    def slope(t: float, x: Array) -> Array:
        entering = delayed_control(t - delay) + (load if t >= delay else 0.0)
        u = control(t, x)
        measured = x[0] + x[1] - past(t - own)[1]
        return np.array([(gain * entering - x[0]) / lag, u - x[1], 2.0 * (1.0 - measured)])

    x, start = np.zeros(3), 0.0
    for stop in stops:
        inside = stop - 1e-13
        found: Any = solve_ivp(slope, (start, inside), x, method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
        segments.append((start, stop, found.sol))
        x, start = found.y[:, -1], stop
    return (lambda t: past(t)[0]), (lambda t: control(t, past(t)))


def test_the_response_is_that_of_an_independent_integration() -> None:
    y, u = by_integration(9.0, 0.4)
    response = MISMATCHED.respond(load=0.4, until=9.0)
    for t in np.linspace(0.05, 8.95, 60):
        assert float(response.output(t)) == pytest.approx(y(t), abs=1e-10)
        assert float(response.control(t)) == pytest.approx(u(t), abs=1e-10)


def test_the_response_settles_where_it_has_to() -> None:
    response = MISMATCHED.respond(load=0.4)
    assert response.output.final == pytest.approx(1.0)
    assert response.control.final == pytest.approx(1.0 / 1.2 - 0.4)
    end = response.output.horizon
    assert float(response.output(end)) == pytest.approx(1.0, abs=1e-11)
    assert float(response.control(end)) == pytest.approx(1.0 / 1.2 - 0.4, abs=1e-11)
    without = Loop(Plant.foptd(**ACTUAL), SmithPredictor(PI(0.5), MODEL)).respond(load=0.4)
    assert float(without.output(without.output.horizon)) == pytest.approx(without.output.final, abs=1e-11)


def test_other_inputs_limits_and_units_work_as_for_any_loop() -> None:
    w = 0.3
    noisy = MISMATCHED.respond_to(output=Sine(1.0, w), until=200.0).output
    amplitude = abs(complex(MISMATCHED.S(1j * w)))
    last = np.linspace(180.0, 200.0, 2000)
    assert np.max(np.abs(noisy(last))) == pytest.approx(amplitude, rel=1e-3)
    assert MISMATCHED.saturated((-9.0, 9.0), until=20.0).output(7.3) == pytest.approx(
        float(MISMATCHED.step(until=20.0)(7.3)), abs=1e-11
    )
    assert MISMATCHED.saturated((0.0, 1.1), "clamping").output.settling_time() > 2.3
    assert "SmithPredictor" in repr(MISMATCHED)
    assert MISMATCHED.summary().ms == MISMATCHED.sensitivity_peak().value
    slow = Loop(Plant.foptd(1.2e6, 1100.0, 2300.0), SmithPredictor(PI(2e-6, 2e-9), Plant.foptd(1e6, 1000.0, 2000.0)))
    assert slow.sensitivity_peak() == pytest.approx(MISMATCHED.sensitivity_peak(), rel=1e-11)
    assert slow.margins().delay == pytest.approx(1000.0 * MISMATCHED.margins().delay, rel=1e-10)
    t = np.linspace(0.0, 20.0, 100)
    np.testing.assert_allclose(slow.step(until=2e4)(1e3 * t), MISMATCHED.step(until=20.0)(t), atol=1e-11)


# ---- what is refused -----------------------------------------------------------------------------------------------


def test_an_unstable_plant_is_not_stabilised() -> None:
    plant = Plant([1.0], [1.0, -0.2], 1.0)
    loop = Loop(plant, SmithPredictor(PI(2.0, 1.0), plant))
    assert not Loop(Plant.foptd(3.0, 1.0, 2.5), SmithPredictor(PI(9.0, 9.0), MODEL)).is_stable()
    assert loop.unstable_poles() >= 0
    with pytest.raises(UnstableLoopError):
        Loop(Plant.foptd(3.0, 1.0, 2.5), SmithPredictor(PI(9.0, 9.0), MODEL)).sensitivity_peak()


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: SmithPredictor(1.0, MODEL), "the controller of a Smith predictor must be a PI or PID, not float"),  # type: ignore[arg-type]
        (lambda: SmithPredictor(PRIMARY, "x"), "the model of a Smith predictor must be a Plant, not str"),  # type: ignore[arg-type]
        (lambda: SmithPredictor(PRIMARY, MODEL + Plant([1.0], [1.0], 1.0)), "rational plant with one dead time"),
        (lambda: Loop(1.0, SmithPredictor(PRIMARY, MODEL)), "the plant of a loop must be a Plant"),  # type: ignore[arg-type]
        (
            lambda: Loop(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), SmithPredictor(PRIMARY, MODEL)),
            "needs a rational plant",
        ),
        (MATCHED.to_control, "only a loop with a PI or PID controller"),
    ],
)  # fmt: skip
def test_a_wrong_argument_is_named_in_one_line(build: Any, message: str) -> None:
    with pytest.raises(LoopError, match=message) as caught:
        build()
    assert "\n" not in str(caught.value)


def test_a_gain_that_does_not_vanish_is_refused() -> None:
    delay = Plant([1.0], [1.0], 1.0)
    with pytest.raises(ImproperLoopError, match="vanishes at high frequency"):
        Loop(delay, SmithPredictor(PI(0.5, 0.5), delay))
    assert Loop(delay, SmithPredictor(PI(0.0, 0.5), delay)).poles()[0] == pytest.approx(-0.5)

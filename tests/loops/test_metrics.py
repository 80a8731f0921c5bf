"""Metrics of responses: closed forms, and roots and integrals of the references.

The promise is 1e-9 relative for every metric. A time at which the response is flat (a peak's) is determined by half
of the digits only, its value by all.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from loops.closed_forms import foptd_load_ise, integrator_p_ise
from loops.problems import INTEGRAL, PROBLEMS, STABLE
from loops.references import ReferenceLoop, crossing
from replicate.loops import PI, Loop, LoopError, NotSettledError, Plant, Signal, UnstableLoopError

PROMISE = 1e-9

Array = NDArray[np.float64]

# --------------------------------------------------------------------------------------------------------------
# closed forms


@pytest.mark.parametrize("dead_time", [100.0, 300.0, 1000.0])
def test_a_peak_that_lasts_a_dead_time_is_where_it_begins(dead_time: float) -> None:
    # until the loop answers y = 1 - e^{-(t - L)}: one to within rounding long before t = 2 L
    load = Loop(Plant([1.0], [1.0, 1.0], dead_time), PI(0.2, 0.2 / dead_time)).load_step()
    rounding = -np.log(1e-14)
    assert float(load.peak()) == pytest.approx(1.0, abs=1e-13)
    assert 0.9 * rounding < load.peak().time - dead_time < 1.5 * rounding


@given(st.floats(0.05, 20.0))
def test_first_order_loop(k: float) -> None:
    # y = 1 - e^{-kt}
    loop = Loop(Plant([1.0], [1.0, 0.0]), PI(k=k))
    y = loop.step()
    assert y.overshoot() == pytest.approx(0.0, abs=1e-12)
    assert y.rise_time(0.1, 0.9) == pytest.approx(np.log(9) / k, rel=1e-11)
    assert y.delay_time(0.5) == pytest.approx(np.log(2) / k, rel=1e-11)
    assert y.settling_time(0.02) == pytest.approx(np.log(50) / k, rel=1e-11)
    assert y.settling_time(0.05) == pytest.approx(np.log(20) / k, rel=1e-11)
    assert y.iae() == pytest.approx(1 / k, rel=1e-11)
    assert y.ie() == pytest.approx(1 / k, rel=1e-11)
    assert y.ise() == pytest.approx(1 / (2 * k), rel=1e-11)
    assert y.itae() == pytest.approx(1 / k**2, rel=1e-11)
    assert y.itse() == pytest.approx(1 / (4 * k**2), rel=1e-11)
    # a load step leaves the offset 1/k, since there is no integral action
    load = loop.load_step()
    assert load.settling_time(0.02) == pytest.approx(np.log(50) / k, rel=1e-11)
    assert load.final == pytest.approx(1 / k, rel=1e-14)


@given(st.floats(0.05, 0.95), st.floats(0.1, 10.0))
def test_second_order_loop(zeta: float, w0: float) -> None:
    # e = 1 - y solves e'' + 2 zeta w0 e' + w0^2 e = 0, e(0) = 1, e'(0) = 0; extrema at n pi/wd with |e| = q^n
    root = np.sqrt(1 - zeta**2)
    sigma, wd, q = zeta * w0, w0 * root, np.exp(-np.pi * zeta / root)

    def error(t: Array) -> Array:
        return np.asarray(np.exp(-sigma * t) * (np.cos(wd * t) + sigma / wd * np.sin(wd * t)))

    y = Loop(Plant([1.0], [1.0, 2 * sigma, 0.0]), PI(k=w0**2)).step()
    assert y.overshoot() == pytest.approx(q, rel=PROMISE)
    assert y.peak().value == pytest.approx(1 + q, rel=1e-12)
    assert y.peak().time == pytest.approx(np.pi / wd, rel=1e-6)
    # zero crossings of the error, and its integral up to the first one
    first = (np.pi - np.arctan2(wd, sigma)) / wd
    slope = -(w0**2) / wd * np.exp(-sigma * first) * np.sin(wd * first)
    whole = 2 * zeta / w0
    before = whole - slope / w0**2
    half_wave = (before - whole) * (1 + q)
    assert y.ie() == pytest.approx(whole, rel=PROMISE)
    assert y.iae() == pytest.approx(before + half_wave / (1 - q), rel=PROMISE)
    assert y.ise() == pytest.approx((1 + 4 * zeta**2) / (4 * zeta * w0), rel=PROMISE)
    for band in (0.02, 0.05):
        n = int(np.floor(np.log(band) / np.log(q)))  # the last extremum outside the band
        assume(abs(np.log(band) / np.log(q) - round(np.log(band) / np.log(q))) > 1e-3)
        low, high = n * np.pi / wd, first + n * np.pi / wd
        for _ in range(200):
            middle = 0.5 * (low + high)
            is_outside = (-1) ** n * error(np.array(middle)) > band
            low, high = (middle, high) if is_outside else (low, middle)
        assert y.settling_time(band) == pytest.approx(low, rel=PROMISE)


def test_time_weighted_integrals_of_a_second_order_loop() -> None:
    zeta, w0 = 0.5, 2.0
    y = Loop(Plant([1.0], [1.0, 2 * zeta * w0, 0.0]), PI(k=w0**2)).step()
    with mp.workdps(25):
        wd, sigma = w0 * mp.sqrt(1 - mp.mpf(zeta) ** 2), zeta * w0
        first = (mp.pi - mp.atan2(wd, sigma)) / wd
        ends = [0, first, *(first + n * mp.pi / wd for n in range(1, 25))]

        def error(t: mp.mpf) -> mp.mpf:
            return mp.exp(-sigma * t) * (mp.cos(wd * t) + sigma / wd * mp.sin(wd * t))

        itae = mp.quad(lambda t: t * abs(error(t)), ends)
        itse = mp.quad(lambda t: t * error(t) ** 2, ends)
    assert y.itae() == pytest.approx(float(itae), rel=PROMISE)
    assert y.itse() == pytest.approx(float(itse), rel=PROMISE)


def test_integrating_plant_under_proportional_control() -> None:
    # e^{-s}/s, k = 0.8, with z = t - 2 on [2, 3] and w = t - 3 on [3, 4]:
    # y = 0.8 (t - 1); 0.8 + 0.8 z - 0.32 z^2; 0.8 (t - 1) - 0.32 (t - 2)^2 + 0.8^3/6 (t - 3)^3
    y = Loop(Plant([1.0], [1.0, 0.0], dead_time=1.0), PI(k=0.8)).step()
    z = (0.8 - np.sqrt(0.64 - 0.128)) / 0.64
    assert y.delay_time(0.5) == pytest.approx(1 + 0.5 / 0.8, rel=1e-12)
    assert y.rise_time(0.1, 0.9) == pytest.approx(2 + z - 1.125, rel=1e-12)
    w = (0.64 - np.sqrt(0.64**2 - 4 * 0.256 * 0.16)) / 0.512
    peak = 0.8 * (2 + w) - 0.32 * (1 + w) ** 2 + 0.8**3 / 6 * w**3
    assert y.overshoot() == pytest.approx(peak - 1, rel=1e-11)
    assert y.peak().time == pytest.approx(3 + w, rel=1e-7)
    assert y.ise() == pytest.approx(float(integrator_p_ise(1.0, 1.0, 0.8)), rel=PROMISE)
    assert y.ie() == pytest.approx(1 / 0.8, rel=PROMISE)


def test_staircase() -> None:
    # e^{-s} under P control: y = c (1 - (-k)^n) on [n, n+1), c = k/(1+k): all metrics are geometric sums
    k, c = 0.6, 0.375
    y = Loop(Plant([1.0], [1.0], dead_time=1.0), PI(k=k)).step()
    assert y.final == pytest.approx(c, rel=1e-15)
    assert y.overshoot() == pytest.approx(k, rel=1e-12)
    assert y.peak().time == pytest.approx(1.0, abs=1.0)  # anywhere on [1, 2]
    assert y.rise_time(0.1, 0.9) == pytest.approx(0.0, abs=1e-12)
    assert y.delay_time(0.5) == pytest.approx(1.0, rel=1e-14)
    # |error| = c k^n stays outside 2 % until n = 8, and outside 5 % until n = 6
    assert y.settling_time(0.02) == pytest.approx(8.0, rel=1e-14)
    assert y.settling_time(0.05) == pytest.approx(6.0, rel=1e-14)
    assert y.iae() == pytest.approx(c / (1 - k), rel=PROMISE)
    assert y.ie() == pytest.approx(c / (1 + k), rel=PROMISE)
    assert y.ise() == pytest.approx(c**2 / (1 - k**2), rel=PROMISE)
    assert y.itae() == pytest.approx(c * (k / (1 - k) ** 2 + 0.5 / (1 - k)), rel=PROMISE)


def test_jumps_are_crossings() -> None:
    # e^{-s} under 0.5 + 0.1/s: from 0 to 0.5 at t = 1, down by 0.25 at t = 2
    y = Loop(Plant([1.0], [1.0], dead_time=1.0), PI(k=0.5, ki=0.1)).step(until=3.0)
    assert y.crossings(0.3) == pytest.approx([1.0], rel=1e-14)
    assert y.crossings(0.55) == pytest.approx([1.5, 2.0], rel=1e-13)
    assert y.last_crossing(0.3) == pytest.approx(1.0, rel=1e-14)
    assert y.peak().value == pytest.approx(0.6, rel=1e-13)  # the limit from the left at t = 2
    assert y.peak().time == pytest.approx(2.0, rel=1e-13)


# --------------------------------------------------------------------------------------------------------------
# integral criteria by formulas for the whole time axis


@pytest.mark.parametrize("name", INTEGRAL)
def test_integrated_error_of_a_load_step(name: str) -> None:
    assert PROBLEMS[name].loop.load_step().ie() == pytest.approx(1 / PROBLEMS[name].reference.ki, rel=PROMISE)


@pytest.mark.parametrize(
    "name", ["foptd-0.2", "foptd-1", "foptd-5", "foptd-50", "lag-8", "lag-8-dead-time", "no-dead-time", "neutral"]
)
def test_integrated_error_of_a_set_point_step(name: str) -> None:
    # u ends at 1/K with K = 1, and is k (b - 1) + ki IE
    r = PROBLEMS[name].reference
    assert PROBLEMS[name].loop.step().ie() == pytest.approx((1 + r.k * (1 - r.b)) / r.ki, rel=PROMISE)


def test_absolute_error_of_a_monotone_load_response() -> None:
    # the load response of this slow loop does not change its sign: IAE = IE
    loop = Loop(Plant.foptd(gain=1.0, time_constant=1.0, dead_time=1.0), PI(k=0.3, ki=0.1))
    load = loop.load_step()
    assert load.iae() == pytest.approx(10.0, rel=PROMISE)
    assert load.trough().value >= -1e-12


@pytest.mark.parametrize("name", ["foptd-0.05", "foptd-1", "foptd-5", "foptd-50"])
def test_squared_error_of_a_load_step(name: str) -> None:
    r = PROBLEMS[name].reference
    expected = float(foptd_load_ise(1.0, 1.0, r.dead_time, r.k, r.ki))
    assert PROBLEMS[name].loop.load_step().ise() == pytest.approx(expected, rel=PROMISE)


@given(st.floats(0.1, 1.4), st.floats(0.1, 10.0))
def test_squared_error_of_integrating_plants(product: float, dead_time: float) -> None:
    k = product / dead_time
    y = Loop(Plant([1.0], [1.0, 0.0], dead_time=dead_time), PI(k=k)).step()
    assert y.ise() == pytest.approx(float(integrator_p_ise(1.0, dead_time, k)), rel=PROMISE)


@given(st.floats(0.05, 5.0), st.floats(0.1, 0.8), st.floats(0.1, 0.8), st.floats(0.1, 10.0))
def test_random_loops_have_the_integrated_error_of_the_integral_gain(
    dead_time: float, k_share: float, ki_share: float, gain: float
) -> None:
    k = k_share * (1 + 1 / dead_time) / gain
    ki = ki_share * (k + 1 / gain) / (1 + dead_time)
    loop = Loop(Plant.foptd(gain=gain, time_constant=1.0, dead_time=dead_time), PI(k=k, ki=ki))
    assume(loop.is_stable() and loop.rightmost_pole().real < -0.02)
    assert loop.load_step().ie() == pytest.approx(1 / ki, rel=PROMISE)
    assert loop.step().ie() == pytest.approx(1 / (gain * ki), rel=PROMISE)


# --------------------------------------------------------------------------------------------------------------
# metrics on the references: every answer is polished in mpmath, and a coarse scan shows that it is the right one


Scan = tuple[ReferenceLoop, Signal, Array, Array]

SCANNED = {"foptd-0.2": 5.0, "foptd-1": 15.0, "integrating": 30.0, "no-dead-time": 15.0}


@pytest.fixture(scope="module", params=SCANNED)
def scanned(request: pytest.FixtureRequest) -> Scan:
    """The reference, the response under test, and a coarse scan of the reference."""
    name = request.param
    reference, until = PROBLEMS[name].reference, SCANNED[name]
    times = np.linspace(0.0, until, 46)[1:] - 0.31 * until / 45
    values = np.array([float(reference(t)) for t in times])
    return reference, PROBLEMS[name].loop.step(until=until), times, values


def polished(reference: ReferenceLoop, level: float, near: float) -> float:
    return float(crossing(lambda t: reference(t) - level, near - 1e-5, near + 1e-5))


def test_scanned_peak(scanned: Scan) -> None:
    reference, y, times, values = scanned
    peak = y.peak()
    assert peak.value >= values.max() - 1e-12
    if peak.time == y.horizon:  # no overshoot
        assert peak.value == pytest.approx(float(reference(y.horizon)), rel=1e-12)
        assert (np.diff(values) > -1e-12).all()
        assert y.overshoot() == 0.0
        return
    with mp.workdps(30):
        start = (mp.mpf(peak.time), mp.mpf(peak.time) + mp.mpf(10) ** -4)
        at = mp.findroot(lambda t: reference(t, integrals=-1), start, tol=1e-32)
        assert peak.value == pytest.approx(float(reference(at)), rel=1e-11)
        assert peak.time == pytest.approx(float(at), rel=1e-6)
    assert y.overshoot() == pytest.approx(peak.value - 1, rel=1e-14)
    assert abs(times[values.argmax()] - peak.time) < 2.5 * (times[1] - times[0])


def test_scanned_rise_and_delay(scanned: Scan) -> None:
    reference, y, times, values = scanned
    reached = {}
    for level in (0.1, 0.5, 0.9):
        reached[level] = polished(reference, level, y.delay_time(level))
        assert y.delay_time(level) == pytest.approx(reached[level], rel=PROMISE)
        assert (values[times < reached[level]] < level).all()
    assert y.rise_time(0.1, 0.9) == pytest.approx(reached[0.9] - reached[0.1], rel=PROMISE)


@pytest.mark.parametrize("band", [0.02, 0.05])
def test_scanned_settling(scanned: Scan, band: float) -> None:
    reference, y, times, values = scanned
    settled = y.settling_time(band)
    level = 1 + band if reference(settled) > 1 else 1 - band
    assert settled == pytest.approx(polished(reference, level, settled), rel=PROMISE)
    assert (np.abs(values[times > settled] - 1) < band).all()


def test_scanned_absolute_error(scanned: Scan) -> None:
    reference, y, times, values = scanned
    ends = [0.0]
    for left, right, a, b in zip(times[:-1], times[1:], values[:-1], values[1:], strict=True):
        if (a - 1) * (b - 1) < 0:
            ends.append(crossing(lambda t: reference(t) - 1, left, right))
    ends.append(y.horizon)
    with mp.workdps(30):
        areas = [mp.mpf(t) - reference(t, integrals=1) if t else mp.mpf(0) for t in ends]
        iae = mp.fsum(abs(b - a) for a, b in pairwise(areas))
        assert y.iae() == pytest.approx(float(iae), rel=PROMISE)
        assert y.ie() == pytest.approx(float(areas[-1]), rel=PROMISE)


# --------------------------------------------------------------------------------------------------------------
# signals as such

#: Of each piece: amplitude, frequency and phase of its sinusoids.
Sines = list[list[tuple[float, float, float]]]
Wave = tuple[Sines, Array]


@st.composite
def waves(draw: st.DrawFn) -> Wave:
    """Piecewise sums of two sinusoids, with jumps between the pieces, as fast as pieces of degree 18 resolve."""
    pieces = draw(st.integers(1, 5))
    number = st.floats(-1.0, 1.0)
    functions = [
        [(draw(number), draw(st.floats(0.0, 3.0)), draw(st.floats(0.0, 6.28))) for _ in range(2)] for _ in range(pieces)
    ]
    lengths = [draw(st.floats(0.1, 3.0)) for _ in range(pieces)]
    return functions, np.concatenate([[0.0], np.cumsum(lengths)])


def wave_signal(functions: Sines) -> tuple[Callable[[int, Array], Array], Array]:
    def value(piece: int, x: Array) -> Array:
        return np.asarray(np.sum([a * np.sin(w * x + phase) for a, w, phase in functions[piece]], axis=0))

    points = np.polynomial.chebyshev.chebpts1(19)
    fit = np.polynomial.chebyshev.chebfit
    coefficients = np.array([fit(points, value(piece, points), 18) for piece in range(len(functions))])
    return value, coefficients


@settings(max_examples=60)
@given(waves(), st.floats(-1.5, 1.5))
def test_extrema_and_crossings_of_waves(wave: Wave, level: float) -> None:
    functions, breaks = wave
    value, coefficients = wave_signal(functions)
    y = Signal(breaks, coefficients, final=0.0)
    x = np.linspace(-1, 1, 4001)
    dense = np.array([value(p, x) for p in range(len(functions))])
    assert np.ptp(dense) == 0 or dense.max() - 1e-12 <= y.peak().value <= dense.max() + 3e-6
    assert np.ptp(dense) == 0 or dense.min() - 3e-6 <= y.trough().value <= dense.min() + 1e-12
    # no doubt about the number of crossings: no touching, nothing at the ends of pieces
    near = np.abs(dense - level)
    extremal = (np.diff(dense, axis=1)[:, 1:] * np.diff(dense, axis=1)[:, :-1]) <= 0
    assume(near[:, [0, -1]].min() > 1e-6)
    assume(not (extremal & (near[:, 1:-1] < 1e-4)).any())
    chain = np.sign(dense - level).ravel()
    chain = chain[chain != 0]
    assert y.crossings(level).size == np.count_nonzero(chain[1:] != chain[:-1])
    assert y.last_crossing(level) == max(y.crossings(level), default=0.0)


def test_a_signal_at_rest_has_no_integrals() -> None:
    y = Signal(np.array([0.0, 1.0, 3.0]), np.array([[1.0, 0.0], [1.0, 0.0]]), final=1.0)
    assert (y.iae(), y.itae(), y.ise(), y.ie()) == (0.0, 0.0, 0.0, 0.0)


@settings(max_examples=60)
@given(waves())
def test_integrals_of_waves(wave: Wave) -> None:
    functions, breaks = wave
    value, coefficients = wave_signal(functions)
    y = Signal(breaks, coefficients, final=0.25)
    # composite Gauss rule on many subintervals: a kink of |.| in one of 400 costs (1/400)^2
    nodes, weights = np.polynomial.legendre.leggauss(6)
    panel = np.linspace(-1, 1, 401)
    x = (0.5 * (panel[:-1, None] + panel[1:, None]) + nodes / 400).ravel()
    w = np.tile(weights / 400, 400)
    error = [0.25 - value(p, x) for p in range(len(functions))]
    half = np.diff(breaks) / 2
    assert y.iae() == pytest.approx(sum(h * w @ np.abs(e) for h, e in zip(half, error, strict=True)), rel=1e-4)
    assert y.ise() == pytest.approx(sum(h * w @ e**2 for h, e in zip(half, error, strict=True)), rel=1e-10)


# --------------------------------------------------------------------------------------------------------------
# what has no answer


def test_unstable_loop_has_no_metrics() -> None:
    y = PROBLEMS["unstable-loop"].loop.step(until=20.0)
    for ask in (y.overshoot, y.settling_time, y.rise_time, y.delay_time, y.iae, y.ise, y.ie, y.itae, y.itse):
        with pytest.raises(UnstableLoopError, match="unstable"):
            ask()


def test_short_horizon_is_not_a_settling_time() -> None:
    y = PROBLEMS["foptd-1"].loop.step(until=2.0)
    with pytest.raises(NotSettledError):
        y.settling_time()
    with pytest.raises(NotSettledError):
        y.rise_time()


def test_overshoot_needs_a_final_value() -> None:
    with pytest.raises(LoopError):
        PROBLEMS["foptd-1"].loop.load_step().overshoot()


@pytest.mark.parametrize("name", STABLE)
def test_final_value_is_approached(name: str) -> None:
    loop = PROBLEMS[name].loop
    response = loop.respond(setpoint=1.0, load=0.5)
    for signal in (response.output, response.control):
        assert signal.final == pytest.approx(float(signal(signal.horizon)), abs=1e-10)


@pytest.mark.parametrize("dead_time", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("a", [0.1, 0.3])
def test_integrals_do_not_collect_rounding_over_a_horizon_that_a_cancelled_mode_makes_long(
    dead_time: float, a: float
) -> None:
    # Ti = T leaves L = (a/L) e^(-sL)/s, monotone for a < 1/e: E(s) = 1/(s + (a/L) e^(-sL)), IAE = IE = E(0),
    # ITAE = -E'(0); the cancelled pole at -1 makes the horizon 34
    y = Loop(Plant.foptd(1.0, 1.0, dead_time), PI(a / dead_time, a / dead_time)).step()
    mean = dead_time / a
    assert y.horizon > 34.0
    assert y.iae() == pytest.approx(mean, rel=1e-12)
    assert y.ie() == pytest.approx(mean, rel=1e-12)
    assert y.itae() == pytest.approx((1.0 - a) * mean**2, rel=1e-11)

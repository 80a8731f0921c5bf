"""What is said to be certain of a box of gains, against single loops in the box simulated and searched without it."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy import signal

from replicate.loops import Plant
from replicate.loops.bounds.gain_boxes import GainBox, iae_bounds, no_peak_between, sensitivity_at_least
from replicate.loops.bounds.intervals import Interval, derivative, exactly, on_the_axis

LAGS = np.array([1.0, 4.0, 6.0, 4.0, 1.0])  # (s + 1)^4
PLANT = Plant([1.0], LAGS)

numbers = st.floats(-1e3, 1e3).filter(lambda x: x == 0.0 or abs(x) > 1e-6)
sides = st.tuples(numbers, numbers).map(lambda ends: Interval(min(ends), max(ends)))


@given(first=sides, second=sides, places=st.tuples(st.floats(0, 1), st.floats(0, 1)))
def test_results_lie_in_the_interval_of_results(first: Interval, second: Interval, places: tuple[float, float]) -> None:
    # exactly, in fractions
    a, b = (
        Fraction(side.low) + Fraction(place) * (Fraction(side.high) - Fraction(side.low))
        for side, place in zip((first, second), places, strict=True)
    )
    for found, exact in ((first + second, a + b), (first - second, a - b), (first * second, a * b)):
        assert Fraction(found.low) <= exact <= Fraction(found.high)
    assume(not second.holds(0.0))
    quotient = first / second
    assert Fraction(quotient.low) <= a / b <= Fraction(quotient.high)


ENDS = (-2.7, -0.3, 0.0, 0.1, 1.9)
SIDES = [Interval(low, high) for low, high in product(ENDS, ENDS) if low <= high]


@pytest.mark.parametrize("first", SIDES)
@pytest.mark.parametrize("second", SIDES)
def test_a_product_is_as_narrow_as_it_can_be(first: Interval, second: Interval) -> None:
    ends = [Fraction(a) * Fraction(b) for a, b in product((first.low, first.high), (second.low, second.high))]
    found = first * second
    for one, exact in ((found.low, min(ends)), (found.high, max(ends))):
        assert abs(Fraction(one) - exact) <= 2 * Fraction(np.spacing(abs(float(exact))))
    assert Fraction(found.low) <= min(ends) <= max(ends) <= Fraction(found.high)


def test_a_divisor_that_may_be_zero_leaves_all_open() -> None:
    found = exactly(1.0) / Interval(-1.0, 1.0)
    assert (found.low, found.high) == (-np.inf, np.inf)


UNLIMITED = [Interval(-np.inf, np.inf), Interval(-np.inf, 1.9), Interval(-0.3, np.inf), Interval(0.0, np.inf)]


@pytest.mark.parametrize("first", [*SIDES, *UNLIMITED])
@pytest.mark.parametrize("second", UNLIMITED)
def test_nothing_is_ruled_out_by_a_side_without_limits(first: Interval, second: Interval) -> None:
    for found in (first * second, second * first, first / Interval(0.1, np.inf)):
        assert found.low <= found.high
    for a, b in product((first.low, first.high), (second.low, second.high)):
        if np.isfinite([a, b]).all():
            assert (first * second).holds(a * b)
            assert (second * first).meets(a * b, a * b)


@given(coefficients=st.lists(sides, min_size=1, max_size=5), w=st.floats(0.1, 3.0), place=st.floats(0, 1))
def test_a_polynomial_and_its_derivative(coefficients: list[Interval], w: float, place: float) -> None:
    chosen = np.array([side.low + place * (side.high - side.low) for side in coefficients])
    around = Interval(w * (1.0 - 0.1 * place), w * (1.1 - 0.1 * place))
    for found, exact in (
        (on_the_axis(coefficients, around), np.polyval(chosen, 1j * w)),
        (on_the_axis(derivative(coefficients), around), np.polyval(np.polyder(chosen), 1j * w)),
    ):
        slack = 1e-9 * (1.0 + abs(exact))
        assert found.real.low - slack <= exact.real <= found.real.high + slack
        assert found.imag.low - slack <= exact.imag <= found.imag.high + slack


Triple = tuple[float, float, float]


def box(middle: Triple, half: Triple, lag: Interval | None = None, order: int = 0) -> GainBox:
    k, ki, kd = (Interval(m - h, m + h) for m, h in zip(middle, half, strict=True))
    return GainBox(k, ki, kd, lag or exactly(0.0), order)


def simulated_iae(k: float, ki: float, kd: float, lag: float, order: int) -> float:
    """Return the IAE of a unit load step from a state-space simulation, trapezoids on a fine grid."""
    filter_ = np.array([1.0])
    for _ in range(order):
        filter_ = np.polymul(filter_, [lag, 1.0])
    # y/l = P/(1 + P C F) = s F_den / (s (s + 1)^4 F_den + kd s^2 + k s + ki)
    num = np.polymul([1.0, 0.0], filter_)
    den = np.polyadd(np.polymul(np.polymul([1.0, 0.0], LAGS), filter_), [kd, k, ki])
    t = np.linspace(0.0, 120.0, 60001)
    _, y = signal.step((num, den), T=t)
    return float(np.trapezoid(np.abs(y), t))


@pytest.mark.parametrize("order", [0, 1, 2])
def test_every_loop_of_a_box_keeps_the_bounds_of_the_iae(order: int) -> None:
    lag = Interval(0.248, 0.252)
    middle, half = (0.9, 0.4, 0.95), (0.01, 0.004, 0.01)
    found = iae_bounds(PLANT, box(middle, half, lag if order else None, order))
    for signs in product((-1.0, 1.0), repeat=3):
        k, ki, kd = (m + sign * h for m, sign, h in zip(middle, signs, half, strict=True))
        for time in (lag.low, lag.high) if order else (0.0,):
            assert found.low <= simulated_iae(k, ki, kd, time, order) <= found.high
    assert found.high / found.low < 1.25  # and they say something


def test_narrower_boxes_have_narrower_bounds_around_the_value_itself() -> None:
    widths = []
    for size in (1e-2, 1e-3, 1e-4):
        found = iae_bounds(PLANT, box((0.9, 0.4, 0.95), (size, size, size)))
        assert found.holds(simulated_iae(0.9, 0.4, 0.95, 0.0, 0))
        widths.append(found.high - found.low)
    assert widths[0] / widths[1] == pytest.approx(10.0, rel=0.1)
    assert widths[1] / widths[2] == pytest.approx(10.0, rel=0.1)


def test_nothing_is_said_of_a_box_that_holds_an_unstable_loop() -> None:
    assert iae_bounds(PLANT, box((3.0, 1.0, 0.0), (3.0, 0.9, 0.0))).high == np.inf  # 1/(s+1)^4 is unstable for k > 4


def peak_frequencies(found: GainBox, lag: tuple[float, ...] = (0.0,)) -> list[float]:
    """Return where |S| is largest for the corners of a box, on a dense grid."""
    w = np.linspace(0.05, 3.0, 300001)
    s = 1j * w
    peaks = []
    for k, ki, kd in product(*((side.low, side.high) for side in (found.k, found.ki, found.kd))):
        for time in lag:
            loop = (k + ki / s + kd * s) / np.polyval(LAGS, s) / (time * s + 1.0)
            peaks.append(float(w[np.argmin(np.abs(1.0 + loop))]))
    return peaks


@pytest.mark.parametrize("lag", [None, Interval(0.2529, 0.2533)])
def test_where_no_peak_is_said_to_be_there_is_none_and_where_one_is_nothing_is_said(lag: Interval | None) -> None:
    found = box((0.9152, 0.39242, 0.95236), (5e-5, 1e-4, 1e-4), lag, 1 if lag else 0)
    peaks = peak_frequencies(found, (lag.low, lag.high) if lag else (0.0,))
    low, high = min(peaks), max(peaks)
    assert high - low < 2e-3
    assert no_peak_between(PLANT, found, high + 1.5e-3, high + 2e-3)
    assert no_peak_between(PLANT, found, low - 2e-3, low - 1.5e-3)
    assert not no_peak_between(PLANT, found, low - 1e-4, high + 1e-4)


def test_no_peak_of_a_box_is_lower_than_the_bound() -> None:
    found = box((1.0, 0.5, 1.0), (0.005, 0.005, 0.005))
    bound = sensitivity_at_least(PLANT, found, peak_frequencies(box((1.0, 0.5, 1.0), (0.0, 0.0, 0.0)))[0])
    w = np.linspace(0.2, 3.0, 4001)
    s = 1j * w
    rng = np.random.default_rng(11)
    peaks = []
    for k, ki, kd in rng.uniform((0.995, 0.495, 0.995), (1.005, 0.505, 1.005), (200, 3)):
        peaks.append(float(np.max(1.0 / np.abs(1.0 + (k + ki / s + kd * s) / np.polyval(LAGS, s)))))
    assert bound <= min(peaks) < 1.05 * bound


def test_a_plant_that_is_a_function_is_refused() -> None:
    with pytest.raises(ValueError, match="not rational"):
        no_peak_between(
            Plant.from_function(lambda s: np.exp(-np.sqrt(s))), box((0.5, 0.3, 0.0), (0.0, 0.0, 0.0)), 1.0, 1.1
        )

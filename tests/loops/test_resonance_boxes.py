"""What is certain of the peak of |T| over a box of gains, against single loops evaluated on dense grids."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.loops import Plant
from replicate.loops.bounds.gain_boxes import complementary_at_least, no_peak_between
from replicate.loops.bounds.intervals import Interval, cosine, exactly, exponential, sine
from replicate.loops.bounds.resonance_boxes import Excludes, ResonanceBox

PLANTS = {
    "lags": Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0]),
    "integrating": Plant([1.0], [1.0, 2.0, 1.0, 0.0]),
    "right zero": Plant([-2.0, 1.0], [1.0, 3.0, 3.0, 1.0]),
    "dead time": Plant([1.0], [1.0, 3.0, 3.0, 1.0], dead_time=2.0),
}
Setting = tuple[float, float, float]
SETTINGS: dict[str, Setting] = {
    "lags": (1.3, 2.0, 0.8),
    "integrating": (0.3, 6.0, 1.0),
    "right zero": (0.35, 1.5, 0.3),
    "dead time": (0.6, 2.2, 0.7),
}
W = np.geomspace(1e-3, 30.0, 60001)


def box(name: str, share: float) -> ResonanceBox:
    return ResonanceBox(PLANTS[name], *(Interval((1 - share) * one, (1 + share) * one) for one in SETTINGS[name]))


def settings(name: str, share: float) -> list[Setting]:
    signs = [*product((-1.0, 1.0), repeat=3), *np.random.default_rng(4).uniform(-1.0, 1.0, (4, 3))]
    k, ti, td = SETTINGS[name]
    return [(k * (1 + share * a), ti * (1 + share * b), td * (1 + share * c)) for a, b, c in signs]


def evaluated(name: str, setting: Setting, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Q and the square of |T| by complex arithmetic, from their definitions."""
    k, ti, td = setting
    s = 1j * w
    plant = PLANTS[name]
    p = np.polyval(plant.num, s) / np.polyval(plant.den, s) * np.exp(-s * plant.dead_time)
    loop = p * k * (1.0 + 1.0 / (ti * s) + td * s)
    return (np.abs(s * (1.0 + loop) * ti / (k * p)) ** 2 - 1.0) / w**2, np.abs(loop / (1.0 + loop)) ** 2


def other_than(low: float, high: float) -> Excludes:
    return lambda _, excess: not excess.meets(low, high)


@pytest.mark.parametrize("name", PLANTS)
def test_excess_and_size_hold_those_of_every_loop_and_frequency(name: str) -> None:
    found = box(name, 0.01)
    for low in np.geomspace(0.02, 8.0, 25):
        w = Interval(float(low), float(1.02 * low))
        excess, size = found.excess(w), found.size(w)
        inside = np.linspace(w.low, w.high, 7)
        for setting in settings(name, 0.01):
            q, square = evaluated(name, setting, inside)
            slack = 1e-7 / low**2  # the definition of Q cancels at low frequencies
            assert np.all((excess.low - slack <= q) & (q <= excess.high + slack))
            assert np.all((size.low * (1 - 1e-9) <= square) & (square <= size.high * (1 + 1e-9)))


@pytest.mark.parametrize("name", PLANTS)
def test_the_excess_has_a_limit_at_rest(name: str) -> None:
    at_rest, near = box(name, 0.0).excess(exactly(0.0)), evaluated(name, SETTINGS[name], np.array([1e-3]))[0][0]
    assert at_rest.low == pytest.approx(near, rel=1e-3, abs=1e-3)
    assert at_rest.high == pytest.approx(near, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("name", PLANTS)
def test_the_excess_at_the_peak_of_any_loop_is_never_excluded_and_others_are(name: str) -> None:
    share = 0.002
    found = box(name, share)
    at_peaks = []
    for setting in settings(name, share):
        q, square = evaluated(name, setting, W)
        at_peaks.append(float(q[np.argmax(square)]))
        wanted = Interval(at_peaks[-1] - 1e-4, at_peaks[-1] + 1e-4)
        assert not found.no_resonance_where(other_than(wanted.low, wanted.high))
    for wrong in (min(at_peaks) - 0.3 * abs(min(at_peaks)), max(at_peaks) + 0.3 * abs(max(at_peaks))):
        assert found.no_resonance_where(other_than(wrong, wrong))


@pytest.mark.parametrize("name", PLANTS)
def test_the_largest_of_a_grid_is_never_excluded(name: str) -> None:
    share = 0.002
    found, grid = box(name, share), np.logspace(-2.0, 2.0, 50)
    at_largest = []
    for setting in settings(name, share):
        q, square = evaluated(name, setting, grid)
        at_largest.append(float(q[np.argmax(square)]))
        wanted = at_largest[-1]
        assert not found.none_largest_where(other_than(wanted, wanted), grid)
    wrong = min(at_largest) - 0.5 * abs(min(at_largest))
    assert found.none_largest_where(other_than(wrong, wrong), grid)


@pytest.mark.parametrize("name", PLANTS)
def test_where_no_peak_of_the_complementary_sensitivity_is_said_to_be_there_is_none(name: str) -> None:
    share = 0.001
    gains = box(name, share).gains
    peaks = [float(W[np.argmax(evaluated(name, setting, W)[1])]) for setting in settings(name, share)]
    low, high = min(peaks), max(peaks)
    assert not no_peak_between(PLANTS[name], gains, low, high, complementary=True)
    assert no_peak_between(PLANTS[name], gains, 1.1 * high, 1.15 * high, complementary=True)
    assert no_peak_between(PLANTS[name], gains, 0.9 * low, 0.93 * low, complementary=True)


@pytest.mark.parametrize("name", PLANTS)
def test_no_peak_of_a_box_is_lower_than_the_bound(name: str) -> None:
    share = 0.005
    gains = box(name, share).gains
    found = [evaluated(name, setting, W)[1] for setting in settings(name, share)]
    peaks = [float(np.sqrt(square.max())) for square in found]
    bound = complementary_at_least(PLANTS[name], gains, float(W[np.argmax(found[0])]))
    assert bound <= min(peaks) < 1.15 * bound


def test_at_rest_the_complementary_sensitivity_is_one_under_integral_action() -> None:
    assert complementary_at_least(PLANTS["lags"], box("lags", 0.01).gains, 0.0) == 1.0


@given(low=st.floats(-20.0, 20.0), width=st.floats(0.0, 3.0), place=st.floats(0.0, 1.0))
def test_functions_of_intervals_hold_those_of_every_number(low: float, width: float, place: float) -> None:
    side = Interval(low, low + width)
    number = min(low + place * width, side.high)
    for found, exact in (
        (cosine(side), np.cos(number)),
        (sine(side), np.sin(number)),
        (exponential(side), np.exp(number)),
        (side.square(), number * number),
    ):
        assert found.low <= exact <= found.high


def test_other_plants_are_refused() -> None:
    with pytest.raises(ValueError, match="zero at s = 0"):
        ResonanceBox(Plant([1.0, 0.0], [1.0, 2.0, 1.0]), exactly(1.0), exactly(1.0))

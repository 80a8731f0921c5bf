"""Functions with narrow resonances: they are seen, and their loops are those of the rational plants that they are."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

from loops.references import polished_root
from replicate.loops import PI, PID, Loop, Plant, design_pi
from replicate.loops.plants.function_resonances import resonances


def ratio(num: Any, den: Any) -> Any:
    return lambda s: np.polyval(num, s) / np.polyval(den, s)


def pair(frequency: float, damping: float) -> list[float]:
    return [1.0, 2.0 * damping * frequency, frequency**2]


def resonant_pole(frequency: float, damping: float) -> complex:
    return complex(-damping * frequency, frequency * np.sqrt(1.0 - damping**2))


@pytest.mark.parametrize("damping", [0.0, 1e-9, 1e-6, 1e-3, 0.05])
@pytest.mark.parametrize("frequency", [1e-9, 1.0, 37.0, 1e8])
def test_a_resonance_is_found_however_narrow(frequency: float, damping: float) -> None:
    found = resonances(ratio([1.0], pair(frequency, damping)), 1e-2 * frequency, 1e3 * frequency)
    assert found == pytest.approx([resonant_pole(frequency, damping)], rel=1e-12)


def test_resonances_that_are_weak_close_together_or_of_a_fractional_function() -> None:
    weak = resonances(ratio([1.0, 2e-4, 1.0002], pair(1.0, 1e-4)), 0.01, 100.0)
    assert weak == pytest.approx([resonant_pole(1.0, 1e-4)], rel=1e-9)
    three = np.polymul(np.polymul(pair(1.0, 1e-3), pair(1.01, 1e-3)), pair(1.3, 1e-5))
    close = resonances(ratio([1.0], three), 0.01, 100.0)
    expected = [resonant_pole(1.0, 1e-3), resonant_pole(1.01, 1e-3), resonant_pole(1.3, 1e-5)]
    assert close == pytest.approx(expected, rel=1e-9)
    # 1 + s^1.98 = 0 at exp(i pi/1.98)
    fractional = resonances(lambda s: 1.0 / (1.0 + s**1.98), 0.01, 100.0)
    assert fractional == pytest.approx([np.exp(1j * np.pi / 1.98)], rel=1e-12)


@pytest.mark.parametrize(
    "function",
    [
        lambda s: np.exp(-np.sqrt(s)),
        lambda s: np.exp(-3.0 * s) / (s + 1.0),
        lambda s: 1.0 / (1.0 + 0.9 * np.exp(-s)),
        lambda s: (1.0 + 1e-4 * np.random.default_rng(0).normal(size=np.shape(s))) / (s + 1.0),
        lambda s: 0.0 * s,
    ],
)
def test_what_is_no_resonance_is_none(function: Any) -> None:
    assert resonances(function, 1e-3, 1e3).size == 0


RESONANT: dict[str, tuple[Any, Any, float, PID]] = {
    "narrow, unstable": ([1.0], pair(1.0, 1e-3), 1.0, PI(0.01, 0.001)),
    "narrower, stable": ([1.0], pair(1.0, 1e-5), 0.5, PI(0.0, 1e-5)),
    "two": ([2.0, 4e-4, 2.21], np.polymul(pair(1.0, 1e-4), pair(1.1, 1e-4 / 1.1)), 0.1, PI(0.0, 0.001)),
    "three, one unstable": (
        [1.0, 0.0, 0.5],
        np.polymul(np.polymul([1.0, 0.002, 1.0], [1.0, 0.003, 2.0]), [1.0, 0.001, 4.0]), 0.7, PI(0.02, 0.003),
    ),
    "far above the crossover": ([1.0], np.polymul([1.0, 1.0], pair(50.0, 0.01)), 0.2, PI(500.0, 300.0)),
    "undamped": ([1.0], [1.0, 0.0, 1.0], 0.3, PID(0.3, 0.05, 0.5, measurement_filter=0.1)),
    "undamped, unstable": ([1.0], [1.0, 0.0, 1.0], 0.3, PI(0.2)),
    "without dead time": ([1.0], np.polymul(pair(1.0, 1e-3), [1.0, 1.0]), 0.0, PI(0.0, 5e-4)),
    "slow": ([1.0], [1.0, 1.0], 1.0, PI(0.5, 1e-6)),
    "fast filter": ([1.0], [1.0, 1.0], 1.0, PI(0.5, 0.3, measurement_filter=1e-4)),
    "a peak between octaves": (
        [0.0056, 0.0875, 1.0], [0.000122, 0.00236, 0.1114, 1.0], 0.3, PI(0.155, 1.194),
    ),
}  # fmt: skip


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e6])
@pytest.mark.parametrize("name", RESONANT)
def test_a_loop_around_a_function_is_that_around_the_rational_plant_it_is(name: str, unit: float) -> None:
    num, den, dead_time, c = RESONANT[name]
    num, den = (np.asarray(part) * unit ** np.arange(len(part) - 1, -1, -1.0) for part in (num, den))
    c = PID(c.k, c.ki / unit, c.kd * unit, measurement_filter=c.measurement_filter * unit)  # type: ignore[operator]
    loop = Loop(Plant.from_function(ratio(num, den), dead_time * unit), c)
    rational = Loop(Plant(num, den, dead_time * unit), c)
    assert loop.is_stable() == rational.is_stable()
    assert loop.unstable_poles() == rational.unstable_poles()
    assert loop.rightmost_pole() == pytest.approx(rational.rightmost_pole(), rel=1e-9)
    with mp.workdps(40):
        top, bottom = [mp.mpf(x) for x in num.tolist()], [mp.mpf(x) for x in den.tolist()]

        def characteristic(scaled: mp.mpc) -> mp.mpc:
            s = scaled / unit
            controller = c.k + c.ki / s + c.kd * s
            filtered = controller / (1 + s * mp.mpf(c.measurement_filter))
            return mp.polyval(bottom, s) + filtered * mp.polyval(top, s) * mp.exp(-s * mp.mpf(dead_time * unit))

        exact = complex(polished_root(characteristic, loop.rightmost_pole() * unit)) / unit
    assert abs(loop.rightmost_pole() - exact) < 1e-11 * abs(exact)
    if loop.is_stable():
        assert loop.sensitivity_peak() == pytest.approx(rational.sensitivity_peak(), rel=1e-10)
        assert loop.complementary_peak() == pytest.approx(rational.complementary_peak(), rel=1e-10)
        ours, theirs = loop.margins(), rational.margins()
        assert (ours.gain, ours.phase, ours.delay) == pytest.approx((theirs.gain, theirs.phase, theirs.delay), rel=1e-9)


def test_as_many_poles_of_a_function_as_asked_for() -> None:
    loop = Loop(Plant.from_function(lambda s: 1.0 / (s + 1.0), 1.0), PI(1.5))
    np.testing.assert_allclose(loop.poles(12), Loop(Plant.foptd(1.0, 1.0, 1.0), PI(1.5)).poles(12), rtol=1e-10)


def test_a_design_for_a_resonant_function_is_that_for_the_rational_plant() -> None:
    num, den = [1.0], np.polymul(pair(1.0, 0.01), [1.0, 1.0])
    ours = design_pi(Plant.from_function(ratio(num, den), 0.5), ms=1.4)
    theirs = design_pi(Plant(num, den, 0.5), ms=1.4)
    assert (ours.k, ours.ki) == pytest.approx((theirs.k, theirs.ki), rel=1e-8)

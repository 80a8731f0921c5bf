"""Functions of s on intervals of the imaginary axis, against values at points of them by numpy."""

from __future__ import annotations

import numpy as np
import pytest

from replicate.loops.bounds.axis_jets import AxisJet
from replicate.loops.bounds.intervals import ComplexInterval, Interval, exactly


def holds(found: ComplexInterval, value: complex) -> bool:
    return found.real.holds(value.real) and found.imag.holds(value.imag)


def value_and_slope(coefficients: np.ndarray, delay: float, s: complex) -> tuple[complex, complex]:
    turn, value = np.exp(-s * delay), np.polyval(coefficients, s)
    return value * turn, (np.polyval(np.polyder(coefficients), s) - delay * value) * turn


@pytest.mark.parametrize("delay", [0.0, 0.7, 4.0])
def test_values_and_slopes_at_all_points_are_held_and_hardly_more(delay: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        coefficients = rng.normal(size=rng.integers(1, 6))
        low = rng.uniform(0.0, 3.0)
        w = Interval(low, low + rng.choice([0.0, 1e-6, 0.2]))
        jet = AxisJet.polynomial([exactly(float(c)) for c in coefficients], w).delayed(delay, w)
        for point in rng.uniform(w.low, w.high, 5):
            value, slope = value_and_slope(coefficients, delay, 1j * point)
            assert holds(jet.value, value)
            assert holds(jet.slope, slope)
        if w.high - w.low < 1e-3:
            size = 1e3 * (np.abs(coefficients).sum() * (1.0 + w.high) ** 5) * (w.high - w.low + 1e-14)
            assert max(jet.value.real.reach, jet.value.imag.reach) < size


def test_the_wronskian_is_the_slope_of_the_quotient() -> None:
    w = Interval(1.3, 1.3)
    n = AxisJet.polynomial([exactly(2.0), exactly(1.0)], w).delayed(0.5, w)
    d = AxisJet.polynomial([exactly(1.0), exactly(3.0), exactly(1.0)], w)
    s, step = 1.3j, 1e-6

    def quotient(s: complex) -> complex:
        return complex((2.0 * s + 1.0) * np.exp(-0.5 * s) / (s * s + 3.0 * s + 1.0))

    slope = (quotient(s + step) - quotient(s - step)) / (2.0 * step)
    found = n.wronskian(d)
    wanted = slope * (s * s + 3.0 * s + 1.0) ** 2
    assert (found.real.middle, found.imag.middle) == pytest.approx((wanted.real, wanted.imag), rel=1e-7)

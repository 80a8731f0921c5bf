"""Roots and extrema of one series, against those of Chebyshev polynomials and of quadratics, known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import chebyshev as cheb

from replicate.loops import Signal
from replicate.loops.numerics import one_series


@pytest.mark.parametrize("degree", [1, 2, 5, 18])
def test_chebyshev_polynomials(degree: int) -> None:
    series = [0.0] * degree + [1.0]
    extrema = np.cos(np.pi * np.arange(degree, -1, -1) / degree)
    roots = np.cos(np.pi * (np.arange(degree, 0, -1) - 0.5) / degree)
    for left, root, right in zip(extrema[:-1], roots, extrema[1:], strict=True):
        assert abs(one_series.root(series, left, right) - root) < 1e-15
    for left, extreme, right in zip(roots[:-1], extrema[1:-1], roots[1:], strict=True):
        sign = np.sign(one_series.value(series, extreme))
        assert abs(one_series.maximum([sign * c for c in series], left, right) - extreme) < 1e-14
    x = np.linspace(-1.0, 1.0, 37)
    values = [one_series.value(series, at) for at in x.tolist()]
    assert np.max(np.abs(values - np.cos(degree * np.arccos(x)))) < 1e-13
    slopes = [one_series.value(one_series.slope(series), at) for at in x[1:-1].tolist()]
    angle = np.arccos(x[1:-1])
    assert np.max(np.abs(slopes - degree * np.sin(degree * angle) / np.sin(angle))) < 1e-11


def test_root_where_the_secant_and_newton_fail() -> None:
    # flat on one side: a ninth power, whose slope vanishes at its root
    series = cheb.poly2cheb([0.0] * 9 + [1.0]).tolist()
    assert abs(one_series.root(series, -0.9, 1.0)) < 0.02  # where the ninth power is below rounding
    assert one_series.root([0.0], -1.0, 1.0) == 0.0


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-7])
def test_crossings_that_hide_between_samples(gap: float) -> None:
    # the parabola reaches below the level between two samples only
    middle = 0.013
    series = np.asarray(cheb.poly2cheb([middle**2 - gap**2, -2.0 * middle, 1.0]), dtype=float)
    y = Signal(np.array([0.0, 2.0]), series[None])
    assert np.max(np.abs(y.crossings(0.0) - [1.0 + middle - gap, 1.0 + middle + gap])) < 1e-8
    assert y.crossings(-2.0 * gap**2).size == 0
    level = 0.25
    assert np.max(np.abs(y.crossings(level) - (1.0 + middle + np.array([-1.0, 1.0]) * np.sqrt(level + gap**2)))) < 1e-14

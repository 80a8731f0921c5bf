"""Loops whose L does not vanish at infinite frequency, with several dead times: closed forms, and dense scans."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from replicate.loops import PI, Loop, Plant, gamma_norm

Term = tuple[list[float], list[float], float]
ComplexArray = NDArray[np.complex128]


def open_loop(terms: list[Term], k: float, ki: float, w: NDArray[np.float64]) -> ComplexArray:
    s = 1j * w
    plant = sum(np.polyval(num, s) / np.polyval(den, s) * np.exp(-s * delay) for num, den, delay in terms)
    return np.asarray((k + ki / s) * plant)


# For delays 1 and 2, z = e^-iw and c = cos w: |1 + 0.3 z + 0.3 z^2|^2 = 0.58 + 0.78 c + 1.2 c^2 has its minimum at
# c = -0.325, and 0.3 (z + z^2) is real at c = -1/2, where it is -0.3.
@pytest.mark.parametrize(
    ("terms", "ms", "mp", "gain_margin"),
    [
        ([([0.3], [1.0], 1.0), ([0.3], [1.0], 2.0)], 1.0 / sqrt(0.58 - 0.78**2 / 4.8), None, 10.0 / 3.0),
        ([([0.3], [1.0], 1.0), ([0.3], [1.0], sqrt(2.0))], 1.0 / 0.4, 0.6 / 0.4, 1.0 / 0.6),  # independent turns
        ([([0.5], [1.0], 0.0), ([0.3], [1.0], 1.0)], 1.0 / 1.2, 0.8 / 1.8, inf),
        ([([0.2], [1.0], 0.0), ([-0.3], [1.0], 1.0)], 1.0 / 0.9, 0.5 / 1.5, 1.0 / 0.1),
        ([([-0.3], [1.0], 0.0), ([0.2], [1.0], 1.0)], 1.0 / 0.5, 0.5 / 0.5, 1.0 / 0.5),
    ],
    ids=["commensurate", "incommensurate", "with a direct part", "direct and negative", "negative direct part"],
)
def test_static_terms(terms: list[Term], ms: float, mp: float | None, gain_margin: float) -> None:
    loop = Loop(Plant.from_terms(terms), PI(1.0))
    assert loop.sensitivity_peak() == pytest.approx(ms, rel=1e-10)
    assert loop.margins().gain == pytest.approx(gain_margin, rel=1e-10)
    if mp is not None:
        assert loop.complementary_peak() == pytest.approx(mp, rel=1e-10)


def test_a_peak_above_the_limit_is_found_far_out() -> None:
    # |S| tends to a limit of 1.19275 from both sides
    terms = [([-7.0, -2.0], [6.0, 5.0, 1.0], 0.0), ([0.5, -1.0], [1.0, 2.0, 1.0], 0.25), ([-2.1], [1.0], 0.3)]
    terms += [([2.0, 1.0], [1.0, 2.0, 1.0], 0.7)]
    k, ki = -0.077, -0.064
    peak = Loop(Plant.from_terms(terms), PI(k, ki)).sensitivity_peak()
    everywhere = np.abs(1.0 / (1.0 + open_loop(terms, k, ki, np.linspace(0.01, 400.0, 100_001))))
    near = np.linspace(peak.frequency - 1e-3, peak.frequency + 1e-3, 2001)
    assert peak >= everywhere.max()
    assert peak == pytest.approx(np.abs(1.0 / (1.0 + open_loop(terms, k, ki, near))).max(), rel=1e-10)


def test_the_gain_margin_counts_crossovers_far_out() -> None:
    terms = [([0.2, 0.1, 0.4], [1.0, 0.3, 1.0], 0.0), ([0.5, 0.4], [1.0, 1.0], 0.731)]
    k, ki = 0.8, 0.1
    w = np.linspace(0.5, 60.0, 300_001)
    L = open_loop(terms, k, ki, w)
    at = np.nonzero((L.imag[1:] * L.imag[:-1] < 0.0) & (L.real[1:] < 0.0))[0]
    share = L.imag[at] / (L.imag[at] - L.imag[at + 1])
    crossings = L.real[at] + share * (L.real[at + 1] - L.real[at])
    margins = Loop(Plant.from_terms(terms), PI(k, ki)).margins()
    assert margins.gain == pytest.approx(-1.0 / crossings.min(), rel=1e-7)


def test_more_dead_time_that_makes_a_neutral_loop_of_an_algebraic_one_is_no_margin() -> None:
    # 1 + 0.6 z + 0.6 z^2 has its roots at |z| = sqrt(5/3); |0.6 z + 0.6 z^2| reaches 1.2
    loop = Loop(Plant.from_terms([([0.6], [1.0], 1.0), ([0.6], [1.0], 2.0)]), PI(1.0))
    assert loop.is_stable()
    assert loop.margins().delay == 0.0


def test_the_norm_of_a_neutral_loop_is_found_between_two_turns() -> None:
    k, ki, w = 0.8, 0.3, np.linspace(0.01, 20.0, 200_001)
    terms: list[Term] = [([0.3, 1.0], [1.0, 1.0], 0.5)]
    controller, L = np.abs(k + ki / (1j * w)), open_loop(terms, k, ki, w)
    sizes = np.hypot(1.0, controller) * np.hypot(1.0, np.abs(L) / controller) / np.abs(1.0 + L)
    assert gamma_norm(Plant(*terms[0]), PI(k, ki)) == pytest.approx(sizes.max(), rel=1e-7)


def test_integral_action_on_terms_that_cancel_at_rest_is_unstable() -> None:
    # G(0) = 0: the error does not vanish, and the controller's integral part grows for ever
    plant = Plant.from_terms([([1.0], [1.0, 0.2, 1.0], 0.6), ([-1.0], [1.0, 0.2, 1.0], 0.8)])
    loop = Loop(plant, PI(0.13, 0.011))
    assert not loop.is_stable()
    assert loop.rightmost_pole() == 0.0
    assert not loop.summary().stable

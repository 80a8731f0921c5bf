"""Loops whose L does not vanish at infinite frequency, with several dead times: closed forms, and dense scans."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from replicate.loops import PI, Loop, LoopError, Plant, Weight, gamma_norm, sweep

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


# The terms turn as far as their dead times let them: L is scanned over the angles themselves, without any frequency.
PARTLY = [([0.2], [1.0], 1.0), ([0.2], [1.0], 2.0), ([0.1], [1.0], sqrt(2.0))]
ANGLES = np.linspace(0.0, 2.0 * np.pi, 1001)
ON_TORUS = {
    "one turn": ([([0.3], [1.0], 1.0), ([0.3], [1.0], 2.0)], 0.3 * np.exp(1j * ANGLES) + 0.3 * np.exp(2j * ANGLES)),
    "off the real axis": ([([0.5], [1.0], 0.0), ([0.3], [1.0], 1.0)], 0.5 + 0.3 * np.exp(1j * ANGLES)),
    "independent": (
        [([0.5], [1.0], 0.0), ([0.3], [1.0], 1.0), ([0.15], [1.0], sqrt(2.0))],
        0.5 + 0.3 * np.exp(1j * ANGLES)[:, None] + 0.15 * np.exp(1j * ANGLES),
    ),
    "two of three": (
        PARTLY,
        (0.2 * np.exp(1j * ANGLES) + 0.2 * np.exp(2j * ANGLES))[:, None] + 0.1 * np.exp(1j * ANGLES),
    ),
}


@pytest.mark.parametrize("name", ON_TORUS)
def test_the_balanced_norm_of_static_terms(name: str) -> None:
    terms, L = ON_TORUS[name]
    plant = Plant.from_terms(terms)
    found = gamma_norm(plant, PI(1.0), Weight.balancing(plant, PI(1.0)))
    assert found == pytest.approx(((1.0 + np.abs(L)) / np.abs(1.0 + L)).max(), rel=3e-5)
    assert found >= ((1.0 + np.abs(L)) / np.abs(1.0 + L)).max() - 1e-12
    fixed = gamma_norm(plant, PI(1.0), Weight.constant(2.0))
    sizes = np.hypot(1.0, 0.5) * np.hypot(1.0, 2.0 * np.abs(L)) / np.abs(1.0 + L)
    assert fixed == pytest.approx(sizes.max(), rel=3e-5)


def test_the_peak_where_two_of_three_dead_times_have_a_common_measure() -> None:
    # |1 + 0.2 z + 0.2 z^2|^2 = 0.68 + 0.48 c + 0.8 c^2 has its minimum 0.608 at c = -0.3; the third term turns freely
    expected = 1.0 / (sqrt(0.608) - 0.1)
    loop = Loop(Plant.from_terms(PARTLY), PI(1.0))
    assert loop.sensitivity_peak() == pytest.approx(expected, rel=1e-10)
    values = ON_TORUS["two of three"][1]
    assert loop.complementary_peak() == pytest.approx(np.abs(values / (1.0 + values)).max(), rel=3e-5)
    swept = sweep([Plant.from_terms(PARTLY)], [PI(1.0)], metrics=["ms", "gain_margin"])
    assert swept["ms"].ravel()[0] == pytest.approx(expected, rel=1e-10)


def test_what_would_be_a_bound_is_refused() -> None:
    related = [([0.2], [1.0], 1.0), ([0.2], [1.0], sqrt(2.0)), ([0.1], [1.0], 1.0 + sqrt(2.0))]
    plant = Plant.from_terms(related)
    for question, what in [
        (Loop(plant, PI(1.0)).sensitivity_peak, "sensitivity peak"),
        (Loop(plant, PI(1.0)).margins, "gain margin"),
        (Loop(plant, PI(1.9)).complementary_peak, "complementary sensitivity peak"),
        (Loop(plant, PI(2.1)).is_stable, "number of unstable poles"),
    ]:
        with pytest.raises(LoopError, match=f"^the {what} is not known: .*dead times"):
            question()
    with pytest.raises(LoopError, match="is not known"):
        gamma_norm(plant, PI(1.0), Weight.balancing(plant, PI(1.0)))
    swept = sweep([plant], [PI(1.0)], metrics=["ms", "gain_margin"])
    assert np.isnan(swept["ms"]).all()
    assert "the sensitivity peak is not known" in str(swept.reason.ravel()[0])
    # a peak of the loop itself, above the bound, is what it is
    lagged = [([0.02], [1.0], 1.0), ([0.02], [1.0], sqrt(2.0)), ([0.01, 0.8], [1.0, 1.0], 1.0 + sqrt(2.0))]
    w = np.linspace(0.001, 40.0, 400_001)
    assert Loop(Plant.from_terms(lagged), PI(1.0)).sensitivity_peak() == pytest.approx(
        np.abs(1.0 / (1.0 + open_loop(lagged, 1.0, 0.0, w))).max(), rel=1e-7
    )


def test_a_weight_without_limit_is_refused_where_the_loop_keeps_turning() -> None:
    swaying = Weight(lambda w: 2.0 + np.sin(w), lambda w: np.cos(w) / (2.0 + np.sin(w)))
    with pytest.raises(LoopError, match="the weight must have a limit at infinite frequency"):
        gamma_norm(Plant([0.3], [1.0], 1.0), PI(1.0), swaying)

"""The nu-gap against closed forms, Vinnicombe's published examples, and his robustness inequality."""

from __future__ import annotations

import itertools
import math

import mpmath as mp
import numpy as np
import pytest

from replicate.loops import PI, Loop, LoopError, Plant, Weight, nu_gap, stability_margin, winding_count

STABLE = (
    Plant([1.0], [1.0, 4.0, 6.0, 4.0, 1.0]),
    Plant([1.0], [4.0, 4.0, 1.0]),
    Plant([1.0], [3.0, 1.0], dead_time=0.5),
    Plant([1.2], [1.0, 3.0, 3.0, 1.0]),
    Plant([1.0], [1.0, 0.0], dead_time=0.4),
    Plant([9.0], np.polymul([1.0, 1.0], [1.0, 2.0, 9.0])),
)


@pytest.mark.parametrize(("k1", "k2"), [(1.0, 2.0), (0.3, 5.0)])
def test_two_integrators(k1: float, k2: float) -> None:
    # |k1 - k2| w / sqrt((w^2 + k1^2)(w^2 + k2^2)) is largest at w^2 = k1 k2
    found = nu_gap(Plant([k1], [1.0, 0.0]), Plant([k2], [1.0, 0.0]))
    assert found == pytest.approx(abs(k1 - k2) / (k1 + k2), rel=1e-13)
    assert found.frequency == pytest.approx(math.sqrt(k1 * k2), rel=1e-7)


@pytest.mark.parametrize(
    ("first", "second", "gap"),
    [
        # Vinnicombe's examples: open-loop responses that look alike can be far apart, and the reverse
        (Plant([100.0], [2.0, 1.0]), Plant([100.0], [2.0, -1.0]), 0.0200),
        (Plant([100.0], [2.0, 1.0]), Plant([100.0], [1.0, 2.0, 1.0]), 0.8988),
    ],
)
def test_published_examples(first: Plant, second: Plant, gap: float) -> None:
    assert round(nu_gap(first, second), 4) == pytest.approx(gap)
    assert nu_gap(first, second) == pytest.approx(nu_gap(second, first), rel=1e-12)


def test_dead_time_of_an_integrator() -> None:
    # |1 - e^{-iwL}| / w over 1 + 1/w^2, that is 2 w sin(wL/2)/(1 + w^2)
    delay = 0.7
    with mp.workdps(30):

        def slope(w: mp.mpf) -> mp.mpf:
            return mp.diff(lambda x: 2 * x * mp.sin(x * mp.mpf("0.7") / 2) / (1 + x * x), w)

        w = mp.findroot(slope, 1.8)
        expected = float(2 * w * mp.sin(w * mp.mpf("0.7") / 2) / (1 + w * w))
    found = nu_gap(Plant([1.0], [1.0, 0.0]), Plant([1.0], [1.0, 0.0], dead_time=delay))
    assert found == pytest.approx(expected, rel=1e-12)


def test_a_weight_scales_both_plants() -> None:
    first, second = STABLE[0], STABLE[1]
    scaled = nu_gap(Plant(first.num * 1.7, first.den), Plant(second.num * 1.7, second.den))
    assert nu_gap(first, second, Weight.constant(1.7)) == pytest.approx(scaled, rel=1e-13)


def test_weight_that_depends_on_frequency() -> None:
    first, second, controller = STABLE[0], STABLE[1], PI(0.76, 0.36)
    found = nu_gap(first, second, Weight.balancing(first, controller))
    w = np.geomspace(1e-3, 1e3, 400_001)
    g1, g2 = 1.0 / (1j * w + 1.0) ** 4, 1.0 / (2j * w + 1.0) ** 2
    scale = np.sqrt(np.abs(0.76 + 0.36 / (1j * w)) / np.abs(g1))
    # the angle between the directions (1, g1 W) and (1, g2 W): |cross product| of unit vectors
    a = np.stack([np.ones_like(g1), g1 * scale]) / np.sqrt(1 + np.abs(g1 * scale) ** 2)
    b = np.stack([np.ones_like(g2), g2 * scale]) / np.sqrt(1 + np.abs(g2 * scale) ** 2)
    distance = np.sqrt(1.0 - np.abs(np.sum(a.conj() * b, axis=0)) ** 2)
    assert found == pytest.approx(distance.max(), rel=1e-8)


def test_winding_condition_by_hand() -> None:
    # 0.5/(s+1) against 0.5/(s-1): 0.25 - (s+1)^2 has no zero on the right, but one is needed
    count = winding_count(Plant([0.5], [1.0, 1.0]), Plant([0.5], [1.0, -1.0]))
    assert (count.found, count.needed) == (0, 1)
    gap = nu_gap(Plant([0.5], [1.0, 1.0]), Plant([0.5], [1.0, -1.0]))
    assert gap == 1.0  # although the responses are nowhere farther apart than 0.8
    assert math.isnan(gap.frequency)


@pytest.mark.parametrize(("first", "second"), list(itertools.permutations(STABLE[:4], 2)))
def test_winding_number_counted_on_the_axis(first: Plant, second: Plant) -> None:
    # wno(1 + G2* G1) + eta(G1) - eta(G2) = 0 with stable plants: the curve must not go round the origin
    w = np.concatenate([-np.geomspace(1e4, 1e-4, 40_001), np.geomspace(1e-4, 1e4, 40_001)])
    g1, g2 = (
        np.polyval(p.num, 1j * w) / np.polyval(p.den, 1j * w) * np.exp(-1j * w * p.dead_time) for p in (first, second)
    )
    turns = np.sum(np.diff(np.unwrap(np.angle(1.0 + g2.conj() * g1)))) / (2.0 * np.pi)
    assert winding_count(first, second).fulfilled == (round(turns) == 0)


@pytest.mark.parametrize(("first", "second"), list(itertools.combinations(STABLE, 2)))
def test_robustness_inequality(first: Plant, second: Plant) -> None:
    # arcsin b(G2) >= arcsin b(G1) - arcsin gap, for every controller (Vinnicombe, theorem 3.8)
    gap = nu_gap(first, second)
    assert 0.0 < gap <= 1.0
    assert gap == pytest.approx(nu_gap(second, first), rel=1e-10)
    for controller in (PI(0.5, 0.2), PI(0.76, 0.36), PI(1.5, 0.5)):
        b1, b2 = (stability_margin(plant, controller) for plant in (first, second))
        assert math.asin(b2) >= math.asin(b1) - math.asin(gap) - 1e-9
        if b1 > gap:
            assert Loop(second, controller).is_stable()


def test_a_plant_has_no_gap_to_itself() -> None:
    assert nu_gap(STABLE[0], STABLE[0]) == 0.0


def test_function_plants_are_refused() -> None:
    with pytest.raises(LoopError, match="rational up to a dead time"):
        nu_gap(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), STABLE[0])

"""Bode, Nyquist and the four transfer functions against their definitions, the phase against arctangents."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from replicate.loops import PI, PID, Loop, LoopError, Plant
from replicate.loops.frequency_domain import frequency_response as response

W = np.geomspace(1e-3, 1e3, 61)


def test_the_phase_of_a_lag_with_dead_time_goes_on_below_minus_180() -> None:
    loop = Loop(Plant.foptd(2.0, 3.0, 0.7), PI(0.6, 0.5))
    # P = 2 e^{-0.7s}/(3s+1), C = (0.6 s + 0.5)/s
    bode = response.bode(loop, W)
    phase = np.arctan2(0.6 * W, 0.5) - np.pi / 2 - np.arctan(3 * W) - 0.7 * W
    np.testing.assert_allclose(bode.phase, np.degrees(phase), rtol=1e-13)
    size = 2 * np.hypot(0.6 * W, 0.5) / W / np.hypot(3 * W, 1.0)
    np.testing.assert_allclose(bode.magnitude, size, rtol=1e-13)
    np.testing.assert_allclose(bode.decibels, 20 * np.log10(size), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(
    ("plant", "controller", "phase"),
    [
        (Plant([1.0], [1.0, 0.0, 0.0], 0.1), PID(1.0, 0.2, 2.0, derivative_filter=0.1), -270.0),
        (Plant([1.0], [1.0, 0.0]), PI(2.0), -90.0),
        (Plant([-2.0], [1.0, 1.0]), PI(0.1), -180.0),
        (Plant([1.0], [1.0, -1.0], 0.2), PI(2.5), -180.0),
        (Plant([-2.0, 1.0], [1.0, 3.0, 3.0, 1.0]), PI(0.1, 0.1), -90.0),
    ],
)
def test_the_phase_starts_at_minus_90_for_each_integrator(plant: Plant, controller: PID, phase: float) -> None:
    assert response.bode(Loop(plant, controller), [1e-9]).phase == pytest.approx([phase], abs=1e-5)


def test_a_sharp_resonance_turns_the_phase_once() -> None:
    # 1/(s^2 + 2e-9 s + 1): the phase falls by 180 degrees within 1e-8 of w = 1
    loop = Loop(Plant([1.0], [1.0, 2e-9, 1.0]), PI(0.1))
    assert response.bode(loop, [0.5, 2.0]).phase == pytest.approx([0.0, -180.0], abs=1e-6)


def test_frequencies_may_come_in_any_order_and_twice() -> None:
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))
    forward, backward = response.bode(loop, W), response.bode(loop, [*W[::-1], W[0]])
    np.testing.assert_allclose(backward.phase[:-1][::-1], forward.phase, rtol=1e-13)
    assert backward.phase[-1] == pytest.approx(forward.phase[0], rel=1e-13)


def test_the_four_transfer_functions() -> None:
    loop = Loop(Plant.foptd(2.0, 3.0, 0.7), PI(0.6, 0.5, measurement_filter=0.2))
    s = 1j * W
    P, C = 2 * np.exp(-0.7 * s) / (3 * s + 1), (0.6 + 0.5 / s) / (0.2 * s + 1)
    np.testing.assert_allclose(response.sensitivity(loop, s), 1 / (1 + P * C), rtol=1e-13)
    np.testing.assert_allclose(response.complementary(loop, s), P * C / (1 + P * C), rtol=1e-13)
    np.testing.assert_allclose(response.load_sensitivity(loop, s), P / (1 + P * C), rtol=1e-13)
    np.testing.assert_allclose(response.noise_sensitivity(loop, s), C / (1 + P * C), rtol=1e-13)
    np.testing.assert_allclose(response.nyquist(loop, W), P * C, rtol=1e-13)


@pytest.mark.parametrize("w", [0.0, -1.0, np.nan, np.inf, "a", None, [1.0, 0.0]])
def test_what_is_no_frequency(w: Any) -> None:
    loop = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))
    with pytest.raises(LoopError, match="frequencies must be positive finite numbers"):
        response.bode(loop, w)

"""Peaks of the sensitivity functions: closed forms, and a root of the derivative in 40-digit arithmetic."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from loops.problems import PROBLEMS, ROOT_PI, STABLE, root_plant_function
from loops.references import peak_modulus
from replicate.loops import PI, Loop, Plant

# |S| of this loop has its supremum at infinite frequency: closed form below
ATTAINED = [name for name in STABLE if name not in ("biproper", "dead-time", "derivative-kick", "neutral")]


@pytest.mark.parametrize("name", ATTAINED)
def test_peaks_against_mpmath(name: str) -> None:
    problem = PROBLEMS[name]
    scale = 1 / max(problem.reference.dead_time, 1.0)
    loop = problem.loop
    ms, at = peak_modulus(lambda s: 1 / (1 + problem.reference.loop_transfer(s)), 1e-4 * scale, 1e3)
    peak = loop.sensitivity_peak()
    assert peak.value == pytest.approx(float(ms), rel=1e-12)
    assert peak.frequency == pytest.approx(float(at), rel=1e-6)  # flat at the top: half of the digits


@pytest.mark.parametrize("name", ["integrating", "double-integrating", "unstable-pi", "unstable-pid"])
def test_complementary_peaks_against_mpmath(name: str) -> None:
    problem = PROBLEMS[name]
    mt, at = peak_modulus(lambda s: 1 - 1 / (1 + problem.reference.loop_transfer(s)), 1e-3, 1e3)
    peak = problem.loop.complementary_peak()
    assert peak.value == pytest.approx(float(mt), rel=1e-12)
    assert peak.frequency == pytest.approx(float(at), rel=1e-6)


@pytest.mark.parametrize("name", ["neutral", "unstable-pid", "derivative-kick"])
def test_neutral_peaks_against_a_dense_grid(name: str) -> None:
    # |S| has infinitely many local maxima here; the highest of 2 million points is within 1e-7 of the supremum
    problem = PROBLEMS[name]
    w = np.linspace(1e-4, 400.0, 2_000_001)
    highest = np.abs(1 / (1 + problem.reference.loop_transfer(1j * w))).max()
    peak = problem.loop.sensitivity_peak()
    assert highest <= peak.value * (1 + 1e-12)
    assert peak.value == pytest.approx(highest, rel=1e-7)


def test_peak_in_the_limit_of_infinite_frequency() -> None:
    # (0.5 s + 0.4)/(s + 1) e^{-0.2s}: |L| rises to 1/2, so |S| <= 1/(1 - |L|) < 2, reached in the limit
    peak = PROBLEMS["biproper"].loop.sensitivity_peak()
    assert peak.value == pytest.approx(2.0, rel=1e-12)
    assert peak.frequency == np.inf


def test_pure_dead_time_under_integral_control() -> None:
    # L = q e^{-iw}/(iw): 1 + L vanishes at q = pi/2, w = pi/2; derivative of |1+L|^2 = 1 - 2 (q/w) sin w + (q/w)^2
    q = 0.5
    with mp.workdps(30):
        slope = lambda w: q * mp.sin(w) / w**2 - q * mp.cos(w) / w - q**2 / w**3  # noqa: E731 - half the derivative
        w = mp.findroot(slope, (1.2, 2.2), solver="anderson")
        expected = 1 / mp.sqrt(1 - 2 * q / w * mp.sin(w) + (q / w) ** 2)
    peak = Loop(Plant([1.0], [1.0], dead_time=1.0), PI(k=0.0, ki=q)).sensitivity_peak()
    assert peak.value == pytest.approx(float(expected), rel=1e-12)
    assert peak.frequency == pytest.approx(float(w), rel=1e-7)


def test_pure_dead_time_under_proportional_control() -> None:
    # S = 1/(1 + k e^{-iw}) is largest at every odd multiple of pi: 1/(1 - k)
    loop = Loop(Plant([1.0], [1.0], dead_time=1.0), PI(k=0.3))
    assert loop.sensitivity_peak().value == pytest.approx(1 / 0.7, rel=1e-12)
    assert loop.complementary_peak().value == pytest.approx(0.3 / 0.7, rel=1e-12)


@given(st.floats(0.02, 50.0), st.floats(0.05, 20.0))
@example(10.25, 3.90625)  # the peak is next to the corner frequency a
@example(4.0, 4.0)  # a double closed-loop pole
def test_second_order_loop_without_dead_time(k: float, a: float) -> None:
    # L = k/(s (s + a)): d|S|^2/dx = 0 at x = w^2 = (k + sqrt(k^2 + 2 a^2 k))/2
    loop = Loop(Plant([1.0], [1.0, a, 0.0]), PI(k=k))
    x = 0.5 * (k + np.sqrt(k * k + 2 * a * a * k))
    ms = np.sqrt(x * (x + a * a) / ((k - x) ** 2 + a * a * x))
    peak = loop.sensitivity_peak()
    assert peak.value == pytest.approx(ms, rel=1e-11)
    # T = w0^2/(s^2 + 2 zeta w0 s + w0^2)
    zeta = a / (2 * np.sqrt(k))
    mt = 1 / (2 * zeta * np.sqrt(1 - zeta**2)) if zeta < np.sqrt(0.5) else 1.0
    assert loop.complementary_peak().value == pytest.approx(mt, rel=1e-11)
    if zeta < 0.7:
        assert loop.complementary_peak().frequency == pytest.approx(np.sqrt(k * (1 - 2 * zeta**2)), rel=1e-5)


def test_first_order_loop_never_exceeds_one() -> None:
    loop = Loop(Plant([1.0], [1.0, 0.0]), PI(k=0.8))
    assert loop.sensitivity_peak().value == pytest.approx(1.0, rel=1e-10)
    assert loop.complementary_peak().value == pytest.approx(1.0, rel=1e-12)


def test_peak_at_steady_state() -> None:
    # positive feedback: S(0) = 1/(1 - 0.6)
    peak = Loop(Plant([1.0], [1.0, 1.0], dead_time=0.3), PI(k=-0.6)).sensitivity_peak()
    assert peak.value == pytest.approx(2.5, rel=1e-12)
    assert peak.frequency == 0.0


def test_root_plant() -> None:
    k, ki = ROOT_PI

    def sensitivity(s: mp.mpc) -> mp.mpc:
        plant = np.exp(-np.sqrt(s)) if isinstance(s, np.ndarray) else mp.exp(-mp.sqrt(s))
        return 1 / (1 + plant * (k + ki / s))

    ms, at = peak_modulus(sensitivity, 1e-3, 1e3)
    peak = Loop(Plant.from_function(root_plant_function), PI(k=k, ki=ki)).sensitivity_peak()
    assert peak.value == pytest.approx(float(ms), rel=1e-12)
    assert peak.frequency == pytest.approx(float(at), rel=1e-6)


@pytest.mark.parametrize("damping", [1e-2, 1e-4, 1e-6])
def test_narrow_resonance_is_not_missed(damping: float) -> None:
    # far below crossover the plant's resonance makes a needle in |S|^-1, its antiresonance one in |S|;
    # L = 0.1 (s^2 + 2 z s + 1)^-1 is so small elsewhere that the peak of T sits at the resonance
    loop = Loop(Plant([1.0], [1.0, 2 * damping, 1.0]), PI(k=0.1))
    w0, zeta = np.sqrt(1.1), damping / np.sqrt(1.1)
    expected = 0.1 / 1.1 / (2 * zeta * np.sqrt(1 - zeta**2))
    peak = loop.complementary_peak()
    assert peak.value == pytest.approx(expected, rel=1e-9)
    assert peak.frequency == pytest.approx(w0 * np.sqrt(1 - 2 * zeta**2), rel=1e-9)


def test_unstable_loop_has_no_peak() -> None:
    from replicate.loops.errors import UnstableLoopError

    loop = PROBLEMS["unstable-loop"].loop
    for ask in (loop.sensitivity_peak, loop.complementary_peak, loop.margins):
        with pytest.raises(UnstableLoopError, match="unstable"):
            ask()

"""The emulated toolchain against python-control, scipy, mpmath and hand-made samples."""

from __future__ import annotations

from collections.abc import Sequence

import control
import mpmath as mp
import numpy as np
import pytest
from scipy import signal

from replicate.loops import PI, Plant
from replicate.loops.emulation import SampledResponse, dominant_pole, pade_loop, sampled_step
from replicate.loops.errors import LoopError


def closed_form(numerator: Sequence[mp.mpf], denominator: Sequence[mp.mpf], t: float) -> float:
    """Step response of a rational function with simple poles: residues of Y(s) e^{st}, in 40 digits."""
    with mp.workdps(40):
        poles = mp.polyroots(denominator, maxsteps=500, extraprec=400)
        slope = [c * (len(denominator) - 1 - i) for i, c in enumerate(denominator[:-1])]
        total = mp.polyval(numerator, 0) / mp.polyval(denominator, 0)
        for p in poles:
            total += mp.polyval(numerator, p) / (p * mp.polyval(slope, p)) * mp.exp(p * t)
        return float(mp.re(total))


# Second-order Padé of e^{-s} as textbooks print it: (1 - s/2 + s^2/12)/(1 + s/2 + s^2/12); plant 1/(s + 1).
NUM = [mp.mpf(1) / 12, mp.mpf(-1) / 2, mp.mpf(1)]
DEN = [mp.mpf(1) / 12, mp.mpf(7) / 12, mp.mpf(3) / 2, mp.mpf(1)]


@pytest.mark.parametrize("b", [1.0, 0.3])
@pytest.mark.parametrize("t", [0.5, 2.0, 7.0])
def test_setpoint_response_of_the_pade_loop_is_its_residue_sum(b: float, t: float) -> None:
    k, ki = mp.mpf("0.6"), mp.mpf("0.5")
    closed = [*DEN, mp.mpf(0)]
    for i, c in enumerate(NUM):  # (k s + ki) N(s), aligned at the low powers
        closed[1 + i] += k * c
        closed[2 + i] += ki * c
    numerator = [b * k * NUM[0], b * k * NUM[1] + ki * NUM[0], b * k * NUM[2] + ki * NUM[1], ki * NUM[2]]
    system = pade_loop(Plant([1.0], [1.0, 1.0], 1.0), PI(0.6, 0.5, b))
    response = sampled_step(system, t, 400)
    assert response.output[-1] == pytest.approx(closed_form(numerator, closed, t), abs=1e-11)


def test_load_response_agrees_with_scipy_for_a_second_order_plant() -> None:
    system = pade_loop(Plant([2.0], [1.0, 3.0, 2.0], 0.4), PI(0.7, 0.9), order=3, response="load")
    # Padé (3, 3) of e^{-0.4 s}: 1 -+ x/2 + x^2/10 -+ x^3/120 with x = 0.4 s.
    x = np.array([0.4**3 / 120, 0.4**2 / 10, 0.2, 1.0])
    num = 2.0 * x * np.array([-1.0, 1.0, -1.0, 1.0])
    den = np.polymul([1.0, 3.0, 2.0], x)
    closed = np.polyadd(np.polymul(den, [1.0, 0.0]), np.polymul(num, [0.7, 0.9]))
    response = sampled_step(system, 12.0, 600)
    _, expected = signal.step((np.polymul(num, [1.0, 0.0]), closed), T=response.time)
    np.testing.assert_allclose(response.output, expected, atol=1e-10)


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_the_pade_loop_is_that_of_python_control(order: int) -> None:
    plant = control.tf([2.0], [1.0, 3.0, 2.0]) * control.tf(*control.pade(0.4, order))
    closed = control.feedback(plant * control.tf([0.7, 0.9], [1.0, 0.0]))
    system = pade_loop(Plant([2.0], [1.0, 3.0, 2.0], 0.4), PI(0.7, 0.9), order)
    np.testing.assert_allclose(np.sort_complex(system.poles()), np.sort_complex(closed.poles()), rtol=1e-7)
    s = 0.3 + 1.7j
    transfer = system.c @ np.linalg.solve(s * np.eye(system.b.size) - system.a, system.b) + system.d
    assert transfer == pytest.approx(complex(closed(s)), rel=1e-11)


def test_without_dead_time_the_loop_is_the_rational_one() -> None:
    response = sampled_step(pade_loop(Plant([1.0], [1.0, 1.0], 0.0), PI(2.0, 2.0)), 3.0, 300)
    np.testing.assert_allclose(response.output, 1.0 - np.exp(-2.0 * response.time), atol=1e-12)


def test_dominant_pole_of_a_double_pole_is_accurate_to_rounding() -> None:
    # k and ki that put a double pole at -1/2 for the plant of NUM and DEN, from P(-1/2) = P'(-1/2) = 0 in
    # exact fractions.
    n, dn = mp.polyval(NUM, -0.5), mp.polyval([NUM[0] * 2, NUM[1]], -0.5)
    s = mp.mpf(-0.5)
    d = s * mp.polyval(DEN, s)
    dd = mp.polyval([4 * DEN[0], 3 * DEN[1], 2 * DEN[2], DEN[3]], s)
    matrix = mp.matrix([[s * n, n], [n + s * dn, dn]])
    k, ki = mp.lu_solve(matrix, mp.matrix([-d, -dd]))
    pole = dominant_pole(pade_loop(Plant([1.0], [1.0, 1.0], 1.0), PI(float(k), float(ki))))
    assert pole.imag == 0.0
    assert pole.real == pytest.approx(-0.5, abs=1e-13)


def test_dominant_pole_of_a_pair_is_the_upper_one() -> None:
    # k s + ki over s (s + 1) with k = 1, ki = 5: s^2 + 2 s + 5 = 0.
    pole = dominant_pole(pade_loop(Plant([1.0], [1.0, 1.0], 0.0), PI(1.0, 5.0)))
    assert pole == pytest.approx(-1.0 + 2.0j, abs=1e-12)


def test_metrics_are_samples_not_interpolations() -> None:
    response = SampledResponse(np.linspace(0.0, 2.0, 9), np.array([0.0, 0.1, 0.49, 0.5, 0.89, 0.95, 1.3, 0.9, 1.01]))
    assert response.spacing == 0.25
    assert response.overshoot() == pytest.approx(0.3)
    assert response.settling_time(0.02) == 1.75
    assert response.delay_time() == 0.75
    assert response.rise_time() == 1.25 - 0.25


def test_what_the_model_leaves_out_is_refused() -> None:
    with pytest.raises(LoopError, match="needs a rational plant"):
        pade_loop(Plant.from_function(lambda s: np.exp(-np.sqrt(s))), PI(1.0, 1.0))
    with pytest.raises(LoopError, match="without filters"):
        pade_loop(Plant([1.0], [1.0, 1.0], 1.0), PI(1.0, 1.0, measurement_filter=0.1))


def test_a_level_that_is_never_reached_is_an_error() -> None:
    with pytest.raises(ValueError, match=r"does not reach 0\.5 within its 3 samples"):
        SampledResponse(np.arange(3.0), np.array([0.0, 0.1, 0.2])).delay_time()

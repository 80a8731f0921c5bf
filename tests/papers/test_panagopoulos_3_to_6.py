"""Papers III to VI of the thesis against formulas that share no code with the replication."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
import scipy.integrate
import scipy.optimize
import scipy.signal
from numpy.typing import NDArray

from replicate.papers.panagopoulos.parts_3_to_6 import industrial, loop_shaping, reference_model
from replicate.papers.panagopoulos.parts_3_to_6.active_damping import EXAMPLE, Shaft
from replicate.papers.panagopoulos.parts_3_to_6.damping_batch import batch, best_gain, impulse_iae
from replicate.papers.panagopoulos.parts_3_to_6.iii_examples import robustness, smallest_weight
from replicate.papers.panagopoulos.parts_3_to_6.modal import ModalSum

# ---------------------------------------------------------------------------------------------------------- III


@pytest.mark.parametrize("m", [1.2, 1.4, 2.0, 3.5])
def test_largest_gamma_on_the_combined_circle(m: float) -> None:
    """(14): maximise (1 + |L|)/|1 + L| on the circle through -m/(m-1) and -(m-1)/m, in 30 digits."""
    with mp.workdps(30):
        left, right = mp.mpf(m) / (mp.mpf(m) - 1), (mp.mpf(m) - 1) / mp.mpf(m)
        center, radius = (left + right) / 2, (left - right) / 2

        def gamma(angle: mp.mpf) -> mp.mpf:
            loop = -center + radius * mp.expj(angle)
            return (1 + abs(loop)) / abs(1 + loop)

        start = max(np.linspace(0.01, 3.13, 400), key=lambda a: float(gamma(mp.mpf(float(a)))))
        best = mp.findroot(lambda a: mp.diff(gamma, a), mp.mpf(float(start)))
        assert float(loop_shaping.gamma_of_m(m)) == pytest.approx(float(gamma(best)), rel=1e-13)
    assert float(loop_shaping.m_of_gamma(loop_shaping.gamma_of_m(m))) == pytest.approx(m, rel=1e-13)


@pytest.mark.parametrize("gamma", loop_shaping.CONTOURS)
def test_contour_by_root_finding(gamma: float) -> None:
    """Radii on the contour along a ray, from the equation itself."""
    curve = loop_shaping.contour(gamma)
    points = curve[[0, 100, 300, 720, 900, 1800, 2500]]
    for point in points:
        turn = point / abs(point)
        level = (1.0 + abs(point)) / abs(1.0 + point)
        assert level == pytest.approx(gamma, rel=1e-10)
        inverse = turn / abs(point)  # the point inverse to the unit circle
        assert (1.0 + abs(inverse)) / abs(1.0 + inverse) == pytest.approx(gamma, rel=1e-10)


def test_example_1_touches_the_circle() -> None:
    """The Nyquist curve of the unrounded design has the circle as tangent; k_i cannot grow with k fixed."""
    found = loop_shaping.design()
    w = np.linspace(0.3, 0.9, 600_001)
    plant = 1.0 / (1j * w + 1.0) ** 4
    distance = np.abs(plant * (found.k + found.ki / (1j * w)) + 1.25)
    assert distance.min() == pytest.approx(0.75, abs=1e-10)
    assert np.abs(plant * (found.k + 1.001 * found.ki / (1j * w)) + 1.25).min() < 0.75
    assert smallest_weight()[0] == pytest.approx(
        float(np.sqrt(np.abs(0.76 + 0.36 / (1j * w)) / np.abs(plant)).min()), rel=1e-10
    )


@pytest.mark.parametrize("weighting", ["none", "favourable"])
def test_example_2_on_a_grid(weighting: str) -> None:
    """Margin and gap from their definitions on a dense grid."""
    w = np.geomspace(1e-3, 1e2, 400_001)
    s = 1j * w
    g1, g2, gc = 1.0 / (s + 1.0) ** 4, 1.0 / (2.0 * s + 1.0) ** 2, 0.76 + 0.36 / s
    scale = np.sqrt(np.abs(gc / g1)) if weighting == "favourable" else np.ones_like(w)
    sigma = np.sqrt((1 + np.abs(gc / scale) ** 2) * (1 + np.abs(g1 * scale) ** 2)) / np.abs(1 + g1 * gc)
    gap = scale * np.abs(g1 - g2) / np.sqrt((1 + np.abs(g1 * scale) ** 2) * (1 + np.abs(g2 * scale) ** 2))
    found = robustness(weighting)
    assert found.b == pytest.approx(1.0 / sigma.max(), rel=1e-8)
    assert found.gap == pytest.approx(gap.max(), rel=1e-8)
    assert found.smallest_difference == pytest.approx((1.0 / sigma - gap).min(), rel=1e-7)


# ----------------------------------------------------------------------------------------------------------- IV


@pytest.mark.parametrize("ratio", [0.25, 1.0, 3.0])
def test_reference_model(ratio: float) -> None:
    """Step response and its characteristics against scipy, with te = 1."""
    system = ([2.0, 0.0], np.polymul([2.0, 1.0], [2.0 * ratio, 1.0]))
    t, y = scipy.signal.step(system, T=np.linspace(0.0, 40.0, 40_001))
    assert reference_model.step(ratio, t) == pytest.approx(y, abs=1e-9)
    found = reference_model.characteristics(ratio)
    assert found.peak == pytest.approx(y.max(), rel=1e-6)
    assert found.peak_time == pytest.approx(t[y.argmax()], abs=2e-3)
    assert found.settling_time == pytest.approx(t[y > 0.02][-1], abs=2e-3)
    area, _ = scipy.integrate.quad(lambda x: float(reference_model.step(ratio, x)), 0.0, 300.0, limit=300)
    assert area == pytest.approx(found.area, rel=1e-9)


# ------------------------------------------------------------------------------------------------------------ V


def _starch(w: NDArray[np.float64], gain: float, ti: float, td: float) -> NDArray[np.complex128]:
    s = 1j * w
    return np.asarray(1.34 * np.exp(-12.9 * s) / (43.3 * s + 1.0) ** 2 * gain * (1.0 + 1.0 / (ti * s) + td * s))


def test_starch_boiler_on_both_limits() -> None:
    """On a dense grid: 1/|1 + L| peaks at 1.6, and the unwrapped phase is level at one point of the range."""
    found = industrial.on_both_limits(1.35)
    low, high = industrial.starch_range()
    w = np.linspace(low, high, 200_001)
    loop = _starch(w, 1.35, found["Ti"], found["Td"])
    assert (1.0 / np.abs(1.0 + loop)).max() == pytest.approx(1.6, rel=1e-7)
    slope = np.gradient(np.unwrap(np.angle(loop)), w) * w
    assert slope[1:-1].max() == pytest.approx(0.0, abs=1e-6)


def test_starch_boiler_as_printed() -> None:
    """Largest curvature and phase slope of the printed settings by finite differences."""
    low, high = industrial.starch_range()
    w = np.linspace(low, high, 40_001)
    loop = _starch(w, *industrial.STARCH_SETTINGS)
    first = np.gradient(loop, w, edge_order=2)
    second = np.gradient(first, w, edge_order=2)
    curvature = (first.conj() * second).imag / np.abs(first) ** 3
    gain, ti, td = industrial.STARCH_SETTINGS
    gains = (gain, gain / ti, gain * td)
    assert curvature[5:-5].max() == pytest.approx(industrial.shape(gains, "curvature"), rel=1e-4)
    slope = (first / loop).imag * w
    assert slope[5:-5].max() == pytest.approx(industrial.shape(gains, "phase"), abs=1e-5)


def test_filter_of_the_drying_section() -> None:
    """The mended formula does what it is for: |F G_sp| = 1 at the peak of |T|."""
    gain, ti, td = industrial.DRYING_SETTINGS
    w = np.linspace(0.15, 0.3, 1_500_001)
    s = 1j * w
    plant = 0.008 * (30.0 * s + 1.0) / (s * (5.0 * s + 1.0)) * np.exp(-2.0 * s)
    loop = plant * gain * (1.0 + 1.0 / (ti * s) + td * s)
    top = np.abs(loop / (1.0 + loop)).argmax()
    response = plant * gain * (1.0 + 1.0 / (ti * s)) / (1.0 + loop)
    found = industrial.setpoint_filters()
    assert abs(response[top] / (1.0 + found.corrected * s[top])) == pytest.approx(1.0, abs=1e-6)
    low = 1j * np.geomspace(1e-3, 10.0, 100_001)
    plant = 0.008 * (30.0 * low + 1.0) / (low * (5.0 * low + 1.0)) * np.exp(-2.0 * low)
    everywhere = plant * gain * (1.0 + 1.0 / (ti * low)) / (1.0 + plant * gain * (1.0 + 1.0 / (ti * low) + td * low))
    assert np.abs(everywhere / (1.0 + found.never_above_one * low)).max() <= 1.0 + 1e-12
    assert np.abs(everywhere / (1.0 + 0.999 * found.never_above_one * low)).max() > 1.0


@pytest.mark.parametrize("gains", [None, (5.2, 1.6, 5.4)])
def test_filter_from_the_peak_on_the_coarse_grid(gains: tuple[float, float, float] | None) -> None:
    """|F G_sp| = 1 at the point of Matlab's 50-point grid with the largest |T|, with G_sp written out."""
    k, ki, kd = gains or (5.21, 5.21 / 3.16, 5.21 * 1.02)
    s = 1j * 10.0 ** (-2.0 + 4.0 * np.arange(50) / 49.0)
    plant = 0.008 * (30.0 * s + 1.0) / (s * (5.0 * s + 1.0)) * np.exp(-2.0 * s)
    loop = plant * (k + ki / s + kd * s)
    top = np.abs(loop / (1.0 + loop)).argmax()
    response = abs(plant[top] * (k + ki / s[top]) / (1.0 + loop[top]))
    expected = np.sqrt(response**2 - 1.0) / abs(s[top])
    assert industrial.setpoint_filters(gains).coarse_grid == pytest.approx(expected, rel=1e-12)
    w = abs(s[top])
    if gains is None:
        assert industrial.beside_the_peak(w)[1] == pytest.approx(expected, rel=1e-12)
        assert industrial.frequency_for_filter(expected) == pytest.approx(w, rel=1e-9)


# ----------------------------------------------------------------------------------------------------------- VI


def _shaft(w: Any) -> Any:
    s = 1j * w
    return 15.21 / ((s + 0.1) * (s**2 + 2 * 0.02 * 7.66 * s + 7.66**2))


def test_characteristics_of_the_shaft() -> None:
    """P_max, P_min and omega_a by minimisation and root finding on the frequency response."""
    assert EXAMPLE.p_max == pytest.approx(abs(_shaft(7.66)), rel=1e-13)
    low = scipy.optimize.minimize_scalar(lambda w: abs(_shaft(w)), bounds=(2.0, 7.0), options={"xatol": 1e-10})
    assert EXAMPLE.extrema()[0].value == pytest.approx(low.fun, rel=1e-12)
    high = scipy.optimize.minimize_scalar(lambda w: -abs(_shaft(w)), bounds=(7.4, 7.9), options={"xatol": 1e-10})
    assert EXAMPLE.extrema()[1].value == pytest.approx(-high.fun, rel=1e-12)

    def imaginary(omega_a: float) -> float:
        s = 7.66j
        return float((_shaft(7.66) * (s**2 - omega_a * s + omega_a**2) / (s**2 + omega_a * s + omega_a**2)).imag)

    assert EXAMPLE.omega_a == pytest.approx(scipy.optimize.brentq(imaginary, 7.0, 8.0, xtol=1e-13), rel=1e-12)


@pytest.mark.parametrize("k_b", [1.0, 2.75])
def test_inner_loop(k_b: float) -> None:
    """PF = k_b at the resonance, and P/(1 + PF) is what it says."""
    w = np.array([0.3, 4.0, 7.66, 20.0])
    s = 1j * w
    omega_a, gain = EXAMPLE.omega_a, k_b * 2 * 0.9 * 7.66 / abs(_shaft(7.66))
    all_pass = (s**2 - omega_a * s + omega_a**2) / (s**2 + omega_a * s + omega_a**2)
    loop = _shaft(w) * all_pass * gain * s / (s**2 + 2 * 0.9 * 7.66 * s + 7.66**2)
    assert loop[2] == pytest.approx(k_b, rel=1e-12)
    assert EXAMPLE.damped(k_b)(s) == pytest.approx(_shaft(w) / (1.0 + loop), rel=1e-11)
    assert abs(EXAMPLE.damped(k_b)(7.66j)) == pytest.approx(EXAMPLE.p_max / (1.0 + k_b), rel=1e-11)


def test_largest_stable_gain_by_nyquist() -> None:
    """The inner loop loses stability where PF = -1, which is a phase crossover with |PF| = 1 for k_b = limit."""
    limit = EXAMPLE.largest_stable_gain()
    num, den = EXAMPLE.filter(1.0)
    w = np.geomspace(1.0, 100.0, 2_000_001)
    loop = _shaft(w) * np.polyval(num, 1j * w) / np.polyval(den, 1j * w)
    crossing = np.nonzero((loop.imag[:-1] * loop.imag[1:] < 0) & (loop.real[:-1] < 0))[0]
    assert 1.0 / np.abs(loop[crossing].real).max() == pytest.approx(limit, rel=1e-5)


@pytest.mark.parametrize("k_b", [0.0, 1.0, 2.75])
def test_iae_by_quadrature(k_b: float) -> None:
    """The IAE of the impulse response, from scipy's state-space simulation and a fine trapezoidal rule."""
    shaft = Shaft.as_in_eq_3(0.05, 3.0)
    plant = shaft.damped(k_b)
    t = np.linspace(0.0, 120.0, 600_001)
    _, y = scipy.signal.impulse((plant.num, plant.den), T=t)
    assert ModalSum.impulse(plant)(t[::1000]) == pytest.approx(y[::1000], abs=1e-9)
    assert impulse_iae(shaft, k_b) == pytest.approx(scipy.integrate.trapezoid(np.abs(y), t), rel=1e-6)


def test_pulse_is_an_average_of_the_impulse_response() -> None:
    response = ModalSum.impulse(EXAMPLE.damped(2.75))
    for time in (0.05, 0.3, 4.0):
        area, _ = scipy.integrate.quad(lambda x: float(response(x)), max(time - 0.1, 0.0), time)
        assert float(response.pulse(0.1, time)) == pytest.approx(area / 0.1, rel=1e-9)


def test_best_gain_is_a_minimum() -> None:
    shaft = Shaft.as_in_eq_3(0.05, 3.0)
    k_b, iae = best_gain(shaft)
    others = [impulse_iae(shaft, k) for k in np.linspace(0.0, 0.95 * shaft.largest_stable_gain(), 150)]
    assert iae <= min(others)
    assert k_b == pytest.approx(scipy.optimize.brent(lambda k: impulse_iae(shaft, k), brack=(0.9, 1.2, 1.7)), abs=2e-5)


def test_batch_with_the_gain_of_equation_10() -> None:
    """Poles of 1 + PF from polynomials written out, k_b by (10) from |P| on a grid, the IAE never below the best."""
    for member in batch()[::7]:
        wp, zeta = member.omega_p, member.zeta_p
        p_num, p_den = [wp**2], np.polymul([1.0, 1.0], [1.0, 2 * zeta * wp, wp**2])
        w = np.linspace(0.0, wp, 200_001)  # |P| falls to its minimum and rises to P_max at wp
        size = np.abs(np.polyval(p_num, 1j * w) / np.polyval(p_den, 1j * w))
        k_b = -0.46 + 0.33 * size[-1] / size.min()
        # the all-pass filter turns the phase of P at wp to -360 degrees
        phase = float(np.angle(np.polyval(p_num, 1j * wp) / np.polyval(p_den, 1j * wp)))

        def turned(a: float, wp: float = wp, phase: float = phase) -> float:
            all_pass = np.polyval([1, -a, a**2], 1j * wp) / np.polyval([1, a, a**2], 1j * wp)
            return float(np.angle(np.exp(1j * phase) * all_pass))

        a = scipy.optimize.brentq(turned, 0.3 * wp, 1.2 * wp)
        f_num = np.polymul([1.0, -a, a**2], [k_b * 1.8 * wp / size[-1], 0.0])
        f_den = np.polymul([1.0, a, a**2], [1.0, 1.8 * wp, wp**2])
        poles = np.roots(np.polyadd(np.polymul(p_den, f_den), np.polymul(p_num, f_num)))
        pairs = poles[poles.imag > 1e-6]
        assert member.damping == pytest.approx((-pairs.real / np.abs(pairs)).min(), rel=1e-6)
        assert member.iae <= member.iae_by_formula_10 * (1.0 + 1e-9)


def test_no_minimum_below_the_resonance() -> None:
    with pytest.raises(ValueError, match="no minimum below its resonance"):
        Shaft.as_in_eq_3(0.5, 3.0).extrema()


@pytest.mark.parametrize(
    ("inside", "outside"),
    [
        # far above the corner: zeta_p = sqrt(2 - sqrt(3))/2
        [Shaft.as_in_eq_3(np.sqrt(2.0 - np.sqrt(3.0)) / 2.0 * factor, 1e5) for factor in (0.9999, 1.0001)],
        # without damping: omega_p = sqrt(2) omega_f
        [Shaft.as_in_eq_3(1e-9, np.sqrt(2.0) * factor) for factor in (1.0001, 0.9999)],
    ],
)
def test_where_the_minimum_begins_to_exist(inside: Shaft, outside: Shaft) -> None:
    assert inside.extrema()[0].frequency > 0.0
    with pytest.raises(ValueError, match="no minimum below its resonance"):
        outside.extrema()

"""Khan and Lehman against formulas that share no code with the paper's package."""

from __future__ import annotations

import cmath
import csv
import re
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import lambertw

from replicate.loops import PI, Loop, Plant
from replicate.papers.khan import (
    appendix,
    appendix_coefficients,
    break_point,
    bryant,
    claims_robustness,
    closed_form,
    coefficients_7,
    fits,
    processes,
    refit,
    smooth,
    sweep,
)
from replicate.papers.khan import paper as khan
from replicate.papers.khan.fit_quality import largest_jump

FOLDER = Path(processes.__file__).parent


def exact_p_control(ph: float, kh: float, t: float) -> float:
    """Method of steps in closed form: paths around y' = -ph y + kh (1 - y(t - 1))."""
    with mp.workdps(30):
        total = mp.mpf(0)
        for n in range(int(t)):
            rest = mp.mpf(t) - (n + 1)
            if rest > 0:
                # inverse of k^(n+1) / (s (s + p)^(n+1)) at t - n - 1: the regularised incomplete gamma function
                if ph:
                    part = (mp.mpf(kh) / ph) ** (n + 1) * mp.gammainc(n + 1, 0, ph * rest, regularized=True)
                else:
                    part = mp.mpf(kh) ** (n + 1) * rest ** (n + 1) / mp.factorial(n + 1)
                total += (-1) ** n * part
        return float(total)


@pytest.mark.parametrize(("ph", "kh"), [(0.0, 0.9), (0.5, 1.2), (3.0, 3.5), (10.0, 8.0)])
def test_overshoot_is_that_of_the_closed_form(ph: float, kh: float) -> None:
    found = sweep.sweep(ph, np.array([kh])).overshoot[0]
    final = kh / (kh + ph)
    with mp.workdps(30):
        times = np.linspace(1.01, 6.0, 500)
        start = times[np.argmax([exact_p_control(ph, kh, t) for t in times])]
        left, right = start - 0.02, start + 0.02
        for _ in range(60):  # golden section, independent of any derivative
            a, b = right - 0.618034 * (right - left), left + 0.618034 * (right - left)
            left, right = (a, right) if exact_p_control(ph, kh, a) < exact_p_control(ph, kh, b) else (left, b)
    peak = exact_p_control(ph, kh, 0.5 * (left + right))
    assert found == pytest.approx(100.0 * (peak / final - 1.0), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("ph", [0.0, 0.3, 1.0, 4.0, 10.0])
def test_rightmost_pole_reaches_the_axis_at_the_stability_limit(ph: float) -> None:
    limit = sweep.stability_limit(ph)
    pole = -ph + complex(lambertw(-limit * np.exp(ph), 0))
    assert abs(pole.real) < 1e-9


@pytest.mark.parametrize("ph", [0.0, 0.5, 2.0])
def test_breakpoint_is_the_branch_point_of_lambert_w(ph: float) -> None:
    assert break_point.double_pole(ph) == pytest.approx(float(mp.e ** (-1 - ph)), rel=1e-7)


def test_printed_coefficients_of_example_2_1() -> None:
    # the paper's own intermediate values, from p = 1.667, h = 1.82
    a1, b1 = fits.case_4_parts(1.667 * 1.82)
    assert (round(a1, 4), round(b1, 3)) == (-3.7945, 30.843)


def test_cases_cover_what_they_say() -> None:
    assert [fits.case_of(0.5, 0.7), fits.case_of(0.5, 0.71), fits.case_of(0.5, 1.6)] == ["I", "II", None]
    assert [fits.case_of(3.0, 1.0), fits.case_of(3.01, 1.0), fits.case_of(10.1, 1.0)] == ["III", "IV", None]
    assert fits.overshoot_fit(0.0, 0.2) == 0.0  # M is complex there


def test_fit_by_hand() -> None:
    # case III at ph = 1, Kh = 1, written out from the page
    a = -0.5967 + 0.07306 - 59.467 * np.exp(-1 / 1.0871)
    b = 22.9 - 1.346 + 73.31 * np.exp(-1 / 1.67)
    c = -0.43035 + 0.04611 + 58.842 * np.exp(-1 / 1.159)
    d = -2.221 + 0.05809 - 0.8723 * np.exp(1 / 1.6229)
    assert fits.overshoot_fit(1.0, 1.0) == pytest.approx(a + b + c * np.exp(d), rel=1e-14)


def test_other_cases_by_hand() -> None:
    # one point of each, written out from the page
    case_1 = (
        -0.5 + (38.943 + 78.182 * np.exp(-0.25 / 0.60834)) * (0.6 - 0.00938 - 0.3706 * np.exp(-0.25 / 1.10974)) ** 1.5
    )
    case_2 = (-49.49 + 55.46 * 0.25 - 33.507 * 0.0625) + (99.572 - 71.6378 * 0.25 + 38.6303 * 0.0625)
    case_4 = (0.0578 - 0.005653 * 4 - 58.493 * np.exp(-4 / 1.1135)) + 2 * (
        15.424 - 0.637 * 4 + 61.7669 * np.exp(-4 / 2.3895)
    )
    rise_time = (0.39955 - 0.035512 * 2 + 9.4069 * np.exp(-2.2294 * 2)) * np.exp(
        -1 / (-0.14406 + 0.16277 * 2 + 0.34998 * np.exp(-0.45502 * 2))
    ) + (0.17204 - 0.005396 * 2 + 1.0779 * np.exp(-0.45261 * 2)) * np.exp(
        -1 / (-1.3604 + 1.2889 * 2 + 3.08798 * np.exp(-0.37192 * 2))
    )
    assert fits.overshoot_fit(0.25, 0.6) == pytest.approx(case_1, rel=1e-14)
    assert fits.overshoot_fit(0.25, 1.0) == pytest.approx(case_2, rel=1e-14)
    assert fits.overshoot_fit(4.0, 2.0) == pytest.approx(case_4, rel=1e-14)
    assert float(fits.rise_time_fit(2.0, 1.0)) == pytest.approx(rise_time, rel=1e-14)


@pytest.mark.parametrize("zeta", [0.05, 0.3, 0.6, 0.9, 0.999])
def test_gain_for_a_damping_ratio_is_that_of_lambert_w(zeta: float) -> None:
    pole = complex(lambertw(-bryant.gain_for_damping(zeta), 0))
    assert -pole.real / abs(pole) == pytest.approx(zeta, rel=1e-9)
    # the Pade model's characteristic polynomial, by numpy
    k = bryant.gain_for_damping_pade(zeta)
    root = np.roots([0.5, 1.0 - 0.5 * k, k])[0]
    assert -root.real / abs(root) == pytest.approx(zeta, rel=1e-9)


def test_appendix_fits_follow_the_optimum() -> None:
    # case II and J_opt at points between those of the fit, case I against numpy's own straight line
    a, b, c = (appendix_coefficients.equal_steps()["value"][f"KP_II_{letter}"] for letter in "abc")
    for ph in (1.0, 3.3, 14.1):
        assert a + b * ph + c * np.sqrt(ph) == pytest.approx(appendix.optimum(ph)[0], rel=0.02)
    p = np.linspace(0.01, 0.2, appendix_coefficients.POINTS)
    line = np.polynomial.Polynomial.fit(p, [appendix.optimum(x)[1] for x in p.tolist()], 1).convert().coef
    found = [appendix_coefficients.equal_steps()["value"][f"KI_I_{letter}"] for letter in "ab"]
    assert found == pytest.approx(line, rel=1e-4)


def test_restored_7a_meets_7b() -> None:
    left = processes.case_gains("7a", 0.2, 1.0, processes.RESTORED)
    right = processes.case_gains("7b", 0.2, 1.0)
    assert np.allclose(left, right, rtol=1e-3)
    printed = processes.case_gains("7a", 0.2, 1.0)
    assert not np.allclose(printed, right, rtol=0.2)


@pytest.mark.parametrize(("rule", "kp", "ki"), [
    ("Haalman", 2 / 3 / 0.5, 2 * 2 / 3 / 0.5),
    ("Bryant", 0.368 / 0.5, 2 * 0.368 / 0.5),
    ("ZN", 0.9 / 0.5, 0.9 / 0.5 / 1.5),
])  # fmt: skip
def test_rules_in_parallel_form(rule: str, kp: float, ki: float) -> None:
    # p = 2, h = 0.5: K = tau = 1/2
    assert processes.gains(rule, 2.0, 0.5) == pytest.approx((kp, ki))


@pytest.mark.parametrize(("p", "kp", "ki"), [(1.0, 0.8, 0.5), (5.0, 2.0, 2.5)])
def test_corrected_ise_is_parsevals_integral(p: float, kp: float, ki: float) -> None:
    def integrand(w: float) -> float:
        s = 1j * w
        loop = (kp + ki / s) * cmath.exp(-s) / (s + p)
        return abs(1 / (1 + loop) / s) ** 2

    # in double precision: what is neglected beyond the last frequency is larger by far
    value = mp.fp.quad(integrand, [1e-12, 1, 3, *range(6, 400, 3)]) / np.pi
    tail = 1 / np.pi / 399  # |E|^2 -> 1/w^2
    assert appendix.closed_form(p, kp, ki) == pytest.approx(float(value + tail), rel=2e-4)
    assert appendix.closed_form(p, kp, ki) == pytest.approx(appendix.integral(p, kp, ki), rel=1e-10)
    assert appendix.closed_form(p, kp, ki, sign=1.0) > 1.3 * float(value)


def test_the_optimum_is_stationary() -> None:
    kp, ki, best = appendix.optimum(2.0)
    for dk, di in ((1e-4, 0.0), (-1e-4, 0.0), (0.0, 1e-4), (0.0, -1e-4)):
        assert appendix.closed_form(2.0, kp + dk, ki + di) > best


@pytest.mark.parametrize(("ph", "kh"), [(0.0, 1.2), (0.3, 0.9), (1.0, 0.5), (4.0, 0.6), (10.0, 5.0)])
def test_first_peak_in_closed_form(ph: float, kh: float) -> None:
    # the paper's own definition on the closed-form response: where its slope first vanishes, found by bisection
    with mp.workdps(30):

        def slope(t: float) -> float:
            return exact_p_control(ph, kh, t + 5e-6) - exact_p_control(ph, kh, t - 5e-6)

        left, right = 1.5, 2.0 + 1.01 * np.exp(-ph) / kh + 1e-3
        for _ in range(60):
            middle = 0.5 * (left + right)
            left, right = (middle, right) if slope(middle) > 0.0 else (left, middle)
    final = kh / (kh + ph)
    assert left == pytest.approx(2.0 + np.exp(-ph) / kh, abs=2e-6)
    expected = 100.0 * (exact_p_control(ph, kh, left) / final - 1.0)
    assert closed_form.has_first_peak(ph, kh)
    assert closed_form.first_peak(ph, kh) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("ph", "kh"), [(0.0, 1.2), (0.5, 0.8), (2.5, 0.05), (10.0, 5.0)])
def test_rise_time_in_closed_form(ph: float, kh: float) -> None:
    final = kh / (kh + ph)

    def reach(level: float) -> float:
        left, right = 1.0, 2.0
        for _ in range(60):
            middle = 0.5 * (left + right)
            left, right = (middle, right) if exact_p_control(ph, kh, middle) < level * final else (left, middle)
        return left

    expected = reach(0.9) - reach(0.1)
    assert closed_form.has_rise_time(ph, kh)
    assert closed_form.rise_time(ph, kh) == pytest.approx(expected, rel=1e-10)
    assert sweep.sweep(ph, np.array([kh])).rise_time[0] == pytest.approx(expected, rel=1e-10)


def test_closed_forms_say_where_they_end() -> None:
    # just below Kh = e^-ph the peak comes after the second dead time; 90 % is then not reached before the feedback
    assert not closed_form.has_first_peak(1.0, 0.99 * np.exp(-1.0))
    assert closed_form.has_rise_time(np.log(10.0) + 1e-9, 1e-12)
    assert not closed_form.has_rise_time(np.log(10.0) - 0.01, 1e-12)


def test_batches_agree_with_single_responses() -> None:
    # Signal finds peaks and crossings one response at a time, by the colleague matrix
    for ph, kh in ((0.0, 0.45), (0.7, 1.9), (3.0, 3.8), (7.0, 7.45)):
        y = Loop(Plant([1.0], [1.0, ph], dead_time=1.0), PI(kh)).step(until=60.0)
        found = sweep.sweep(ph, np.linspace(0.2, 1.0, 5) * kh)
        assert found.overshoot[-1] == pytest.approx(100.0 * y.overshoot(), rel=1e-11)
        assert found.rise_time[-1] == pytest.approx(y.rise_time(), rel=1e-11)
        assert found.first_peak[-1] == pytest.approx(100.0 * (float(y.extrema()[0]) / y.final - 1.0), rel=1e-11)


def test_dense_grid_is_what_the_quality_tables_say() -> None:
    loops = sweep.dense()
    assert loops.ph.size >= 10_000
    assert (loops.kh < np.hypot(loops.ph, np.pi)).all()  # Kh^2 = ph^2 + w^2 with w < pi at the limit
    higher = loops.overshoot > loops.first_peak + 1e-9
    assert 0.94 < loops.share[higher].min() < 0.96
    assert loops.ph[higher].min() >= 2.5


def test_a_later_peak_that_is_hardly_higher_is_the_highest() -> None:
    # Signal's extrema one by one; at ph = 5 the peaks change places at 0.9550 of the stability limit
    for share, later in ((0.9549, False), (0.9551, True)):
        gain = share * sweep.stability_limit(5.0)
        first, *others = map(float, Loop(Plant([1.0], [1.0, 5.0], dead_time=1.0), PI(gain)).step(until=30.0).extrema())
        assert (max(others) > first) is later
        found = sweep.sweep(5.0, np.linspace(0.5, 1.0, 5) * gain)
        assert bool(found.overshoot[-1] > found.first_peak[-1] + 1e-9) is later


def test_unstable_gains_are_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"ph = 1: stable gains are 0 < Kh < 2\.26183, not 1 to 3"):
        sweep.sweep(1.0, np.array([1.0, 3.0]))


def test_smooth_formula_against_the_exact_overshoot() -> None:
    # published coefficients, at loops between those of the grid it is fitted to
    coefficients = refit.smooth_coefficients()
    for ph in (0.0, 0.0125, 0.33, 0.777, 1.61, 2.93, 6.1, 9.9):
        loops = sweep.sweep(ph, np.linspace(0.013, 0.945, 37) * sweep.stability_limit(ph))
        values = smooth.smooth_overshoot(ph, loops.kh, coefficients)
        assert np.abs(values - loops.overshoot).max() < 0.25, ph
        assert (values >= 0.0).all()


def test_refits_are_better_than_the_print_in_what_they_minimise() -> None:
    for case, (start, found, old, new) in refit.refitted().items():
        assert start.shape == found.shape
        assert new["rms"] <= old["rms"], case


@pytest.mark.parametrize(("case", "step"), [("case-3", 1e-6), ("rise-time", 1e-6)])
def test_jacobian_of_the_refit_against_differences(case: str, step: float) -> None:
    loops = sweep.sweep(1.3, np.linspace(0.3, 0.9, 7) * sweep.stability_limit(1.3))
    printed = fits.printed_coefficients()
    evaluate = {"case-3": refit._clipped, "rise-time": None}[case]

    def value(x: np.ndarray) -> np.ndarray:
        c = refit._with(printed, case, x)
        return refit._rise_time(loops, c) if evaluate is None else evaluate("III", loops, c)

    start = refit._flat(printed, case)
    found = refit._jacobian(refit._SLOPES[case], printed[case], loops)
    for index, x in enumerate(start):
        shift = np.zeros(start.size)
        shift[index] = step * max(1.0, abs(x))
        expected = (value(start + shift) - value(start - shift)) / (2.0 * shift[index])
        assert found[:, index] == pytest.approx(expected, rel=1e-5, abs=1e-7), index


def test_only_three_shifted_decimal_points_meet_7b() -> None:
    # by hand: (7a) at ph = 0.2, h = 1 against (7b)
    kp = 0.404 + 0.256 * 0.2 - 0.1275 * np.sqrt(0.2)
    ki = 0.0808 + 0.719 * 0.2 - 0.324 * np.sqrt(0.2)
    frame = coefficients_7.implied()["value"]
    a, b, c = (frame[f"7a_KP_{letter}"] for letter in "abc")
    assert (a, b, c) == (-0.0404, 0.0723, 0.3852)
    assert a * 0.04 + b * 0.2 + c == pytest.approx(kp, rel=5e-4)
    a, b, c = (frame[f"7a_KI_{letter}"] for letter in "abc")
    assert (a, b, c) == (-0.0525, 0.4104, -0.00024)
    assert a * 0.04 + b * 0.2 + c == pytest.approx(ki, rel=6e-4)


def test_summary_quotes_the_restored_coefficients() -> None:
    quoted = re.findall(r"-?0\.\d+", khan.summary.replace("- 0", "-0"))
    restored = coefficients_7.implied()["value"]
    assert [float(text) for text in quoted] == [restored[f"7a_{gain}_{x}"] for gain in ("KP", "KI") for x in "abc"]


def test_tables_against_a_frequency_grid_and_an_ode_solver() -> None:
    # the ITAE row at ph = 1: K_P, K_I from the rule by hand, M_s on a fine grid, overshoot by RK45 with a history
    kp, ki = 0.586, 0.586 * (1.03 - 0.165)
    w = np.linspace(1e-3, 20.0, 400_001)
    s = 1j * w
    ms = np.max(np.abs(1.0 / (1.0 + (kp + ki / s) * np.exp(-s) / (s + 1.0))))
    closed = processes.loop("ITAE", 1.0, 1.0)
    assert float(closed.sensitivity_peak()) == pytest.approx(ms, rel=1e-9)
    n = 4000  # steps per dead time, trapezoidal rule
    y, u = np.zeros(12 * n), np.zeros(12 * n)
    integral, dt = 0.0, 1.0 / n
    for j in range(1, 12 * n):
        old, new = (u[j - 1 - n] if j > n else 0.0), (u[j - n] if j >= n else 0.0)
        y[j] = ((1.0 - 0.5 * dt) * y[j - 1] + 0.5 * dt * (old + new)) / (1.0 + 0.5 * dt)
        integral += 0.5 * dt * (2.0 - y[j] - y[j - 1])
        u[j] = kp * (1.0 - y[j]) + ki * integral
        if j == 1:
            u[0] = kp
    assert closed.step().overshoot() == pytest.approx(y.max() - 1.0, abs=1e-4)
    outside = np.flatnonzero(np.abs(y - 1.0) > 0.02)[-1] * dt
    assert closed.step().settling_time() == pytest.approx(outside, abs=5e-3)


def test_a_hundredth_of_the_band_moves_the_slow_settling_times_by_more_than_they_are_off() -> None:
    # Ziegler-Nichols at ph = 10: the tail is one exponential, whose rate is a real root of the characteristic equation
    kp, ki = 0.09, 0.09 / 30.0
    rate = brentq(lambda a: -a * (1.0 - a) + (-kp * a + ki) * np.exp(10.0 * a), 1e-4, 1e-2)
    printed = khan.printed_numbers("table-1")
    y = processes.loop("ZN", 1.0, 10.0)
    for column, signal in (("ts", y.step()), ("td", y.load_step())):
        assert 0.01 / rate > abs(signal.settling_time(0.02) - printed["ZN", column])


def test_a_gain_that_rounds_to_bryants_gives_the_printed_settling_times() -> None:
    # in closed form: the gains for which the response of the cancelled loop reaches 0.98 at a given time
    def gain(time: float) -> float:
        return float(brentq(lambda kh: exact_p_control(0.0, kh, time) - 0.98, 0.36, 0.38))

    # 65.2 at h = 10, 6.525 at h = 1 and 0.652 at h = 0.1 have gains in common, and these round to 0.368
    low, high = gain(6.525), gain(6.5245)
    assert 0.3675 < low < high < 0.3685
    # 0.368 itself is not among them, and the gain that gives 11.84 at h = 1.82 does not round to L_PB = 0.1213
    assert not low <= 0.368 <= high
    assert gain(11.845 / 1.82) * 0.6 / 1.82 > 0.12135


@pytest.mark.parametrize(("table", "rows", "columns"), [("table-1", 5, 4), ("table-2", 7, 8)])
def test_printed_tables_are_complete(table: str, rows: int, columns: int) -> None:
    with (FOLDER / "printed" / f"{table}.csv").open() as stream:
        lines = list(csv.reader(stream))
    assert len(lines) == rows + 1
    assert all(len(line) == columns + 1 and all(line) for line in lines)


def test_the_largest_jump_between_cases_iii_and_iv_on_a_dense_grid() -> None:
    p = 3.0
    k = np.linspace(0.0, 0.99 * sweep.stability_limit(p), 200_001)
    three = (
        (-0.5967 + 0.07306 * p - 59.467 * np.exp(-p / 1.0871))
        + (22.9 - 1.346 * p + 73.31 * np.exp(-p / 1.67)) * k
        + (-0.43035 + 0.04611 * p + 58.842 * np.exp(-p / 1.159))
        * np.exp((-2.221 + 0.05809 * p - 0.8723 * np.exp(p / 1.6229)) * k)
    )
    four = (0.0578 - 0.005653 * p - 58.493 * np.exp(-p / 1.1135)) + (
        15.424 - 0.637 * p + 61.7669 * np.exp(-p / 2.3895)
    ) * k
    jump = np.maximum(four, 0.0) - np.maximum(three, 0.0)
    found, _, at = largest_jump(("III", "IV"), (p, 0.0), (p, float(k[-1])))
    assert found == pytest.approx(jump[np.argmax(np.abs(jump))], abs=1e-3)
    assert at == pytest.approx(k[np.argmax(np.abs(jump))], abs=1e-4)


def test_bryants_gain_overshoots_by_less_than_any_digit() -> None:
    """The poles of s + K e^{-hs} are W(-Kh)/h; successive extrema of the slowest mode fall by exp(-pi Re/Im)."""
    pole = lambertw(-0.368)
    assert abs(pole.imag) > 0.0
    assert np.exp(-np.pi * abs(pole.real / pole.imag)) < 1e-30
    finding = claims_robustness.bryant_no_overshoot()
    assert (finding.verdict, finding.value) == ("holds", 0.0)


@pytest.mark.parametrize("ph", [0.1, 1.0, 20.0])
def test_added_dead_time_at_the_limit_puts_a_pole_on_the_axis(ph: float) -> None:
    """At Delta h = phi_m/omega_c the characteristic function vanishes at i omega_c."""
    kp, ki = processes.gains("Proposed", 1.0, ph, processes.RESTORED)
    wc = brentq(lambda w: abs(complex(kp, -ki / w)) - abs(complex(1.0, w)), 1e-6, 1e3, xtol=1e-15)
    phase = np.angle(complex(kp, -ki / wc)) - np.angle(complex(1.0, wc)) - wc * ph
    total = ph + (np.pi + phase) / wc
    assert abs(1j * wc * (1j * wc + 1.0) + (kp * 1j * wc + ki) * np.exp(-1j * wc * total)) < 1e-9 * wc
    margins = Loop(Plant([1.0], [1.0, 1.0], dead_time=ph), PI(kp, ki)).margins()
    assert np.radians(margins.phase) / margins.gain_crossover == pytest.approx(total - ph, rel=1e-9)

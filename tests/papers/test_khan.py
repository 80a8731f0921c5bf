"""Khan and Lehman against formulas that share no code with the paper's package."""

from __future__ import annotations

import csv
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.special import lambertw

from replicate.papers.khan import appendix, break_point, fits, processes, refit, sweep

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
def test_overshoot_is_that_of_the_closed_form(ph, kh):
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
def test_rightmost_pole_reaches_the_axis_at_the_stability_limit(ph):
    limit = sweep.stability_limit(ph)
    pole = -ph + complex(lambertw(-limit * np.exp(ph), 0))
    assert abs(pole.real) < 1e-9


@pytest.mark.parametrize("ph", [0.0, 0.5, 2.0])
def test_breakpoint_is_the_branch_point_of_lambert_w(ph):
    assert break_point.double_pole(ph) == pytest.approx(float(mp.e ** (-1 - ph)), rel=1e-7)


def test_printed_coefficients_of_example_2_1():
    # the paper's own intermediate values, from p = 1.667, h = 1.82
    a1, b1 = fits.case_4_parts(1.667 * 1.82)
    assert (round(a1, 4), round(b1, 3)) == (-3.7945, 30.843)


def test_cases_cover_what_they_say():
    assert [fits.case_of(0.5, 0.7), fits.case_of(0.5, 0.71), fits.case_of(0.5, 1.6)] == ["I", "II", None]
    assert [fits.case_of(3.0, 1.0), fits.case_of(3.01, 1.0), fits.case_of(10.1, 1.0)] == ["III", "IV", None]
    assert fits.overshoot_fit(0.0, 0.2) == 0.0  # M is complex there


def test_fit_by_hand():
    # case III at ph = 1, Kh = 1, written out from the page
    a = -0.5967 + 0.07306 - 59.467 * np.exp(-1 / 1.0871)
    b = 22.9 - 1.346 + 73.31 * np.exp(-1 / 1.67)
    c = -0.43035 + 0.04611 + 58.842 * np.exp(-1 / 1.159)
    d = -2.221 + 0.05809 - 0.8723 * np.exp(1 / 1.6229)
    assert fits.overshoot_fit(1.0, 1.0) == pytest.approx(a + b + c * np.exp(d), rel=1e-14)


def test_restored_7a_meets_7b():
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
def test_rules_in_parallel_form(rule, kp, ki):
    # p = 2, h = 0.5: K = tau = 1/2
    assert processes.gains(rule, 2.0, 0.5) == pytest.approx((kp, ki))


@pytest.mark.parametrize(("p", "kp", "ki"), [(1.0, 0.8, 0.5), (5.0, 2.0, 2.5)])
def test_corrected_ise_is_parsevals_integral(p, kp, ki):
    def integrand(w: float) -> float:
        s = mp.mpc(0, w)
        loop = (kp + ki / s) * mp.exp(-s) / (s + p)
        return abs(1 / (1 + loop) / s) ** 2

    with mp.workdps(20):
        value = mp.quad(integrand, [mp.mpf("1e-12"), 1, 3, *range(6, 400, 3)]) / mp.pi
        tail = 1 / mp.pi / 399  # |E|^2 -> 1/w^2
    assert appendix.closed_form(p, kp, ki) == pytest.approx(float(value + tail), rel=2e-4)
    assert appendix.closed_form(p, kp, ki) == pytest.approx(appendix.integral(p, kp, ki), rel=1e-10)
    assert appendix.closed_form(p, kp, ki, sign=1.0) > 1.3 * float(value)


def test_the_optimum_is_stationary():
    kp, ki, best = appendix.optimum(2.0)
    for dk, di in ((1e-4, 0.0), (-1e-4, 0.0), (0.0, 1e-4), (0.0, -1e-4)):
        assert appendix.closed_form(2.0, kp + dk, ki + di) > best


def test_smooth_formula_has_no_complex_values():
    ph, kh = np.meshgrid(np.linspace(0, 10, 41), np.linspace(0, 10, 41))
    values = refit.better_formula(np.array(refit.BETTER_START), ph.ravel(), kh.ravel())
    assert np.isfinite(values).all()
    assert (values >= 0).all()


@pytest.mark.parametrize(("table", "rows", "columns"), [("table-1", 5, 4), ("table-2", 7, 8)])
def test_printed_tables_are_complete(table, rows, columns):
    with (FOLDER / "printed" / f"{table}.csv").open() as stream:
        lines = list(csv.reader(stream))
    assert len(lines) == rows + 1
    assert all(len(line) == columns + 1 and all(line) for line in lines)

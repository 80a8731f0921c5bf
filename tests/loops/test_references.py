"""The references against each other: two formulas that share nothing but the problem."""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest

from loops.closed_forms import (
    foptd_load_ise,
    foptd_p_pole,
    integrator_p_ise,
    integrator_p_pole,
    p_foptd,
    pi_dead_time,
    pi_foptd,
    pi_integrator,
    rational_step,
    root_plant,
    root_plant_first_wave,
    root_plant_pi,
)
from loops.problems import PROBLEMS, ROOT_PI, ROOT_POLES, STABLE
from loops.references import (
    ReferenceLoop,
    characteristic,
    de_hoog,
    parseval,
    polished_root,
    talbot,
    zeros_right_of,
)


def agree(value: mp.mpc, other: mp.mpc, digits: int = 25) -> bool:
    with mp.workdps(40):
        return bool(abs(value - other) <= mp.mpf(10) ** -digits * max(1, abs(other)))


@pytest.mark.parametrize("name", ["foptd-0.05", "foptd-1", "foptd-5", "foptd-50"])
def test_series_against_kummer_functions(name: str) -> None:
    r = PROBLEMS[name].reference
    for t in PROBLEMS[name].times:
        assert agree(r(t), pi_foptd(1, 1, r.dead_time, k=r.k, ki=r.ki, t=t))


def test_series_against_closed_forms_of_other_plants() -> None:
    unstable = ReferenceLoop((1.0,), (1.0, -1.0), 0.2, 2.5, 0.4)
    assert agree(unstable(4.3), pi_foptd(-1, -1, 0.2, k=2.5, ki=0.4, t=4.3))
    assert agree(ReferenceLoop((1.0,), (1.0, 0.0), 1.0, 0.35, 0.03)(9.7), pi_integrator(1, 1, 0.35, 0.03, 9.7))
    assert agree(ReferenceLoop((1.0,), (1.0, 1.0), 0.2, 2.5)(3.3), p_foptd(1, 1, 0.2, 2.5, 3.3))
    dead_time = ReferenceLoop((1.0,), (1.0,), 1.0, 0.2, 0.4)
    assert agree(dead_time(7.25), pi_dead_time(1, 0.2, 0.4, 7.25))
    for n in (1, 2, 3):
        jump = dead_time(n) - dead_time(n, left=True)
        assert agree(jump, (-1) ** (n - 1) * mp.mpf(0.2) ** n)


def test_series_against_textbook_polynomials() -> None:
    r = PROBLEMS["unstable-loop"].reference
    assert agree(r(1.5), 1)
    assert agree(r(2.5), 3 - mp.mpf(1) / 2)


def test_series_without_dead_time_against_matrix_exponential() -> None:
    r = ReferenceLoop((1.0,), (1.0, 3.0, 3.0, 1.0), 0.0, 0.625, 0.3125)
    for t in (0.4, 8.0):
        assert agree(r(t), rational_step([0.625, 0.3125], [1.0, 3.0, 3.0, 1.625, 0.3125], t))


@pytest.mark.parametrize("signal", ["y", "u", "load_y", "load_u"])
def test_series_against_de_hoog(signal: str) -> None:
    r = PROBLEMS["lag-8-dead-time"].reference
    assert agree(r(13.0, signal), de_hoog(r.transform(signal), 13.0))


@pytest.mark.parametrize("signal", ["y", "u", "load_y", "load_u"])
def test_branch_cut_against_de_hoog(signal: str) -> None:
    k, ki = ROOT_PI
    parts: dict[str, Callable[[mp.mpc], mp.mpc]] = {
        "y": lambda s: root_plant(s) * (k + ki / s),
        "u": lambda s: k + ki / s,
        "load_y": root_plant,
        "load_u": lambda s: -root_plant(s) * (k + ki / s),
    }
    value = de_hoog(lambda s: parts[signal](s) / (1 + root_plant(s) * (k + ki / s)) / s, 2.0)
    assert agree(root_plant_pi(signal, k, ki, 2.0, guesses=ROOT_POLES), value)


@pytest.mark.parametrize("degree", [40, 60, 120])
def test_talbot_is_that_of_mpmath_and_inverts_transforms_with_a_closed_form(degree: int) -> None:
    for t in (0.05, 6.0):
        value = talbot(lambda s: mp.exp(-mp.sqrt(s)) / s, t, degree)
        with mp.workdps(40):
            assert agree(value, mp.erfc(1 / (2 * mp.sqrt(mp.mpf(t)))), digits=min(degree // 2 - 3, 36))
            expected = mp.invertlaplace(lambda s: mp.exp(-mp.sqrt(s)) / s, t, method="talbot", degree=degree)
        assert agree(value, expected, digits=min(degree // 2, 36))


def test_first_wave_against_de_hoog() -> None:
    value = de_hoog(lambda s: root_plant(s) * (0.8 + mp.mpf(0.5) / s) / s, 0.7)
    assert agree(root_plant_first_wave(0.8, 0.5, 0.7), value, digits=16)


def test_lambert_w_poles_solve_their_equations() -> None:
    with mp.workdps(40):
        s = integrator_p_pole(1.0, 1.0, 0.5)
        assert abs(s + 0.5 * mp.exp(-s)) < 1e-35
        s = foptd_p_pole(1.0, 1.0, 0.3, 2.0)
        assert abs(s + 1 + 2 * mp.exp(-s * mp.mpf(0.3))) < 1e-35


def test_count_of_zeros_steps_at_the_rightmost_pole() -> None:
    for r, pole in (
        (ReferenceLoop((1.0,), (1.0, 0.0), 1.0, 0.5), integrator_p_pole(1.0, 1.0, 0.5)),
        (ReferenceLoop((1.0,), (1.0, 1.0), 0.3, 2.0), foptd_p_pole(1.0, 1.0, 0.3, 2.0)),
    ):
        function, abscissa = characteristic(r), float(pole.real)
        assert zeros_right_of(function, abscissa + 1e-3) == 0
        assert zeros_right_of(function, abscissa - 1e-3) == 2
    assert zeros_right_of(characteristic(PROBLEMS["unstable-loop"].reference), 0.0) == 2
    root = polished_root(characteristic(PROBLEMS["foptd-1"].reference), -0.6 + 0.3j)
    assert abs(characteristic(PROBLEMS["foptd-1"].reference)(root)) < 1e-30


@pytest.mark.parametrize("name", STABLE)
def test_problems_are_stable(name: str) -> None:
    # -1e-9: the problem has no pole in the closed right half plane
    assert zeros_right_of(characteristic(PROBLEMS[name].reference), -1e-9) == 0


def test_squared_errors_against_quadrature_and_closed_form() -> None:
    loop = PROBLEMS["foptd-1"].reference
    value = foptd_load_ise(1.0, 1.0, 1.0, loop.k, loop.ki)
    # |Y|^2 falls like w^-4: the tail beyond 200 is below 1/(3 pi 200^3) = 1.4e-8
    quadrature = parseval(loop.transform("load_y"), [1e-30, *np.arange(1, 40) * 1.6, 200])
    assert 0 < value - quadrature < 1.5e-8
    small = integrator_p_ise(1.0, 1e-12, 0.5)
    assert abs(small - 1) < 1e-11  # without dead time the error is e^{-t/2}, its square integrates to 1


def test_squared_error_of_the_integrator() -> None:
    # the error is a polynomial on each interval, which eight Gauss nodes integrate well; nothing is left of
    # it after t = 30, since the slowest mode is e^{-0.79 t}
    nodes, weights = np.polynomial.legendre.leggauss(8)
    squares = 0.0
    for start in range(30):
        for x, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
            squares += weight * float(1 - pi_integrator(1.0, 1.0, 0.5, 0.0, start + x)) ** 2
    assert squares == pytest.approx(float(integrator_p_ise(1.0, 1.0, 0.5)), rel=1e-13)

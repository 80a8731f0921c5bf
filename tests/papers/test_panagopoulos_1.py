"""Paper I of Panagopoulos' thesis against mpmath, sympy, scipy and closed forms, which share no code with it.

`design_pi` itself is tested in ``tests/loops/test_design_pi.py``.
"""

from __future__ import annotations

import csv
import importlib
import math
from collections.abc import Callable
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp

from replicate.exhibits import Table
from replicate.loops import Circle
from replicate.papers.panagopoulos import paper, part_1
from replicate.papers.panagopoulos.part_1 import corner, errata, settling, simple_models, table_1, table_4
from replicate.papers.panagopoulos.part_1.designs import SIX, complementary_peak, design, load_response, loop, weight
from replicate.papers.panagopoulos.part_1.example_8 import true_sigma
from replicate.papers.panagopoulos.part_1.frequency_grid import peak_on_grid, weight_on_grid
from replicate.papers.panagopoulos.part_1.phase import frequencies_of_lag, roots_of_h
from replicate.papers.panagopoulos.part_1.plants import PLANTS

# the plants as the paper prints them, for mpmath and numpy numbers
FORMULAS: dict[str, Callable[[mp.mpc], mp.mpc]] = {
    "G1": lambda s: 1 / (s + 1) ** 3,
    "G2": lambda s: 1 / ((s + 1) * (1 + 0.2 * s) * (1 + 0.04 * s) * (1 + 0.008 * s)),
    "G3": lambda s: mp.exp(-15 * s) / (s + 1) ** 3,
    "G4": lambda s: 1 / (s * (s + 1) ** 2),
    "G5": lambda s: (1 - 2 * s) / (s + 1) ** 3,
    "G6": lambda s: 9 / ((s + 1) * (s**2 + 2 * s + 9)),
    "G7": lambda s: mp.exp(-s),
    "G8": lambda s: mp.exp(-s) / s,
    "G9": lambda s: mp.exp(-mp.sqrt(s)),
    "G10": lambda s: 100 / (s + 10) ** 2 * (1 / (s + 1) + mp.mpf("0.5") / (s + mp.mpf("0.05"))),
    "G11": lambda s: 150 / ((s + 10) ** 2 * (s + 1)),
    "G12 a=0.2": lambda s: 9 / ((s + 1) * (s**2 + mp.mpf("0.2") * s + 9)),
    "G13": lambda s: (s + 6) ** 2 / (s * (s + 1) ** 2 * (s + 36)),
    "G14 a=4": lambda s: 4 / ((s + 4) * (s - 1)),
}


@pytest.fixture(scope="module")
def exhibits() -> dict[str, Table]:
    for module in part_1.MODULES:
        importlib.import_module(f"{part_1.__name__}.{module}")
    return {id: exhibit for id, exhibit in paper.exhibits.items() if isinstance(exhibit, Table)}


def printed(exhibit: str) -> dict[tuple[str, str], str]:
    text = (paper.folder() / "printed" / f"{exhibit}.csv").read_text(encoding="utf-8")
    return {(row["row"], column): row[column] for row in csv.DictReader(text.splitlines()) for column in row}


# ------------------------------------------------------------------------------------------------------- plants


@pytest.mark.parametrize("name", FORMULAS)
def test_the_plants_are_those_of_the_paper(name: str) -> None:
    for s in (0.3 + 0.7j, 2j, 0.01j, 1.5 - 4j):
        assert complex(PLANTS[name](s)) == pytest.approx(complex(FORMULAS[name](mp.mpc(s))), rel=1e-13)


# ------------------------------------------------------------------------------------------------------ designs


def envelope_conditions(
    g: Callable[[mp.mpc], mp.mpc], center: float, radius: mp.mpf
) -> Callable[[mp.mpf, mp.mpf, mp.mpf], tuple[mp.mpf, mp.mpf, mp.mpf]]:
    """(14): f = R^2, df/dw = 0, df/dk = 0, by numerical differentiation at 30 digits."""

    def f(k: mp.mpf, ki: mp.mpf, w: mp.mpf) -> mp.mpf:
        return abs(center + (k - 1j * ki / w) * g(1j * w)) ** 2

    return lambda k, ki, w: (
        f(k, ki, w) - radius**2,
        mp.diff(lambda x: f(k, ki, x), w),
        mp.diff(lambda x: f(x, ki, w), k),
    )


@pytest.mark.parametrize("name", ["G1", "G2", "G3", "G4", "G5", "G6", "G7", "G8", "G9", "G10", "G11", "G13", "G14 a=4"])
def test_a_smooth_design_satisfies_the_three_equations(name: str) -> None:
    found = design(name, 2.0)
    with mp.workdps(30):
        start = [mp.mpf(x) for x in (found.k, found.ki, found.frequency)]
        root = mp.findroot(envelope_conditions(FORMULAS[name], 1, mp.mpf("0.5")), start, tol=1e-40)
    assert [found.k, found.ki, found.frequency] == pytest.approx([float(x) for x in root], rel=1e-9)


def test_the_integrating_plant_has_a_closed_form() -> None:
    # G4: k and ki of (17) at w0 with tan(phi) known; w0^2 = 1/6 for Ms = 2 and 1/12 for Ms = 1.4
    for ms, w_squared in ((2.0, 1 / 6), (1.4, 1 / 12)):
        found = design("G4", ms)
        w = math.sqrt(w_squared)
        r, phi = 1 / (w * (1 + w_squared)), -math.pi / 2 - 2 * math.atan(w)
        assert found.frequency == pytest.approx(w, rel=1e-12)
        assert found.k == pytest.approx(-math.cos(phi) / r, rel=1e-12)
        assert found.ki == pytest.approx(-w / r * (math.sin(phi) + 1 / ms), rel=1e-11)


def test_setpoint_weights_make_the_gain_one_at_their_frequency() -> None:
    for name in ("G1", "G2", "G4"):
        found = design(name, 2.0)
        peak = complementary_peak(name, 2.0)
        for rule, w in (("w_mp", peak.frequency), ("w_0", found.frequency)):
            b = weight(name, 2.0, rule)
            prefilter = abs(found.ki + 1j * w * b * found.k) / abs(found.ki + 1j * w * found.k)
            assert prefilter * peak.value == pytest.approx(1.0, abs=1e-12)  # (24) with |T| = Mp


def test_the_printed_frequencies_are_the_largest_sensitivities_on_a_grid() -> None:
    numbers = printed("I-table-1")
    ranges = {"G1": (-2, 1), "G2": (-1, 2), "G4": (-3, 0), "G5": (-2, 1), "G6": (-1, 2)}
    for name, ends in ranges.items():
        for ms in (1.4, 1.6, 1.8, 2.0):
            found = design(name, ms)
            w = np.logspace(*ends, 200)
            s = 1j * w
            value = np.array([complex(FORMULAS[name](x)) for x in s]) * (found.k + found.ki / s)
            best = w[np.argmin(np.abs(1 + value))]
            row = f"{name} Ms={ms}"
            assert peak_on_grid(name, ms) == pytest.approx(best, rel=1e-12)
            assert f"{best:.2f}" == numbers[row, "w0"]
            assert f"{weight_on_grid(name, ms):.2f}" == numbers[row, "b"]


# -------------------------------------------------------------------------------------------------------- phase


def test_frequencies_of_lag_have_closed_forms() -> None:
    assert frequencies_of_lag(PLANTS["G1"], 180.0) == pytest.approx((math.sqrt(3.0),), rel=1e-12)
    assert frequencies_of_lag(PLANTS["G7"], 90.0) == pytest.approx((math.pi / 2,), rel=1e-12)
    assert frequencies_of_lag(PLANTS["G8"], 90.0) == (0.0,)
    assert frequencies_of_lag(PLANTS["G8"], 180.0) == pytest.approx((math.pi / 2,), rel=1e-12)
    # sqrt(w/2) = pi/2, pi
    assert frequencies_of_lag(PLANTS["G9"], 90.0) == pytest.approx((math.pi**2 / 2,), rel=1e-12)
    assert frequencies_of_lag(PLANTS["G9"], 180.0) == pytest.approx((2 * math.pi**2,), rel=1e-12)
    w = sp.symbols("w", positive=True)
    s = sp.I * w
    # G13 is real where the imaginary part of num * conj(den) vanishes
    crossing = sp.im(sp.expand((s + 6) ** 2 * sp.conjugate(s * (s + 1) ** 2 * (s + 36)))) / w
    roots = sorted(float(r) for r in sp.Poly(sp.expand(crossing), w).nroots() if r.is_real and r > 0)
    assert frequencies_of_lag(PLANTS["G13"], 180.0) == pytest.approx(tuple(roots), rel=1e-10)


def test_h_vanishes_at_its_roots() -> None:
    with mp.workdps(30):
        g = FORMULAS["G3"]
        for w in roots_of_h(PLANTS["G3"], Circle.of(2.0)):
            # h (18) from r and phi by numerical differentiation
            r, phase = mp.mpf(abs(g(1j * w))), mp.arg(g(1j * mp.mpf(w)))
            log_slope = mp.diff(lambda x: mp.log(abs(g(1j * x))), w)
            turned_back = mp.exp(-1j * phase)  # so that the argument does not jump at w
            phase_slope = mp.diff(lambda x, turn=turned_back: mp.arg(g(1j * x) * turn), w)
            half = mp.mpf("0.5")
            h = (half + mp.sin(phase)) * (log_slope - 1 / mp.mpf(w)) - phase_slope * mp.cos(phase)
            assert abs(h) < 1e-9
            assert r > 0


# ------------------------------------------------------------------------------------------------------- errata


def test_equation_7_by_geometry() -> None:
    ms, mpx = sp.symbols("Ms Mp", positive=True)
    center, radius = errata.corrected_circle(ms, mpx)
    assert sp.simplify(center + radius - mpx / (mpx - 1)) == 0  # far end of the Mp circle
    assert sp.simplify(center - radius - (ms - 1) / ms) == 0  # near end of the Ms circle
    article, same = errata.printed_circle(ms, mpx)
    assert sp.simplify(article + center) == 0
    assert sp.simplify(same - radius) == 0


def test_the_two_circles_are_where_the_sensitivities_have_their_bounds() -> None:
    for bound, circle in (
        (Fraction(7, 5), errata.sensitivity_circle),
        (Fraction(3, 2), errata.complementary_circle),
    ):
        center, radius = (float(part) for part in circle(bound))
        for angle in (0.3, 1.7, 4.0):
            value = -center + radius * np.exp(1j * angle)
            magnitude = abs(1 / (1 + value)) if circle is errata.sensitivity_circle else abs(value / (1 + value))
            assert magnitude == pytest.approx(float(bound), rel=1e-12)


# ---------------------------------------------------------------------------------------------------- example 5


def resonant(a: mp.mpf, s: mp.mpc) -> mp.mpc:
    return 9 / ((s + 1) * (s**2 + a * s + 9))


def test_the_corner_limit_is_where_the_smooth_optimum_touches_twice() -> None:
    ms = 2.0

    def conditions(a: mp.mpf, k: mp.mpf, ki: mp.mpf, w: mp.mpf, w2: mp.mpf) -> tuple[mp.mpf, ...]:
        def f(x: mp.mpf, gain: mp.mpf = k) -> mp.mpf:
            return abs(1 + (gain - 1j * ki / x) * resonant(a, 1j * x)) ** 2

        return (
            f(w) - mp.mpf(1) / ms**2,
            mp.diff(f, w),
            mp.diff(lambda gain: f(w, gain), k),
            f(w2) - mp.mpf(1) / ms**2,
            mp.diff(f, w2),
        )

    with mp.workdps(30):
        start = [mp.mpf(x) for x in ("1.13", "0.137", "1.413", "2.19", "1.74")]
        root = mp.findroot(conditions, start, tol=1e-35)
    assert corner.corner_limit(ms) == pytest.approx(float(root[0]), rel=1e-9)


def test_the_slope_limit_is_where_the_steepest_slope_is_one() -> None:
    a, x = sp.symbols("a x", positive=True)  # x = w^2
    magnitude = 81 / ((1 + x) * ((9 - x) ** 2 + a**2 * x))  # |G|^2
    slope = x * sp.diff(sp.log(magnitude), x)  # d log|G| / d log w
    equations = sp.lambdify((a, x), (slope - 1, sp.diff(slope, x)), "mpmath")
    with mp.workdps(30):
        root = mp.findroot(equations, (mp.mpf("1.07"), mp.mpf(7)), tol=1e-40)
    assert corner.slope_limit() == pytest.approx(float(root[0]), rel=1e-10)


def test_the_curvature_limit_is_where_the_second_derivative_vanishes() -> None:
    def conditions(a: mp.mpf, k: mp.mpf, ki: mp.mpf, w: mp.mpf) -> tuple[mp.mpf, ...]:
        def f(x: mp.mpf, gain: mp.mpf = k) -> mp.mpf:
            return abs(1 + (gain - 1j * ki / x) * resonant(a, 1j * x)) ** 2

        return f(w) - mp.mpf("0.25"), mp.diff(f, w), mp.diff(lambda gain: f(w, gain), k), mp.diff(f, w, 2)

    with mp.workdps(40):
        start = [mp.mpf(x) for x in ("0.79", "-0.02", "1.33", "2.22")]
        root = mp.findroot(conditions, start, tol=1e-40)
    assert corner.curvature_limit(2.0) == pytest.approx(float(root[0]), rel=1e-9)


# -------------------------------------------------------------------------------------------- responses, noise


@pytest.mark.parametrize("name", ["G1", "G6"])
def test_load_responses_against_an_ode_solver(name: str) -> None:
    found = design(name, 2.0)
    plant = PLANTS[name]
    a, b, c, d = plant.state_space()
    n = len(b)

    def slope(_: float, x: NDArray[np.float64]) -> NDArray[np.float64]:
        y = c @ x[:n]
        u = -found.k * y + x[n] + 1.0
        return np.concatenate([a @ x[:n] + b * u, [-found.ki * y], [abs(y)]])

    crossing = lambda _, x: c @ x[:n] - 0.05  # noqa: E731
    solution = solve_ivp(
        slope, (0.0, 150.0), np.zeros(n + 2), method="DOP853", rtol=1e-11, atol=1e-13, events=crossing, max_step=0.05
    )
    response = load_response(name, 2.0)
    assert d == 0.0
    assert solution.t_events is not None
    assert settling.one_sided(response) == pytest.approx(solution.t_events[0][-1], rel=1e-8)
    assert response.iae() == pytest.approx(solution.y[-1, -1], rel=1e-7)
    assert response.ie() == pytest.approx(1.0 / found.ki, rel=1e-10)


@pytest.mark.parametrize("name", ["m=2", "m=20"])
def test_noise_variance(name: str) -> None:
    case = table_4.filtered(table_4.FACTORS[name])
    k, ki, tf, a = case.found.k, case.found.ki, case.filter_time, table_4.NOISE_CORNER

    def density(w: float, with_loop: bool) -> float:
        s = 1j * w
        value = (k * s + ki) / ((s + a) * (1 + s * tf))
        loop_gain = (k + ki / s) * np.exp(-s) / (1 + s * tf)
        return abs(value / (1 + loop_gain if with_loop else 1)) ** 2

    def variance(with_loop: bool) -> float:
        panels = np.arange(0.0, 2000.0, 5.0)
        inner = sum(quad(density, x, x + 5.0, args=(with_loop,), epsabs=0, epsrel=1e-11)[0] for x in panels)
        # beyond 2000 |S| is 1 up to oscillations of size k/(tf w), which average out
        tail = quad(density, 2000.0, np.inf, args=(False,))[0]
        return (inner + tail) / math.pi

    assert case.sigma == pytest.approx(table_4.MS * math.sqrt(variance(with_loop=False)), rel=1e-8)
    assert true_sigma(case) == pytest.approx(math.sqrt(variance(with_loop=True)), rel=1e-6)


# ------------------------------------------------------------------------------------------------- comparison


def test_simple_models_have_closed_forms() -> None:
    # step response of 1/(s+1)^3: y = 1 - e^{-t}(1 + t + t^2/2)
    with mp.workdps(30):
        area = mp.quad(lambda t: 1 - mp.exp(-t) * (1 + t + t**2 / 2), [0, 3])
    model = simple_models.area_method("G1")
    assert model.time_constant == pytest.approx(float(mp.e * area), rel=1e-10)
    assert model.time_constant + model.dead_time == pytest.approx(3.0, rel=1e-12)
    delayed = simple_models.area_method("G3")
    assert delayed.time_constant == pytest.approx(model.time_constant, rel=1e-9)
    assert delayed.dead_time == pytest.approx(model.dead_time + 15.0, rel=1e-10)
    # the tangent at the inflexion, t = 2: slope 2 e^{-2}, height 1 - 5 e^{-2}
    for plant in ("G1", "G2", "G3"):  # mean and variance of the impulse response
        with mp.workdps(30):
            _, slope, half_curvature = mp.taylor(lambda s, g=FORMULAS[plant]: mp.log(g(s)), 0, 2)
            time_constant = mp.sqrt(2 * half_curvature)
        model = simple_models.moments(plant)
        assert model.time_constant == pytest.approx(float(time_constant), rel=1e-9)
        assert model.dead_time == pytest.approx(float(-slope - time_constant), rel=1e-9)
    tangent = simple_models.tangent("G1")
    assert tangent.time_constant == pytest.approx(math.exp(2.0) / 2.0, rel=1e-10)
    assert tangent.dead_time == pytest.approx(2.0 - (1 - 5 * math.exp(-2.0)) * math.exp(2.0) / 2.0, rel=1e-9)


def test_ultimate_points() -> None:
    gain, period = simple_models.ultimate_point("G1")
    assert gain == pytest.approx(8.0, rel=1e-12)
    assert period == pytest.approx(2 * math.pi / math.sqrt(3.0), rel=1e-12)
    with mp.workdps(30):  # 15 w + 3 atan w = pi
        w = mp.findroot(lambda x: 15 * x + 3 * mp.atan(x) - mp.pi, 0.17)
        gain, period = simple_models.ultimate_point("G3")
        assert gain == pytest.approx(float((1 + w**2) ** mp.mpf("1.5")), rel=1e-12)
        assert period == pytest.approx(float(2 * mp.pi / w), rel=1e-12)


# ---------------------------------------------------------------------------------------------------- inventory


def test_keys_and_inventory(exhibits: dict[str, Table]) -> None:
    for id in part_1.NUMBERED:
        assert id in paper.exhibits
    assert exhibits["I-table-1"].rows == tuple(f"{p} Ms={ms}" for p in SIX for ms in ("1.4", "1.6", "1.8", "2.0"))
    assert exhibits["I-table-4"].rows == ("m=2", "m=5", "m=10", "m=20", "m=inf")
    assert exhibits["I-table-5"].rows[:3] == ("G1 ZN", "G1 Lambda", "G1 New")


def test_every_design_keeps_its_bound_between_the_tangencies() -> None:
    w = np.geomspace(1e-3, 1e3, 40001)
    for name in SIX:
        for ms in (1.4, 2.0):
            value = loop(name, ms)(1j * w)
            assert np.abs(1 + value).min() >= 1 / ms - 1e-9


@pytest.mark.parametrize(
    ("row", "k", "ti", "ie"),  # as Table 1 prints them
    [
        ("G3 Ms=2.0", "0.266", "5.51", "20.8"),
        ("G5 Ms=1.4", "0.179", "1.78", "9.90"),
        ("G6 Ms=1.6", "0.387", "0.344", "0.891"),
    ],
)
def test_the_integrated_error_is_within_the_rounding_of_the_gains(row: str, k: str, ti: str, ie: str) -> None:
    """IE = Ti/k rises with Ti and falls with k, so its range has its ends at two corners."""

    def ends(text: str) -> tuple[Fraction, Fraction]:
        half = Fraction(5, 10 ** (len(text.split(".")[1]) + 1))
        return Fraction(text) - half, Fraction(text) + half

    (k_low, k_high), (ti_low, ti_high), (low, high) = ends(k), ends(ti), ends(ie)
    assert ti_low / k_high < high
    assert low < ti_high / k_low
    for gains in ((k_low, ti_high), (k_high, ti_low)):
        found = table_1.from_print(row, {"k": float(gains[0]), "Ti": float(gains[1])})
        assert found["IE"] == pytest.approx(float(gains[1] / gains[0]), rel=1e-12)


def test_table_4_prints_errors_that_its_integral_gains_do_not_allow() -> None:
    for ki, ie in (("0.78", "1.26"), ("0.81", "1.21"), ("0.83", "1.17"), ("0.85", "1.12")):
        assert 1 / (Fraction(ki) + Fraction(5, 1000)) > Fraction(ie) + Fraction(5, 1000)

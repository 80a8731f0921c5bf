"""Krajewski, Lepschy, Viaro: the numbers in mpmath, the design and its robustness on changed loops."""

from __future__ import annotations

import cmath
import math

import mpmath as mp
import numpy as np
import pytest
from loops.references import ReferenceLoop
from scipy.optimize import brentq

from replicate.exhibits import Table
from replicate.loops import Loop, Plant
from replicate.papers.krajewski import claims_robustness, paper
from replicate.papers.krajewski.design import design, first_order_parameters
from replicate.papers.krajewski.loci import (
    corners,
    upper_end,
)
from replicate.papers.krajewski.modal_models import modes
from replicate.papers.krajewski.normalised_loop import (
    crossover,
    phase_margin,
    point,
)
from replicate.papers.krajewski.points import named_points
from replicate.papers.krajewski.points import response as step_response
from replicate.papers.krajewski.robustness import VERTICES, at_vertices, designs, worst_in_box
from replicate.papers.krajewski.table_1 import MARGINS, hyperbola_fit, upper_ends
from replicate.papers.krajewski.table_1_errors import residuals, sign_changes

RANDOM = np.random.default_rng(69)


@pytest.fixture(scope="module")
def exhibits() -> dict[str, Table]:
    return {id: exhibit for id, exhibit in paper.load().exhibits.items() if isinstance(exhibit, Table)}


# ---------------------------------------------------------------------------------------------- the numbers


def test_upper_ends_and_table_1_in_mpmath(exhibits: dict[str, Table]) -> None:
    frame = exhibits["table-1"].readings["as-written"].compute()
    with mp.workdps(30):
        for margin in MARGINS:
            m = mp.radians(mp.mpf(margin))
            ends = []
            for k in range(1, 11):
                tau = mp.mpf(k) / 10
                # On the b axis, where a = 0: tan(τω + m) = -ω, on the branch below π.
                w = mp.findroot(lambda w, tau=tau, m=m: tau * w + m + mp.atan(w) - mp.pi, (mp.pi - m) / (1 + tau))
                ends.append(mp.sqrt(1 + w * w))
                assert upper_end(k / 10, float(margin)) == pytest.approx(float(ends[-1]), rel=1e-14)
            x = [mp.mpf(10) / k for k in range(1, 11)]
            mean_x, mean_y = mp.fsum(x) / 10, mp.fsum(ends) / 10
            mu = mp.fsum((u - mean_x) * v for u, v in zip(x, ends, strict=True)) / mp.fsum((u - mean_x) ** 2 for u in x)
            assert frame.loc["mu", margin] == pytest.approx(float(mu), rel=1e-12)
            assert frame.loc["nu", margin] == pytest.approx(float(mean_y - mu * mean_x), rel=1e-12)


def test_weighted_fits_change_sign_twice_and_the_printed_column_does_not() -> None:
    x = 10.0 / np.arange(1, 11)
    for margin in MARGINS:
        for _ in range(20):
            weight = np.sqrt(RANDOM.uniform(0.01, 1.0, 10))
            ends = upper_ends(margin)
            fit = np.polynomial.polynomial.polyfit(x, ends, 1, w=weight)
            assert sign_changes(fit[0] + fit[1] * x - ends) >= 2
    assert sign_changes(residuals("45")) < 2
    assert hyperbola_fit(2.0 * x + 3.0) == pytest.approx((2.0, 3.0), rel=1e-13)


@pytest.mark.parametrize("figure", ["fig-8", "fig-11"])
def test_corners_in_mpmath(exhibits: dict[str, Table], figure: str) -> None:
    frame = exhibits[f"{figure}-values"].readings["exact-point"].compute()
    starts = {"upper": (1.0, 0.9, 0.96, 2.6), "lower": (0.2, -0.2, 0.2, 0.6), "a": (1.0, 0.9, 0.96, 2.6)}

    def g(a: mp.mpf, b: mp.mpf, w: mp.mpf) -> mp.mpc:
        s = 1j * w
        return (a + b * s) / s * mp.exp(-s / 2) / (1 + s)

    def equations(a: mp.mpf, b: mp.mpf, wa: mp.mpf, wb: mp.mpf) -> list[mp.mpf]:
        first = g(a, b, wa) + mp.expj(mp.pi / 3)  # (9) with 60 degrees
        second = g(a, b, wb) + mp.mpf(3) / 10  # (27)
        return [mp.re(first), mp.im(first), mp.re(second), mp.im(second)]

    with mp.workdps(30):
        for row in ("upper", "lower") if figure == "fig-8" else ("a",):
            a, b, wa, _ = mp.findroot(equations, starts[row])
            found = [frame[column][row] for column in ("a", "b", "omega_A")]
            assert found == pytest.approx([float(a), float(b), float(wa)], rel=1e-11)
    assert len(corners(0.5, 60.0, 0.1)) == 0


def test_points_of_figures_9_and_10(exhibits: dict[str, Table]) -> None:
    # Rotating (9) by the lag: (a + jωb) = jω(1 + jω) exp(j(τω + m - π)).
    for figure, w, margins in (("fig-9", 2.0, (45.0,)), ("fig-10", 1.5, (45.0, 60.0, 75.0))):
        frame = exhibits[f"{figure}-values"].readings["as-written"].compute()
        for row, margin in zip("abc", margins, strict=False):
            z = 1j * w * (1 + 1j * w) * cmath.exp(1j * (0.5 * w + math.radians(margin) - math.pi))
            assert [frame["a"][row], frame["b"][row]] == pytest.approx([z.real, z.imag / w], rel=1e-12)


@pytest.mark.parametrize("figure", ["fig-9", "fig-10", "fig-11", "fig-12"])
def test_step_metrics_against_the_dead_time_series(exhibits: dict[str, Table], figure: str) -> None:
    frame = exhibits[f"{figure}-values"].readings["as-written"].compute()
    for row, named in named_points(figure).items():
        reference = ReferenceLoop(num=(1.0,), den=(1.0, 1.0), dead_time=0.5, k=named.b, ki=named.a)
        half = frame["delay_time"][row]
        assert float(reference(half)) == pytest.approx(0.5, abs=1e-10)
        settled = frame["settling_time"][row]
        if settled < 20.0:  # the series has a term for every dead time
            assert abs(float(reference(settled)) - 1.0) == pytest.approx(0.02, abs=1e-9)
        overshoot = frame["overshoot"][row]
        if overshoot > 1e-3:
            top = step_response(named.a, named.b).peak().time
            assert float(reference(top)) == pytest.approx(1.0 + overshoot, abs=1e-9)
            assert max(float(reference(t)) for t in (top - 0.1, top - 0.01, top + 0.01, top + 0.1)) < 1.0 + overshoot


def test_modes_are_poles_with_the_residues_of_a_small_circle() -> None:
    for figure, row in (("fig-9", "a"), ("fig-10", "b"), ("fig-12", "c")):
        named = named_points(figure)[row]
        for p, residue in modes(named.a, named.b, 3):
            z = p + 1e-2 * np.exp(2j * np.pi * np.arange(64) / 64)
            loop = (named.a + named.b * z) / z * np.exp(-0.5 * z) / (1 + z)
            integral = np.mean(loop / (1 + loop) / z * (z - p))
            assert residue == pytest.approx((2 if p.imag else 1) * integral, abs=1e-10)


def test_figure_1_counts_agree(exhibits: dict[str, Table]) -> None:
    frame = exhibits["fig-1-values"].readings["as-written"].compute()
    assert (frame["encirclements"] == frame["unstable_poles"]).all()
    assert set(frame["initial_quadrant"]) == {1, 2, 3, 4}
    # Another count: zeros of s(1 + s) + (a + bs)exp(-s/2) in a large half disc, by the argument principle.
    for a, b, unstable in frame[["a", "b", "unstable_poles"]].to_numpy():
        arc = 40.0 * np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 20_001))
        z = np.concatenate([arc, 1j * np.linspace(40.0, -40.0, 40_001)])
        f = z * (1 + z) + (a + b * z) * np.exp(-0.5 * z)
        angle = np.unwrap(np.angle(f))
        assert round((angle[-1] - angle[0]) / (2 * np.pi)) == unstable


# ---------------------------------------------------------------------------------- design and robustness


def test_the_design_meets_its_specifications() -> None:
    for _ in range(20):
        K, T, tau = RANDOM.uniform(0.2, 5.0), RANDOM.uniform(0.1, 50.0), RANDOM.uniform(0.1, 1.0)
        plant = Plant.foptd(K, T, tau * T)
        margin = RANDOM.uniform(30.0, 110.0)
        w = RANDOM.uniform(0.05, 0.99) * design(plant, margin, 0.1 / T).highest_crossover
        found = design(plant, margin, w)
        s = 1j * w
        at = (found.k_p + found.k_i / s) * K * cmath.exp(-tau * T * s) / (1 + T * s)
        assert found.compatible
        assert at == pytest.approx(cmath.rect(1.0, math.radians(margin) - math.pi), abs=1e-12)
        assert found.t_i == pytest.approx(found.k_p / found.k_i, rel=1e-12)
        assert Loop(plant, found.controller()).is_stable()
        assert found.largest_phase_margin > margin


def test_incompatible_specifications_are_told_and_what_would_do() -> None:
    plant = Plant.foptd(2.0, 10.0, 5.0)
    found = design(plant, 75.0, 0.2)
    assert not found.compatible
    assert math.isnan(found.k_p)
    assert "below 0.1626" in found.message
    with pytest.raises(ValueError, match="not compatible"):
        found.controller()
    assert design(plant, found.largest_phase_margin - 1e-9, 0.2).compatible
    assert design(plant, 75.0, found.highest_crossover * (1 - 1e-12)).compatible
    for wrong, said in ((Plant([1.0], [1.0, 2.0, 1.0], 1.0), "first-order"), (Plant.foptd(-1.0, 1.0, 1.0), "positive")):
        with pytest.raises(ValueError, match=said):
            first_order_parameters(wrong)
    with pytest.raises(ValueError, match="crossover frequency must be positive"):
        design(plant, 60.0, 0.0)
    with pytest.raises(ValueError, match="less than 180"):
        design(plant, 180.0, 0.1)


def test_margins_over_the_box_from_the_changed_loops() -> None:
    names = list(VERTICES)
    for index in RANDOM.integers(len(designs()), size=6):
        a, b, tau = designs()[index]
        found = at_vertices((a, b, tau), 20)
        for name in ("KM-LM-Tm", "KM-LM-TM", "Km-Lm-TM"):
            K, L, T = (1.2 if letter == "M" else 0.8 for letter in (name[1], name[4], name[7]))

            def loop_at(
                w: float, K: float = K, L: float = L, T: float = T, a: float = a, b: float = b, tau: float = tau
            ) -> complex:
                s = 1j * w
                return (b + a / s) * K * cmath.exp(-tau * L * s) / (1 + T * s)

            w = brentq(lambda w: abs(loop_at(w)) - 1.0, 1e-7, 100.0, xtol=1e-14)
            margin = math.degrees(cmath.phase(-loop_at(w)))  # within half a turn of -1
            assert float(found.phase_margin[names.index(name)]) == pytest.approx(margin, abs=1e-6)
            assert float(found.crossover[names.index(name)]) == pytest.approx(w, rel=1e-9)


def test_which_time_constant_is_worse_on_the_bisector() -> None:
    # For b = a and small deviations the shorter T is worse exactly if τω² > 1.
    for tau in (0.2, 0.5, 1.0):
        for square in (0.9, 1.1):
            w = math.sqrt(square / tau)
            margins = at_vertices((w, w, tau), 1e-3).phase_margin
            shorter, longer = (margins[list(VERTICES).index(name)] for name in ("KM-LM-Tm", "KM-LM-TM"))
            assert (shorter < longer) == (square > 1.0)


def test_no_point_of_the_box_is_worse_than_the_worst_in_the_box() -> None:
    for index in RANDOM.integers(len(designs()), size=4):
        a, b, tau = designs()[index]
        worst = worst_in_box((a, b, tau), 30)
        K, L, T = RANDOM.uniform(0.7, 1.3, (3, 2000))
        margins = phase_margin(a * K * T, b * K, tau * L / T)
        assert worst <= float(margins.min()) + 1e-9
        assert worst <= float(at_vertices((a, b, tau), 30).phase_margin.min()) + 1e-9


def test_small_crossovers_do_not_lose_digits() -> None:
    # a -> 0 with |b| < 1: ω ≈ a/√(1 - b²), where the quadratic formula would cancel.
    with mp.workdps(40):
        a, b = mp.mpf("1e-9"), mp.mpf("0.5")
        half = (b * b - 1) / 2
        expected = mp.sqrt(half + mp.sqrt(half * half + a * a))
    assert float(crossover(1e-9, 0.5)) == pytest.approx(float(expected), rel=1e-14)
    x, y = point(0.5, 0.7, 50.0)
    assert float(crossover(x, y)) == pytest.approx(0.7, rel=1e-14)


def test_the_corner_of_figure_8_has_one_definition_and_its_overbar_wherever_it_is_printed() -> None:
    corner = [named_points("fig-8")["upper"], named_points("fig-11")["a"], named_points("fig-12")["a"]]
    assert len({(named.a, named.b, named.exact()) for named in corner}) == 1
    cells = [paper.printed_cells(f"{named.exhibit}-values")[named.row, "b"] for named in corner]
    assert cells == ["0.91[6]"] * 3


def test_deviations_of_a_changed_process() -> None:
    """Phase margin and crossover of K e^{-Ls}/(1 + Ts) with its controller, from |L| = 1 alone."""

    def margins(gain: float, lag: float, dead_time: float) -> tuple[float, float]:
        a, b = 1.1023, 2.1671  # Fig. 9 (a): K_I and K_P for K = T = 1

        def open_loop(w: float) -> complex:
            s = 1j * w
            return (b + a / s) * gain * cmath.exp(-dead_time * s) / (1.0 + lag * s)

        w = brentq(lambda w: abs(open_loop(w)) - 1.0, 0.1, 20.0, xtol=1e-15)
        return 180.0 + math.degrees(cmath.phase(open_loop(w))), w

    old, new = margins(1.0, 1.0, 0.5), margins(1.2, 1.1, 0.45)
    assert claims_robustness.eq_25().value == pytest.approx(new[0] - old[0], abs=1e-9)
    assert claims_robustness.eq_26().value == pytest.approx(new[1] - old[1], abs=1e-9)

"""Krajewski, Lepschy, Viaro: the charts by perturbing the loops on them."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from functools import cache
from typing import cast

import numpy as np
import pandas as pd
import pytest
from matplotlib.bezier import BezierSegment
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray
from scipy.optimize import brentq

from replicate.exhibits import Figure
from replicate.figures import capture
from replicate.figures.off_screen import curves_frame
from replicate.loops import PI, Loop, Plant
from replicate.papers.krajewski import paper
from replicate.papers.krajewski.chart_values import TAUS
from replicate.papers.krajewski.combined_chart import combined_chart
from replicate.papers.krajewski.drawing import bezier_path
from replicate.papers.krajewski.loci import (
    constant_crossover,
    constant_gain_ratio,
    constant_phase_crossover,
    constant_phase_margin,
)
from replicate.papers.krajewski.normalised_loop import (
    crossover,
    gain_ratio,
    phase_crossover,
    phase_margin,
)
from replicate.papers.krajewski.sensitivity_locus import constant_sensitivity, sensitivity_points

RANDOM = np.random.default_rng(69)


def pole(a: float, b: float, tau: float, gain: float = 1.0, extra_dead_time: float = 0.0) -> complex:
    """The rightmost pole of the loop (6) with more gain or more dead time, found without any frequency response."""
    plant = Plant([gain], [1.0, 1.0], dead_time=tau + extra_dead_time)
    return Loop(plant, PI(k=b, ki=a)).rightmost_pole()


def response(a: float, b: float, tau: float, w: float) -> complex:
    """G(jω) as (6) defines it, in Python's own complex numbers."""
    s = 1j * w
    return (a + b * s) / s * cmath.exp(-tau * s) / (1 + s)


# ------------------------------------------------------------------------------------- the charts, perturbed


def interior(count: int) -> Iterator[tuple[float, float, float]]:
    """Random points strictly inside the stability region: each inside a random curve of phase margin."""
    for _ in range(count):
        tau, margin = RANDOM.uniform(0.1, 1.0), RANDOM.uniform(20.0, 130.0)
        a, b = constant_phase_margin(tau, margin).curve(RANDOM.uniform(0.02, 0.98, 1))[0][0]
        yield float(a), float(b), tau


def test_phase_margin_and_crossover_by_a_longer_dead_time() -> None:
    for a, b, tau in interior(25):
        w, margin = float(crossover(a, b)), math.radians(float(phase_margin(a, b, tau)))
        at_limit = pole(a, b, tau, extra_dead_time=margin / w)
        assert abs(at_limit - 1j * w) < 1e-9 * max(1.0, w)


def test_gain_margin_and_phase_crossover_by_a_higher_gain() -> None:
    for a, b, tau in interior(25):
        g, w = gain_ratio(a, b, tau), phase_crossover(a, b, tau)
        at_limit = pole(a, b, tau, gain=1.0 / g)
        assert abs(at_limit - 1j * w) < 1e-9 * max(1.0, w)


@cache
def captured(id: str) -> pd.DataFrame:
    figure = paper.load().exhibits[id]
    assert isinstance(figure, Figure)
    canvas = Canvas(figsize=figure.size)
    figure.draw(canvas)
    return curves_frame(capture(canvas))


def drawn(id: str, name: str) -> Iterator[tuple[str, NDArray[np.float64]]]:
    """Points of the curves of one name, as read back from the drawn figure, by panel."""
    curves = captured(id)
    for panel, part in curves[curves["curve"] == name].groupby("panel", sort=False):
        yield str(panel), part[["x", "y"]].dropna().to_numpy()


@pytest.mark.parametrize("margin", [60, 75])
def test_drawn_curves_of_phase_margin(margin: int) -> None:
    panels = list(drawn("fig-6", f"phase margin {margin}"))
    assert [panel for panel, _ in panels] == [f"τ = {tau:g}" for tau in TAUS]
    for (_, points), tau in zip(panels, TAUS, strict=True):
        for a, b in points[RANDOM.integers(len(points) // 10, len(points) - len(points) // 10, 2)]:
            w = brentq(lambda w, a=a, b=b, tau=tau: abs(response(a, b, tau, w)) - 1.0, 1e-6, 50.0)
            at_limit = pole(a, b, tau, extra_dead_time=math.radians(margin) / w)
            assert abs(at_limit - 1j * w) < 2e-5 * max(1.0, w)


@pytest.mark.parametrize("g", [0.5, 0.7])
def test_drawn_curves_of_gain_margin(g: float) -> None:
    for (_, points), tau in zip(drawn("fig-7", f"g = {g:g}"), TAUS, strict=True):
        for a, b in points[RANDOM.integers(len(points) // 10, len(points) - len(points) // 10, 2)]:
            assert abs(pole(a, b, tau, gain=1.0 / g).real) < 2e-5


def test_drawn_lines_of_phase_crossover() -> None:
    panels = list(drawn("fig-7", "phase crossover 2"))
    assert len(panels) == 10
    for (_, points), tau in zip(panels, TAUS, strict=True):
        tip = points[-1]  # on the stability boundary: the loop itself oscillates at ω = 2
        assert pole(float(tip[0]), float(tip[1]), tau) == pytest.approx(2j, abs=1e-6)


def test_drawn_region_of_figure_8() -> None:
    ((_, border),) = drawn("fig-8", "admissible region")
    for a, b in border[(border[:, 0] > 0.02)][::9]:
        w = brentq(lambda w, a=a, b=b: abs(response(a, b, 0.5, w)) - 1.0, 1e-6, 50.0)
        by_dead_time = pole(a, b, 0.5, extra_dead_time=math.radians(60.0) / w).real
        by_gain = pole(a, b, 0.5, gain=1.0 / 0.3).real
        assert max(by_dead_time, by_gain) == pytest.approx(0.0, abs=1e-4)  # one bound is reached, none is broken


def test_bezier_curves_follow_the_loci_between_their_points() -> None:
    for tau, margin in ((0.1, 60.0), (1.0, 15.0)):
        path = bezier_path([constant_phase_margin(tau, margin)])
        # matplotlib's own annotation forgets the code
        pieces = cast("Iterator[tuple[BezierSegment, int]]", path.iter_bezier())
        for segment, code in pieces:
            if code == path.CURVE4:
                a, b = segment(RANDOM.uniform(0.0, 1.0))
                if a > 1e-3:
                    assert float(phase_margin(a, b, tau)) == pytest.approx(margin, abs=2e-3)


@pytest.mark.parametrize("tau", [0.02, 0.1, 0.35, 1.0, 5.0])
@pytest.mark.parametrize("ms", [1.2, 2.0])
def test_sensitivity_curves_on_a_dense_grid(tau: float, ms: float) -> None:
    points = [p for piece in sensitivity_points(tau, ms) for p in piece[1:-1:41]]
    points += [p for locus in constant_sensitivity(tau, ms) for p in locus.curve(RANDOM.uniform(0.05, 0.95, 4))[0]]
    for a, b in points:
        w = np.geomspace(1e-6, 10.0 * max(1.0, 1.0 / tau), 100_001)
        s = 1j * w
        largest = np.max(1.0 / np.abs(1.0 + (a + b * s) / s * np.exp(-tau * s) / (1.0 + s)))
        assert largest == pytest.approx(ms, rel=3e-5)
        assert pole(a, b, tau).real < 0.0


def test_combined_chart_draws_every_family_for_any_tau() -> None:
    for tau in (0.05, 0.35, 3.0):
        axes = combined_chart(tau).axes[0]
        names = {str(patch.get_label()) for patch in axes.patches}
        assert {"phase margin 60", "g = 0.5", "Ms = 1.4", "stability boundary"} <= names
        assert sum(name.startswith("crossover") for name in names) >= 5
    with pytest.raises(ValueError, match=r"tau must be between .* not 0"):
        combined_chart(0.0)


def test_loci_end_where_the_branch_ends() -> None:
    for tau in (0.1, 0.5, 1.0):
        (start, end) = constant_phase_margin(tau, 60.0).points(2)
        assert start == pytest.approx([0.0, -0.5], abs=1e-15)
        assert end[0] == pytest.approx(0.0, abs=1e-13)
        assert constant_crossover(tau, 100.0) is None
        assert constant_phase_crossover(tau, 100.0) is None
        assert constant_gain_ratio(tau, 0.3).points(2)[0] == pytest.approx([0.0, -0.3])

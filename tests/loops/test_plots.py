"""What the plots show, read back from the axes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replicate.loops import PI, Loop, LoopError, Plant, plots

LOOP = Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.6, 0.5))


@pytest.fixture
def ax() -> Iterator[Axes]:
    with mpl.rc_context({"backend": "agg"}):
        yield Figure().add_subplot()


def test_a_response_is_drawn_as_it_is(ax: Axes) -> None:
    plots.plot_step(ax, LOOP, "PI", until=20.0)
    t, y = (np.asarray(part) for part in ax.lines[1].get_data())
    np.testing.assert_allclose(y, LOOP.step(until=20.0)(t), rtol=1e-13, atol=1e-15)
    assert ax.lines[1].get_label() == "PI"


def test_a_jump_is_drawn_upright(ax: Axes) -> None:
    # e^{-s} under k = 1/2: y jumps to 1/2 at t = 1
    signal = Loop(Plant([1.0], [1.0], 1.0), PI(0.5)).step(until=3.0)
    plots.plot_signal(ax, signal)
    t, y = (np.asarray(part, dtype=float) for part in ax.lines[0].get_data())
    at = int(np.searchsorted(t, 1.0))
    assert t[at] == 1.0
    assert (y[at - 1], y[at]) == pytest.approx((0.0, 0.5), abs=1e-12)
    assert t[at - 1] == pytest.approx(1.0, rel=1e-12)


def test_a_load_response_ends_when_it_has_settled(ax: Axes) -> None:
    plots.plot_load(ax, LOOP)
    t, y = (np.asarray(part, dtype=float) for part in ax.lines[0].get_data())
    assert abs(y[-1]) < 1e-3 * np.abs(y).max()
    assert t[-1] < 0.6 * LOOP.load_step().horizon


def test_the_circle_of_ms_touches_the_nyquist_curve(ax: Axes) -> None:
    plots.plot_nyquist(ax, LOOP)
    curve, circle = (np.array(line.get_data()) for line in ax.lines[:2])
    distance = np.hypot(curve[0] + 1.0, curve[1])
    assert distance.min() == pytest.approx(1 / LOOP.sensitivity_peak(), rel=1e-4)
    np.testing.assert_allclose(np.hypot(circle[0] + 1.0, circle[1]), 1 / LOOP.sensitivity_peak(), rtol=1e-12)


def test_the_margins_of_a_bode_plot_are_the_loops() -> None:
    figure = Figure()
    above, below = figure.subplots(2)
    plots.plot_bode([above, below], LOOP)
    margins = LOOP.margins()
    gain = above.collections[0].get_paths()[0].vertices
    assert np.ravel(gain) == pytest.approx(
        [margins.phase_crossover, 1 / margins.gain, margins.phase_crossover, 1.0], rel=1e-12
    )
    phase = below.collections[0].get_paths()[0].vertices
    assert np.ravel(phase) == pytest.approx(
        [margins.gain_crossover, -180 + margins.phase, margins.gain_crossover, -180.0], rel=1e-10
    )


def test_the_gain_plane_is_stable_below_the_ultimate_gain(ax: Axes) -> None:
    # e^{-s}/(s+1): with ki = 0 stable up to sqrt(1 + w^2), w = -tan w, 2.2618
    plane = plots.plot_gain_plane(ax, Plant.foptd(1.0, 1.0, 1.0), [0.3, 1.0, 2.25, 2.27], [0.0, 0.4], levels=[1.4, 2.0])
    assert np.isfinite(plane.ms[0]).tolist() == [True, True, True, False]
    assert plane.ms[1, 0] == Loop(Plant.foptd(1.0, 1.0, 1.0), PI(0.3, 0.4)).sensitivity_peak()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("k", "ki")


def test_the_gain_plane_of_a_plant_that_no_gains_on_it_stabilise(ax: Axes) -> None:
    plane = plots.plot_gain_plane(ax, Plant([1.0], [1.0, -1.0], 5.0), [0.5, 1.0], [0.1, 0.2])
    assert np.isnan(plane.ms).all()


WRONG: dict[str, tuple[Callable[[Any], object], str]] = {
    "signal": (lambda ax: plots.plot_signal(ax, LOOP), "the signal must be a Signal, not Loop"),  # type: ignore[arg-type]
    "no axes": (lambda _: plots.plot_signal(None, LOOP.step(5.0)), "the axes to draw on must be matplotlib axes"),  # type: ignore[arg-type]
    "until": (lambda ax: plots.plot_signal(ax, LOOP.step(5.0), until="x"), "until must be a finite number > 0"),  # type: ignore[arg-type]
    "step": (lambda ax: plots.plot_step(ax, LOOP.plant), "the loop must be a Loop, not Plant"),  # type: ignore[arg-type]
    "step until": (lambda ax: plots.plot_step(ax, LOOP, until="x"), "until must be a finite time > 0"),  # type: ignore[arg-type]
    "load": (lambda _: plots.plot_load("ax", LOOP), "the axes to draw on must be matplotlib axes, not str"),  # type: ignore[arg-type]
    "nyquist": (lambda ax: plots.plot_nyquist(ax, 1.0), "the loop must be a Loop, not float"),  # type: ignore[arg-type]
    "nyquist ms": (lambda ax: plots.plot_nyquist(ax, LOOP, ms="x"), "ms must be finite and greater than 1"),  # type: ignore[arg-type]
    "one axes": (lambda ax: plots.plot_bode(ax, LOOP), "the axes of a Bode plot must be two matplotlib axes"),
    "three axes": (lambda ax: plots.plot_bode([ax] * 3, LOOP), "the axes of a Bode plot must be two matplotlib axes"),
    "bode": (lambda ax: plots.plot_bode([ax, ax], None), "the loop must be a Loop, not NoneType"),  # type: ignore[arg-type]
    "bode w": (lambda ax: plots.plot_bode([ax, ax], LOOP, w="x"), "must be"),
    "plane": (lambda ax: plots.plot_gain_plane(ax, LOOP, [0.1], [0.1]), "gain plane must be a Plant, not Loop"),  # type: ignore[arg-type]
    "plane k": (lambda ax: plots.plot_gain_plane(ax, LOOP.plant, ["x"], [0.1]), "k must be a finite number"),
    "plane levels": (lambda ax: plots.plot_gain_plane(ax, LOOP.plant, [0.1], [0.1], levels=2.0), "levels must be"),  # type: ignore[arg-type]
    "plane level": (lambda ax: plots.plot_gain_plane(ax, LOOP.plant, [0.1], [0.1], levels=["x"]), "each level of Ms"),  # type: ignore[list-item]
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_drawn_is_named_in_one_line(ax: Axes, name: str) -> None:
    call, words = WRONG[name]
    with pytest.raises(LoopError, match=words) as caught:
        call(ax)
    assert "\n" not in str(caught.value)
    assert not ax.lines

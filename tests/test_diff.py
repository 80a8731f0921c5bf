"""The comparison with the accepted state: the alarm rings, says what and how much, and does not ring for nothing.

Figures are drawn as a paper draws them, and read back; what must be found is known from how they were drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray
from scipy.spatial import KDTree

from replicate.diff.accepted import FigureState, figure_state
from replicate.diff.changes import Change
from replicate.diff.comparison import ExhibitDiff
from replicate.exhibits import Figure
from replicate.figures import capture as record_of
from replicate.figures import compare
from replicate.figures import style as plotstyle
from replicate.figures.curves import compare_curves
from replicate.figures.distance import distances, exact_distances
from replicate.figures.off_screen import curves_frame
from replicate.figures.values import WINDOW, compare_values
from replicate.run.drawing import capture

Array = NDArray[np.float64]
Draw = Callable[[Canvas], object]

T = np.linspace(0.0, 10.0, 2001)
STEP = np.array([0.0, 3.0, 3.0, 10.0]), np.array([0.0, 0.0, 1.0, 1.0])


def response(t: Array) -> Array:
    return 1.0 - np.exp(-t / 2.0) * np.cos(3.0 * t)


@cache  # the figure before a change is that of many tests
def state(draw: Draw) -> FigureState:
    with plotstyle.style("toy"):
        canvas = Canvas()
        draw(canvas)
        record = record_of(canvas)
        return figure_state(curves_frame(record), record.panels, record.figure)


def plot(*curves: tuple[str, Any, Any], xlim: Any = (0.0, 10.0), ylim: Any = (0.0, 2.0), **settings: Any) -> Draw:
    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        for label, x, y in curves:
            axes.plot(x, y, label=label)
        axes.set(xlim=xlim, ylim=ylim, xlabel="time $t$", **settings)
        axes.legend()

    return draw


def changes(before: Draw, after: Draw) -> list[str]:
    old, new = state(before), state(after)
    found = compare(old.record, new.record)
    about_curves = any(change.kind in {"curve", "new", "removed"} for change in found.differences)
    unchanged = found.unchanged if about_curves else 0  # of other curves, when it is about curves
    changed = [Change.of_figure("toy", "fig-1", difference) for difference in found.differences]
    return ExhibitDiff("toy", "fig-1", "figure", changed, unchanged).texts


OUTPUT, INPUT = ("output", T, response(T)), ("input", *STEP)
BOTH = plot(OUTPUT, INPUT)


# ------------------------------------------------------------------------------------------ the alarm rings


def test_a_curve_moved_by_a_thousandth_of_the_axis() -> None:
    (said,) = changes(BOTH, plot(("output", T, response(T) + 0.002), INPUT))
    assert said.startswith("curve 'output' moved: at most 0.002 (0.1 % of the axis) at t = ")


@pytest.mark.parametrize("shift", [(0.01, 0.0), (0.0, 0.002)])
@pytest.mark.parametrize(
    ("x", "y"),
    [
        (5.0 + 3.0 * np.cos(T), 1.0 + 0.8 * np.sin(T)),  # a closed curve
        (T, 0.2 * T),
        (T, 1.0 + np.sin(10.0 * T) / 2.0),
        (np.full(50, 4.0), np.linspace(0.2, 1.7, 50)),
        (4.0 + 0.1 * np.linspace(0.0, 1.0, 9), np.linspace(0.2, 1.7, 9)),  # 50 times as steep as the axes
        (T[::100], response(T[::100])),
    ],
)
def test_a_thousandth_is_seen_whatever_the_shape(x: Array, y: Array, shift: tuple[float, float]) -> None:
    before, after = plot(("locus", x, y), INPUT), plot(("locus", x + shift[0], y + shift[1]), INPUT)
    (said,) = changes(before, after)
    assert said.startswith("curve 'locus' ")
    assert said.endswith("1 curve unchanged")


def test_a_shifted_jump_is_named() -> None:
    later = ("input", np.where(STEP[0] == 3.0, 3.05, STEP[0]), STEP[1])
    assert changes(BOTH, plot(OUTPUT, later)) == [
        "curve 'input' moved: its jump at t = 3 is now at 3.05 (0.5 % of the axis); 1 curve unchanged"
    ]


def test_a_delayed_square_wave_is_told_in_one_breath() -> None:
    at = np.repeat(np.arange(1.0, 9.0), 2)
    levels = np.tile([0.0, 1.0, 1.0, 0.0], 4)
    before, after = (plot(("wave", np.r_[0.0, at + late, 10.0], np.r_[0.0, levels, 0.0])) for late in (0.0, 0.05))
    (said,) = changes(before, after)
    assert said.startswith(
        "curve 'wave' moved: its jump at t = 1 is now at 1.05 (0.5 % of the axis); its jump at t = 2 "
    )
    assert said.endswith("(0.5 % of the axis); and 6 more jumps, by at most 0.5 % of the axis")


def test_a_shifted_jump_does_not_hide_a_moved_level() -> None:
    later = ("input", np.array([0.0, 3.05, 3.05, 10.0]), np.array([0.0, 0.0, 1.1, 1.1]))
    (said,) = changes(BOTH, plot(OUTPUT, later))
    assert "its jump at t = 3 is now at 3.05" in said
    assert "elsewhere at most 0.1 (5 % of the axis)" in said


def test_a_narrow_spike_that_is_lost() -> None:
    flat = np.ones_like(T)
    spike = np.where(np.arange(len(T)) == 1000, 1.5, flat)
    (said,) = changes(plot(("y", T, spike)), plot(("y", T, flat)))
    assert said.startswith("curve 'y' moved: at most 0.5 (25 % of the axis) at t = 5")


def test_swapped_labels() -> None:
    swapped = plot(("input", *OUTPUT[1:]), ("output", *INPUT[1:]))
    assert changes(BOTH, swapped) == [
        "legend entries 'output' and 'input' are swapped",
        "the labels of curves 'output' and 'input' are swapped",
    ]


def test_a_renamed_curve() -> None:
    assert changes(BOTH, plot(("y", *OUTPUT[1:]), INPUT)) == [
        "legend entry 'output' renamed 'y'",
        "curve 'output' is now called 'y'; 1 curve unchanged",
    ]


def test_a_missing_and_a_new_curve() -> None:
    assert changes(BOTH, plot(OUTPUT)) == [
        "legend entry 'input' is gone",
        "curve 'input' is missing; 1 curve unchanged",
    ]
    assert changes(plot(OUTPUT), BOTH)[1] == "curve 'input' is new; 1 curve unchanged"


def test_a_curve_that_ends_earlier_and_one_with_a_gap() -> None:
    early = T <= 8.0
    (said,) = changes(BOTH, plot(("output", T[early], response(T[early])), INPUT))
    assert said == "curve 'output' now ends at t = 8 (was 10); 1 curve unchanged"
    gap = np.where(np.abs(T - 5.0) < 0.5, np.nan, response(T))
    (said,) = changes(BOTH, plot(("output", T, gap), INPUT))
    assert said.startswith("curve 'output' now has a gap from t = 4.5")


def test_a_gap_in_a_closed_curve() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 401)
    x, y = 5.0 + 3.0 * np.cos(angle), 1.0 + 0.8 * np.sin(angle)
    open_ = np.abs(angle - 3.0) > 0.2
    before, after = plot(("locus", x, y)), plot(("locus", np.where(open_, x, np.nan), y))
    (said,) = changes(before, after)
    assert said.startswith("curve 'locus' moved: at most ")


def test_limits_scales_and_labels() -> None:
    assert changes(BOTH, plot(OUTPUT, INPUT, xlim=(0.0, 8.0))) == ["x axis now ends at 8 (was 10)"]
    assert changes(BOTH, plot(OUTPUT, INPUT, ylim=(-1.0, 2.0))) == ["y axis now begins at -1 (was 0)"]
    assert changes(BOTH, plot(OUTPUT, INPUT, ylim=(2.0, 0.0))) == ["y axis now runs from 2 to 0, the other way round"]
    positive = ("gain", T + 1.0, T + 1.0)
    before, after = (plot(positive, xlim=(1.0, 11.0), ylim=(1.0, 11.0), yscale=scale) for scale in ("linear", "log"))
    assert changes(before, after)[0] == "scale of the y axis is now 'log' (was 'linear')"
    assert changes(BOTH, plot(OUTPUT, INPUT, ylabel="volts")) == ["label of the y axis is now 'volts' (was nothing)"]


def test_values_on_a_logarithmic_axis_are_told_as_factors() -> None:
    def gain(factor: float) -> Draw:
        w = np.logspace(-2, 2, 801)
        return plot(
            ("gain", w, factor / np.hypot(1.0, w)), xscale="log", yscale="log", xlim=(1e-2, 1e2), ylim=(1e-3, 1e1)
        )

    (said,) = changes(gain(1.0), gain(1.05))
    assert "moved: at most a factor of 1.05 (0.53 % of the axis)" in said  # log10(1.05) / 4 = 0.0053


def test_scattered_points() -> None:
    def samples(x: Array) -> Draw:
        return lambda canvas: canvas.subplots().set(xlim=(0, 10), ylim=(0, 10)) and canvas.axes[0].plot(x, x, "o")

    x = np.arange(1.0, 9.0)
    moved = x.copy()
    moved[3] += 0.05  # along the line through the others: only as points do they differ
    assert changes(samples(x), samples(x[::-1])) == []
    assert changes(samples(x), samples(moved))[0].startswith("curve 'line 1' moved: at most 0.71 %")
    assert changes(samples(x), samples(x[:-1])) == ["curve 'line 1' now has 7 points (was 8)"]


def test_texts() -> None:
    def text(words: str, x: float) -> Draw:
        return lambda canvas: canvas.subplots().text(x, 0.5, words)

    assert changes(text("peak", 0.2), text("peak", 0.4)) == ["text 'peak' moved from (0.2, 0.5) to (0.4, 0.5)"]
    assert changes(text("peak", 0.2), text("top", 0.2)) == ["text 'peak' now reads 'top'"]
    assert changes(text("peak", 0.2), lambda canvas: canvas.subplots()) == ["text 'peak' at (0.2, 0.5) is gone"]


def test_panels_are_named_and_matched() -> None:
    def panels(*titles: str, offset: float = 0.0) -> Draw:
        def draw(canvas: Canvas) -> None:
            for axes, title in zip(canvas.subplots(1, len(titles), squeeze=False)[0], titles, strict=True):
                axes.plot(T, response(T) + offset, label="output")
                axes.set(title=title, xlim=(0, 10), ylim=(0, 2))

        return draw

    assert changes(panels("slow", "fast"), panels("slow", "quick")) == ["'fast': title is now 'quick' (was 'fast')"]
    assert changes(panels("slow", "fast"), panels("slow")) == ["panel 'fast' is gone"]
    said = changes(panels("slow", "fast"), panels("slow", "fast", offset=0.1))
    assert [text.partition(" moved")[0] for text in said] == ["curve 'output' in 'slow'", "curve 'output' in 'fast'"]


# --------------------------------------------------------------------------------------- and only then


def test_other_fonts_and_resolutions() -> None:
    def with_fonts(family: str, dpi: float) -> Callable[[Canvas], None]:
        def draw(canvas: Canvas) -> None:
            BOTH(canvas)
            canvas.set_dpi(dpi)
            axes = canvas.axes[0]
            for text in (axes.xaxis.label, axes.yaxis.label, *axes.get_xticklabels(), *axes.get_yticklabels()):
                text.set(family=family)
            axes.lines[0].set(antialiased=dpi < 100.0)

        return draw

    figures = [Figure("fig-1", "figure", "A title", draw) for draw in (
        with_fonts("DejaVu Sans", 72.0), with_fonts("DejaVu Serif", 300.0),
    )]  # fmt: skip
    one, other = (capture("toy", figure) for figure in figures)
    assert one.png != other.png
    assert one.svg != other.svg
    assert (one.axes, one.figure) == (other.axes, other.figure)
    before, after = (figure_state(drawn.curves, drawn.axes, drawn.figure).record for drawn in (one, other))
    found = compare(before, after)
    assert (found.changes, found.unchanged) == ([], 2)


@pytest.mark.parametrize("count", [1501, 4001, 20001])
def test_other_samples_of_the_same_curve(count: int) -> None:
    t = np.linspace(0.0, 10.0, count)
    finer = (np.array([0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 5.0, 10.0]), np.array([0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]))
    angle = np.linspace(0.0, 2.0 * np.pi, count)
    circle = ("circle", 5.0 + 3.0 * np.cos(angle + 1.0), 1.0 + 0.8 * np.sin(angle + 1.0))
    turned = ("circle", 5.0 + 3.0 * np.cos(T * 0.2 * np.pi), 1.0 + 0.8 * np.sin(T * 0.2 * np.pi))
    before = plot(OUTPUT, INPUT, turned)
    assert changes(before, plot(("output", t, response(t)), ("input", *finer), circle)) == []


@pytest.mark.parametrize("seed", range(3))
def test_rounding(seed: int) -> None:
    noise = np.random.default_rng(seed)

    def rounded(values: Array) -> Array:
        return values * (1.0 + 1e-10 * noise.standard_normal(len(values)))

    steep = ("tan", T, np.tan(T))
    before = plot(OUTPUT, INPUT, steep)
    after = plot(*((name, rounded(x), rounded(y)) for name, x, y in (OUTPUT, INPUT, steep)))
    assert changes(before, after) == []


def test_a_jump_moved_by_rounding() -> None:
    for x in (3.0 - 1e-9, 3.0 + 1e-9):
        assert changes(BOTH, plot(OUTPUT, ("input", np.where(STEP[0] == 3.0, x, STEP[0]), STEP[1]))) == []


def test_automatic_limits_follow_resampled_data_silently() -> None:
    def automatic(count: int) -> Draw:
        t = np.linspace(0.0, 10.0, count)
        return lambda canvas: canvas.subplots().plot(t, response(t), label="output")

    assert changes(automatic(4001), automatic(5003)) == []


def test_what_is_out_of_view_does_not_matter() -> None:
    def saturated(level: float) -> Draw:
        return plot(("y", T, np.minimum(T, level)), ylim=(0.0, 1.0))

    assert changes(saturated(5.0), saturated(7.0)) == []
    assert changes(saturated(5.0), saturated(0.99)) != []


# ------------------------------------------------------------------------- the measures, by other means


@pytest.mark.parametrize("seed", range(6))
def test_the_distance_is_that_of_many_points(seed: int) -> None:
    random = np.random.default_rng(seed)
    one, other = random.uniform(0.05, 0.95, (2, 12, 2))
    other[5] = np.nan

    def many(points: Array) -> Array:
        pieces = [
            start + np.linspace(0.0, 1.0, 1501)[:, None] * (end - start)
            for start, end in pairwise(points)
            if np.isfinite(start + end).all()
        ]
        return np.vstack(pieces)

    expected = np.max(KDTree(many(other)).query(many(one))[0])
    found = distances(one, other, 1e-4)
    assert found.largest == pytest.approx(expected, abs=2e-3 / 2)
    exact = KDTree(many(other)).query(found.points)[0]
    assert exact_distances(found, other) == pytest.approx(exact, abs=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_the_band_holds_what_the_curve_takes_on_close_by(seed: int) -> None:
    random = np.random.default_rng(seed)
    x = np.sort(random.uniform(0.0, 1.0, 40))
    x[10:12] = x[10]  # a jump
    y = random.uniform(0.2, 0.8, 40)
    old = np.column_stack([np.r_[0.0, x, 1.0], np.r_[y[0], y, y[-1]]])
    found = compare_values(old, old + np.array([0.0, 1e-5]), tolerance=1e-3, window=0.01)
    assert not found.alarm.any()
    border = np.abs(np.abs(old[:, 0] - found.x[:, None]) - 0.01).min(axis=1) < 1e-12  # rounding decides what is near
    places = np.flatnonzero(~border)[::7]
    for at, lower, upper in zip(found.x[places], found.lower[places], found.upper[places], strict=True):
        near = np.linspace(max(at - 0.01, 0.0), min(at + 0.01, 1.0), 4001)
        values = np.interp(near, *old.T)
        vertices = old[np.abs(old[:, 0] - at) <= 0.01, 1]
        assert lower == pytest.approx(min(values.min(), *vertices, 9.0) - 1e-3, abs=1e-3)
        assert upper == pytest.approx(max(values.max(), *vertices, -9.0) + 1e-3, abs=1e-3)


def test_the_window_is_a_sharp_border() -> None:
    ramp = np.array([[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [1.0, 1.0]])
    for factor, rings in ((0.5, False), (1.5, True)):
        moved = ramp + np.where(ramp[:, :1] == 0.5, [factor * WINDOW, 0.0], 0.0)
        assert compare_values(ramp, moved).alarm.any() == rings


@pytest.mark.parametrize("value", [1e160, -1e300, 1.7e308])
@pytest.mark.parametrize("width", [2.0, 1e-9])
@pytest.mark.parametrize("shape", ["circle", "function", "points"])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_point_so_far_away_that_its_distance_overflows(value: float, width: float, shape: str, axis: int) -> None:
    angle = np.linspace(0.0, 6.0, 60)
    across = angle / 6.0 if shape == "function" else 0.5 + 0.4 * np.cos(angle)
    curve = np.column_stack([across, 0.5 + 0.4 * np.sin(angle)]) * width
    far = curve.copy()
    far[-1 if shape == "function" else 7, axis] = value
    axes: dict[str, Any] = {"panel": "panel 1", "xlim": [0.0, width], "ylim": [0.0, width]}
    axes |= {"xscale": "linear", "yscale": "linear", "points": ["c"] if shape == "points" else []}
    for one, other in ((curve, far), (far, curve)):
        found = compare_curves(({("panel 1", "c"): one}, [axes]), ({("panel 1", "c"): other}, [axes]))
        assert [change.kind for change in found.changes] == ["curve"]
    again = compare_curves(({("panel 1", "c"): far}, [axes]), ({("panel 1", "c"): far.copy()}, [axes]))
    assert again.changes == []

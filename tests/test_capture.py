"""What is read back out of a figure, against the functions that were drawn."""

from __future__ import annotations

import re
from collections.abc import Callable

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray
from scipy.spatial import KDTree

from replicate.exhibits import Figure
from replicate.exhibits.results import FigureResult
from replicate.figures import style as plotstyle
from replicate.figures.readback import MOST_POINTS
from replicate.run.drawing import capture


def captured(draw: Callable[[Canvas], object]) -> FigureResult:
    def draw_only(canvas: Canvas) -> None:
        draw(canvas)

    return capture("paper", Figure("fig-1", "figure", "A title", draw_only))


def on_axes(draw: Callable[[Axes], object]) -> FigureResult:
    return captured(lambda canvas: draw(canvas.subplots()))


def curve(result: FigureResult, name: str, panel: str = "panel 1") -> NDArray[np.float64]:
    curves = result.curves
    points = curves[(curves["panel"] == panel) & (curves["curve"] == name)][["x", "y"]].to_numpy()
    assert len(points)
    return np.asarray(points)


def test_a_thinned_curve_is_the_curve() -> None:
    def response(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return 1.0 - np.exp(-t / 3.0) * np.cos(2.0 * t)

    t = np.linspace(0.0, 20.0, 20001)
    result = on_axes(lambda axes: axes.plot(t, response(t), label="output"))
    points = curve(result, "output")
    assert len(points) <= MOST_POINTS
    size = [high - low for low, high in (result.axes[0]["xlim"], result.axes[0]["ylim"])]
    drawn = points / size
    length = np.r_[0.0, np.cumsum(np.hypot(*np.diff(drawn, axis=0).T))]
    everywhere = np.linspace(0.0, length[-1], 200_001)
    redrawn = np.column_stack([np.interp(everywhere, length, column) for column in drawn.T])
    distance, _ = KDTree(redrawn).query(np.column_stack([t, response(t)]) / size)
    assert np.max(distance) < 1e-4


def test_a_jump_stays_a_jump() -> None:
    t = np.array([0.0, 1.0, 1.0, 2.0])
    result = on_axes(lambda axes: axes.plot(t, [0.0, 0.0, 1.0, 1.0], label="u"))
    assert curve(result, "u").tolist() == [[0, 0], [1, 0], [1, 1], [2, 1]]


def test_straight_lines_need_two_points() -> None:
    t = np.linspace(0.0, 1.0, 501)
    assert len(curve(on_axes(lambda axes: axes.plot(t, 3.0 * t)), "line 1")) == 2


def test_names_of_panels_and_curves() -> None:
    def draw(canvas: Canvas) -> None:
        left, right, third = canvas.subplots(1, 3)
        left.plot([0, 1], label="a")
        left.plot([1, 0])
        left.plot([1, 2], label="a")
        right.set_title("output")
        right.plot([0, 1])
        third.set_title("output")
        third.plot([0, 1])

    curves = captured(draw).curves[["panel", "curve"]].drop_duplicates().itertuples(index=False, name=None)
    assert list(curves) == [
        ("panel 1", "a"),
        ("panel 1", "line 2"),
        ("panel 1", "a (2)"),
        ("output", "line 1"),
        ("output (2)", "line 1"),
    ]


def test_lines_across_the_axes_are_in_data_coordinates() -> None:
    def draw(axes: Axes) -> None:
        axes.set(xlim=(2.0, 10.0), ylim=(0.0, 4.0))
        axes.axhline(1.0, label="set point")
        axes.axvline(3.0, label="dead time")
        axes.plot([0.1, 0.2], [0.5, 0.5], transform=axes.transAxes, label="decoration")

    result = on_axes(draw)
    assert curve(result, "set point").tolist() == [[2, 1], [10, 1]]
    assert curve(result, "dead time").tolist() == [[3, 0], [3, 4]]
    assert "decoration" not in set(result.curves["curve"])


def test_scattered_points_are_all_kept_in_order() -> None:
    x = np.linspace(0.0, 1.0, 1001)
    result = on_axes(lambda axes: (axes.scatter(x, 2 * x, label="samples"), axes.plot(x, x, "o", label="dots")))
    assert np.allclose(curve(result, "samples"), np.column_stack([x, 2 * x]), rtol=1e-8)
    assert len(curve(result, "dots")) == 1001


def test_contours_lie_on_their_levels() -> None:
    grid = np.linspace(-2.0, 2.0, 401)
    x, y = np.meshgrid(grid, grid)
    result = on_axes(lambda axes: axes.contour(x, y, np.hypot(x, y), [0.5, 1.5]))
    for level in (0.5, 1.5):
        points = curve(result, f"level {level}")
        assert np.hypot(*points.T) == pytest.approx(level, abs=1e-4)
        assert len(points) > 30


def test_areas_and_shapes() -> None:
    def draw(axes: Axes) -> None:
        axes.fill_between([0.0, 1.0, 2.0], [1.0, 2.0, 1.0], label="band")
        axes.bar([5.0], [3.0], width=1.0)
        axes.vlines([3.0, 4.0], 0.0, 1.0, label="samples")

    result = on_axes(draw)
    assert {(0, 1), (1, 2), (2, 1), (2, 0), (0, 0)} <= {tuple(point) for point in curve(result, "band")}
    assert {(4.5, 0), (5.5, 0), (5.5, 3), (4.5, 3)} == {tuple(point) for point in curve(result, "shape 1")}
    stems = curve(result, "samples")
    assert np.isnan(stems[2]).all()
    assert stems[[0, 1, 3, 4]].tolist() == [[3, 0], [3, 1], [4, 0], [4, 1]]


def test_gaps_and_what_is_far_out_of_view() -> None:
    t = np.linspace(0.0, 10.0, 1001)

    def draw(axes: Axes) -> None:
        axes.plot(t, np.where(np.abs(t - 5.0) < 0.5, np.nan, t), label="gap")
        axes.plot(t, np.exp(2.0 * t), label="unstable")
        axes.set_ylim(0.0, 10.0)

    result = on_axes(draw)
    gap = curve(result, "gap")
    assert np.isnan(gap).any(axis=1).sum() == 1
    unstable = curve(result, "unstable")
    assert 10.0 < unstable[:, 1].max() < 20.0
    assert unstable[0].tolist() == [0.0, 1.0]


def test_logarithmic_axes_are_thinned_as_they_look() -> None:
    w = np.logspace(-3, 3, 6001)
    gain = 1.0 / np.hypot(1.0, w)
    result = on_axes(lambda axes: axes.loglog(w, gain, label="gain"))
    points = curve(result, "gain")
    assert len(points) <= MOST_POINTS
    interpolated = np.exp(np.interp(np.log(w), np.log(points[:, 0]), np.log(points[:, 1])))
    assert interpolated == pytest.approx(gain, rel=1e-3)
    assert result.axes[0]["xscale"] == result.axes[0]["yscale"] == "log"


def test_nine_significant_digits_and_no_rounding_noise() -> None:
    result = on_axes(lambda axes: axes.plot([0.0, 1.0, 2.0], [1e-17, 2.0 / 3.0, -0.0]))
    assert curve(result, "line 1")[:, 1].tolist() == [0.0, 0.666666667, 0.0]
    assert not np.signbit(curve(result, "line 1")).any()


def test_the_axes_are_described() -> None:
    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        axes.plot([0, 1], [0, 2], label="output")
        axes.set(xlim=(0, 4), ylim=(-1, 3), xlabel="time $t$", ylabel="output", title="Step")
        axes.annotate("peak", xy=(1.0, 2.0), xytext=(2.0, 2.5), arrowprops={"arrowstyle": "->"})
        axes.legend()
        canvas.suptitle("Both examples")

    (described,) = captured(draw).axes
    parts = described.pop("parts")
    assert {"output", "legend entry 'output'", "arrow of text 'peak'"} <= {part["name"] for part in parts}
    assert [described] == [
        {
            "position": [0.125, 0.11, 0.775, 0.77],
            "panel": "Step",
            "title": "Step",
            "xlabel": "time $t$",
            "ylabel": "output",
            "xscale": "linear",
            "yscale": "linear",
            "xlim": [0.0, 4.0],
            "ylim": [-1.0, 3.0],
            "legend": ["output"],
            "texts": [{"text": "peak", "x": 1.0, "y": 2.0}],
            "figure_title": "Both examples",
        }
    ]


def drawing(axes: Axes) -> None:
    axes.plot([0.0, 1.0, 2.0], [0.0, 1.0, 0.5], label="output")
    axes.text(1.0, 0.5, "black", color="black")
    axes.legend()


def test_same_figure_same_bytes_whatever_the_users_settings() -> None:
    first = on_axes(drawing)
    with mpl.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "svg.fonttype": "none"}):
        second = on_axes(drawing)
        assert mpl.rcParams["lines.linewidth"] == 9.0
    assert (first.svg, first.png) == (second.svg, second.png)


def test_the_svg_is_ready_for_a_page() -> None:
    svg = on_axes(drawing).svg
    assert "<dc:date>" not in svg
    assert "#000000" not in svg
    assert plotstyle.INK in svg
    themed = plotstyle.themed(svg)
    assert plotstyle.INK not in themed
    assert "currentColor" in themed
    (background,) = re.findall(r'id="patch_1">.*?style="([^"]*)"', svg, re.DOTALL)[:1]
    assert background == "fill: none"


@pytest.mark.parametrize("text", ["三個樣本", "日本", "한국", "नमस्ते", "ไทย", "தமிழ்", "తెలుగు", "ខ្មែរ", "עברית", "عربي"])
def test_letters_of_many_scripts_are_drawn(text: str) -> None:
    """Of a letter that no font has, matplotlib draws a box and warns, as the last lines make sure."""
    on_axes(lambda axes: axes.set_title(text))
    with pytest.warns(UserWarning, match="missing from font"):
        on_axes(lambda axes: axes.set_title(text + "\N{EGYPTIAN HIEROGLYPH A001}"))


def test_the_png_is_a_png_of_the_right_size() -> None:
    def draw(canvas: Canvas) -> None:
        canvas.subplots().plot([1, 2])

    png = capture("p", Figure("f", "figure", "t", draw, size=(3.0, 2.0))).png
    assert png.startswith(b"\x89PNG")
    assert int.from_bytes(png[16:20], "big") == 3 * plotstyle.PNG_DPI
    assert int.from_bytes(png[20:24], "big") == 2 * plotstyle.PNG_DPI


def test_a_bezier_curve_is_read_back_along_the_curve() -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    control = np.array([[0.0, 0.0], [0.0, 0.004], [0.003, 0.004], [0.004, 0.001]])  # small: pixels must not matter

    def draw(axes: Axes) -> None:
        axes.set(xlim=(0.0, 0.004), ylim=(0.0, 0.004))
        axes.add_patch(PathPatch(Path(control, [1, 4, 4, 4]), fill=False, label="cubic"))

    t = np.linspace(0.0, 1.0, 20_001)[:, None]
    bernstein = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3]
    exact = sum(weight * corner for weight, corner in zip(bernstein, control, strict=True))
    points = curve(on_axes(draw), "cubic")
    assert len(points) > 20
    assert np.max(KDTree(exact).query(points)[0]) < 1e-6
    assert np.max(KDTree(points).query(exact)[0]) < 4e-4  # the points are a few chords apart

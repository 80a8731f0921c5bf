"""What is said of a change: that and nothing else, once, of the right thing; and of what nobody sees, nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnchoredOffsetbox, DrawingArea
from matplotlib.patches import Circle
from matplotlib.transforms import Affine2D
from mpl_toolkits.axes_grid1 import host_subplot
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from replicate.figures import Record, capture, compare

Y, X = np.mgrid[-3:3:20j, -3:3:20j]
T = np.linspace(0.0, 10.0, 101)


def said(draw: Callable[[Any, Any], object], before: Any, after: Any) -> list[str]:
    records = []
    for value in (before, after):
        figure = Figure()
        draw(figure.subplots(), value)
        records.append(Record.from_json(capture(figure).to_json()))
    return compare(*records).changes


def test_what_cannot_be_seen_is_no_curve_and_no_text() -> None:
    def draw(axes: Any, more: object) -> None:
        axes.plot(T, np.sin(T), label="a")
        axes.set(xlim=(0, 10), ylim=(-1, 1))
        if more:
            axes.plot(T, np.cos(T), label="b", alpha=0.0)
            axes.plot(T, np.cos(T), color="none")
            axes.plot(T, np.cos(T), linewidth=0)
            axes.plot(T, np.cos(T), linestyle="none")
            axes.scatter(T, np.cos(T), alpha=0.0, label="c")
            axes.fill_between(T, np.cos(T), alpha=0.0)
            axes.add_patch(Circle((3, 0), 0.5, fill=False, linewidth=0))
            axes.text(3, 0.5, "words", alpha=0.0)
            axes.text(4, 0.5, " ")
            axes.annotate("far", (99, 99))

    assert said(draw, False, True) == said(draw, True, False) == []


@pytest.mark.parametrize("look", [{"alpha": 0.0}, {"color": "none"}, {"linewidth": 0}])
def test_what_cannot_be_seen_may_move(look: dict[str, Any]) -> None:
    def draw(axes: Any, end: float) -> None:
        axes.set(xlim=(0, 1), ylim=(0, 1))
        axes.plot([0, end], **look)

    assert said(draw, 1.0, 2.0) == []


def test_what_a_log_axis_cannot_show_is_far_below() -> None:
    def draw(axes: Any, value: float) -> None:
        axes.semilogy([1.0, value, 10.0])
        axes.set_ylim(0.1, 20.0)

    assert said(draw, 0.0, -3.0) == []
    assert said(draw, 0.0, np.nan) == ["curve 'line 1' now has a gap from x = 0.0003302 to 2"]


def test_what_is_clipped_away_and_the_order_of_axes_are_not_seen() -> None:
    def draw(axes: Any, more: object) -> None:
        axes.set(xlim=(0, 10), ylim=(-1, 1))
        if more:
            axes.plot([10.5, 12], [0, 1])
            axes.plot([50, 60], [0, 1])
            axes.scatter([11, 12], [0, 1])
            axes.text(50, 0, "far", clip_on=True)
        for place in (0.1, 0.6) if more else (0.6, 0.1):
            axes.figure.add_axes((place, 0.7, 0.2, 0.2)).set_title(f"at {place}")

    assert said(draw, False, True) == said(draw, True, False) == []
    assert said(lambda ax, v: ax.plot([2, 3], [0, 1], clip_on=v) and ax.set_xlim(0, 1), True, False)


@pytest.mark.parametrize(("filled", "labels"), [(False, False), (False, True), (True, False)])
def test_a_contour_of_another_level_is_another_curve(filled: bool, labels: bool) -> None:
    def draw(axes: Any, level: float) -> None:
        contours = (axes.contourf if filled else axes.contour)(X, Y, X + Y**2, [-1.0, level, 5.0])
        if labels:
            axes.clabel(contours)

    changes = said(draw, 2.0, 2.5)
    assert any(text.endswith("is missing") for text in changes) or "moved" in changes[0]


LEVELS = (-0.8, -0.5, -0.2, 0.2, 0.5)


@pytest.mark.parametrize("inline", [False, True])
def test_where_labels_of_contours_stand_is_layout(inline: bool) -> None:
    x, y = np.meshgrid(np.linspace(-3.0, 3.0, 60), np.linspace(-2.0, 2.0, 50))
    bumps = np.exp(-(x**2) - y**2) - np.exp(-((x - 1.0) ** 2) - (y - 1.0) ** 2)

    def draw(axes: Any, given: tuple[int, float, bool]) -> None:
        seed, shift, inside = given
        noise = 1e-10 * np.random.default_rng(seed).normal(size=bumps.shape)
        axes.clabel(axes.contour(x, y, bumps + noise + shift, LEVELS), inline=inside, colors="k")

    assert [said(draw, (0, 0.0, inline), (seed, 0.0, inline)) for seed in range(1, 5)] == [[]] * 4
    assert any("moved" in text for text in said(draw, (0, 0.0, inline), (0, 0.005, inline)))
    interrupted = [text for text in said(draw, (0, 0.0, inline), (0, 0.0, not inline)) if "interrupted" in text]
    words = "no longer" if inline else "now"
    assert interrupted == [f"curve 'level {level}' is {words} interrupted by its labels" for level in LEVELS]


def test_labels_of_contours_are_seen_where_somebody_put_them_and_upside_down() -> None:
    def draw(axes: Any, given: dict[str, Any]) -> None:
        axes.clabel(axes.contour(X, Y, -X - Y, [0.3]), **given)

    place = {"manual": np.array([[0.0, 0.0]])}
    assert said(draw, place, place) == []
    assert any("label '0.3' moved by up to" in text for text in said(draw, place, {"manual": [[1.2, -1.2]]}))
    assert said(draw, {}, {"rightside_up": False}) == ["orientation of label '0.3' is now upside down (was upright)"]


def test_a_contour_is_kept_as_it_runs_in_any_unit() -> None:
    def height(x: Any) -> Any:
        return 5e-4 + 2e-4 * np.sin(4e3 * np.pi * x)

    x, y = np.meshgrid(np.linspace(0.0, 1e-3, 200), np.linspace(0.0, 1e-3, 200))
    figure = Figure()
    figure.subplots().contour(x, y, y - height(x), [0.0])
    points = capture(figure).curves["panel 1", "level 0"]
    between = np.interp(x[0], *points[np.argsort(points[:, 0])].T)
    assert np.abs(between - height(x[0])).max() < 1e-3 * 1e-3


@pytest.mark.parametrize("extend", ["neither", "min", "max", "both"])
def test_areas_beyond_the_levels_are_curves_of_their_own(extend: Any) -> None:
    x, y = np.meshgrid(np.linspace(0.0, 1.0, 50), np.linspace(0.0, 1.0, 50))

    def draw(axes: Any, shift: float) -> None:
        axes.contourf(x, y, x + np.where(x > 0.5, shift, 0.0) * y, [0.2, 0.5, 0.8], extend=extend, colors=list("rgby"))

    figure = Figure()
    draw(figure.subplots(), 0.0)
    ends = {"neither": (), "min": ("below 0.2",), "max": ("0.8",), "both": ("below 0.2", "0.8")}[extend]
    assert {name for _, name in capture(figure).curves} == {f"level {level}" for level in ("0.2", "0.5", *ends)}
    moved = said(draw, 0.0, 0.05)
    assert all("moved" in text for text in moved)
    assert any("level 0.8" in text for text in moved) == ("0.8" in ends)


def test_points_are_counted_where_they_can_be_seen() -> None:
    def draw(axes: Any, more: list[float]) -> None:
        axes.set(xlim=(0, 2), ylim=(0, 2))
        axes.scatter([1.0, 1.5, *more], [1.0, 1.5, *more], alpha=0.5)

    for unseen in (np.nan, 7.0):
        assert said(draw, [], [unseen]) == said(draw, [unseen], []) == []
    assert said(draw, [], [1.0]) == ["curve 'points 1' now has 3 points (was 2)"]


def size_bar(axes: Any, length: float) -> None:
    axes.add_artist(AnchoredSizeBar(axes.transData, length, "20 m", "lower center"))


def disk(axes: Any, radius: float) -> None:
    drawing = DrawingArea(20.0, 20.0)
    drawing.add_artist(Circle((10.0, 10.0), radius))
    axes.add_artist(AnchoredOffsetbox("upper left", child=drawing))


def two_handles(axes: Any, beside: bool) -> None:
    lines = tuple(axes.plot(T, T, color)[0] for color in "rb")
    axes.legend([lines], ["both"], handler_map={tuple: HandlerTuple(ndivide=None if beside else 1)})


@pytest.mark.parametrize(
    ("draw", "values"), [(size_bar, (0.2, 0.21)), (disk, (5.0, 5.3)), (two_handles, (True, False))]
)
def test_drawings_among_texts_have_a_size(draw: Any, values: Any) -> None:
    assert said(draw, values[0], values[0]) == []
    (words,) = said(draw, *values)
    assert "the drawing of " in words


@pytest.mark.parametrize("kind", ["plot", "scatter", "fill_between"])
def test_what_is_turned_before_it_is_data_is_seen_where_it_lies(kind: str) -> None:
    def draw(axes: Any, angle: float) -> None:
        axes.set(xlim=(-1, 1), ylim=(-1, 1))
        axes_and_turn = Affine2D().rotate_deg(angle) + axes.transData
        getattr(axes, kind)([0.2, 0.4, 0.6], [0.1, 0.5, 0.3], transform=axes_and_turn)

    assert said(draw, 20.0, 20.0) == []
    assert len(said(draw, 20.0, 30.0)) == 1
    assert "moved" in said(draw, 20.0, 30.0)[0]


def test_a_line_that_leads_far_away_keeps_its_direction() -> None:
    def draw(axes: Any, height: float) -> None:
        axes.figure.add_artist(Line2D([0.5, 50.0], [0.5, height]))

    assert said(draw, 20.0, 20.0) == []
    assert [text[:13] for text in said(draw, 20.0, 30.0)] == ["line 1 moved "]


def test_texts_of_a_figure_without_axes_are_said_and_placed() -> None:
    def shown(**given: Any) -> Record:
        figure = Figure()
        figure.suptitle("all", x=given.get("x", 0.5))
        figure.text(0.5, given.get("y", 0.5), "words", color=given.get("color", "k"))
        return capture(figure)

    assert compare(shown(), shown(color="r")).changes == ["colour of text 'words' changed from black to red"]
    assert compare(shown(), shown(x=0.2)).changes == ["figure title moved by up to 30 % of the figure"]
    assert compare(shown(), shown(y=0.6)).changes == ["text 'words' moved by up to 10 % of the figure"]


def test_a_curve_that_can_be_seen_now_is_new() -> None:
    assert said(lambda ax, v: ax.plot(T, T, label="b", alpha=v), 0.0, 1.0) == ["curve 'b' is new"]
    assert said(lambda ax, v: ax.plot(T, T, label="b", alpha=v), 1.0, 0.0) == ["curve 'b' is missing"]


@pytest.mark.parametrize(
    ("what", "values", "lines"),
    [("arrowsize", (1, 2), 1), ("color", ("b", "r"), 1), ("arrowstyle", ("-|>", "->"), 2)],
)
def test_the_arrows_of_a_stream_plot_are_spoken_of_together(what: str, values: Any, lines: int) -> None:
    changes = said(lambda ax, v: ax.streamplot(X, Y, Y - 1 - X**2, 1 + X - Y**2, **{what: v}), *values)
    assert len(changes) <= lines
    assert "arrow heads of lines 1" in changes[0]


@pytest.mark.parametrize("change", [{"cmap": "autumn"}, {"color": X}])
def test_arrows_of_many_colours_are_spoken_of_once(change: dict[str, Any]) -> None:
    draw = {"color": Y - 1 - X**2, "density": 0.5}
    changes = said(lambda ax, v: ax.streamplot(X, Y, Y - 1 - X**2, 1 + X - Y**2, **draw | v), {}, change)
    heads = [change for change in changes if "arrow heads" in change]
    assert len(heads) == 1
    assert heads[0].startswith("colour of arrow heads of lines 1 changed from ")
    assert heads[0].endswith(" others likewise")


def stream(axes: Any, given: tuple[Any, Any]) -> None:
    x, y = np.meshgrid(np.linspace(-3.0, 3.0, 20), np.linspace(-2.0, 2.0, 20))
    field, change = given
    u, v = change(x, y, *field(x, y))
    axes.streamplot(x, y, u, v, density=0.5)
    axes.set(xlim=(-3, 3), ylim=(-2, 2))


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("field", [lambda x, y: (y, -x), lambda x, _: (1.0 + 0.0 * x, 0.3 + 0.0 * x)])
def test_which_lines_of_a_field_rounding_chooses_is_not_seen(field: Any, seed: int) -> None:
    noise = np.random.default_rng(seed).normal(size=(2, 20, 20))

    def rounded(_x: Any, _y: Any, u: Any, v: Any) -> Any:
        return u * (1.0 + 1e-13 * noise[0]), v * (1.0 + 1e-13 * noise[1])

    assert said(stream, (field, lambda _x, _y, u, v: (u, v)), (field, rounded)) == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda _x, _y, u, v: (-u, -v), "curve 'lines 1' runs the other way now"),
        (lambda x, y, u, v: (u, v + np.exp(-20.0 * ((x - 2.0) ** 2 + (y - 1.0) ** 2))), "curve 'lines 1' moved"),
        (lambda _x, _y, u, v: (u, 1.02 * v), "curve 'lines 1' moved"),
    ],
)
def test_another_field_is_seen_also_in_a_corner(change: Any, words: str) -> None:
    def field(x: Any, y: Any) -> Any:
        return -1.0 - x**2 + y, 1.0 + x - y**2

    assert words in "\n".join(said(stream, (field, lambda _x, _y, u, v: (u, v)), (field, change)))


def test_bars_that_all_move_are_spoken_of_together() -> None:
    changes = said(lambda ax, v: (ax.bar(range(9), np.arange(9) + v), ax.set_ylim(0, 20)), 1.0, 3.0)
    start = "curve 'shape 1', curve 'shape 2' and 7 more differ, most of all this one: curve 'shape "
    assert [text[: len(start)] for text in changes] == [start]


def test_one_curve_more_is_new_though_the_others_have_other_numbers() -> None:
    def draw(axes: Any, slopes: Any) -> None:
        axes.set_ylim(0, 4)
        for slope in slopes:
            axes.plot([0, 1], [0, slope], color="k")

    assert said(draw, (2, 3), (1, 2, 3)) == ["curve 'line 1' is new"]
    assert said(draw, (1, 2, 3), (2, 3)) == ["curve 'line 1' is missing"]


def test_what_no_reader_knows_is_numbered_anew_as_well() -> None:
    def draw(axes: Any, order: Any) -> None:
        axes.set(xlim=(-1, 4), ylim=(-1, 4))
        for place in order:
            axes.quiver([place], [place], [1], [place - 1])

    assert said(draw, (0, 1, 2), (2, 0, 1)) == []
    assert said(draw, (0, 1, 2), (0, 2)) == ["Quiver 2 is gone"]


def test_a_text_that_reads_otherwise_is_one_change_with_its_box_and_arrow() -> None:
    def draw(axes: Any, words: Any) -> None:
        for place, word in enumerate(words):
            arrow, box = {"arrowstyle": "->"}, {"boxstyle": "round"}
            axes.annotate(word, (0.1, 0.1), (0.3 * place, 0.5), arrowprops=arrow, bbox=box)

    assert said(draw, ("a", "b", "c"), ("a", "a", "c")) == ["text 'b' now reads 'a'"]


def test_a_label_that_is_none_is_no_label() -> None:
    bins = T[::10]
    changes = said(lambda ax, v: ax.hist(T + v, bins=bins, histtype="step"), 0.0, 0.5)
    assert changes
    assert not any("None" in text for text in changes)


def test_curves_on_guest_axes_are_read() -> None:
    records = []
    for factor in (1.0, 1.1):
        figure = Figure()
        guest: Any = host_subplot(111, figure=figure).twinx()
        guest.plot(T, factor * T)
        guest.set_ylim(0, 20)
        records.append(capture(figure))
    assert compare(*records).changes == ["curve 'line 1' in 'panel 2' moved: at most 1 (5 % of the axis) at x = 10"]


def test_periods_are_months_and_no_days() -> None:
    pandas = pytest.importorskip("pandas")

    def draw(axes: Any, start: str) -> None:
        pandas.Series(range(12), index=pandas.period_range(start, periods=12, freq="M")).plot(ax=axes)

    assert said(draw, "2024-01", "2024-02")[0] == "x axis now begins at 2024-02 (was 2024-01)"


CORNERS = ((0.1, 0.1), (0.6, 0.1), (0.1, 0.6))


def panels(figure: Any, order: Any, more: float = 0.0) -> None:
    """Draw one panel in each corner, made in this order, a steeper line in each."""
    figure.suptitle("all")
    for place in order:
        axes = figure.add_axes((*CORNERS[place], 0.3, 0.3))
        axes.plot([0, 1], [0, place + 1 + (more if place == 1 else 0.0)])
        axes.set_ylim(0, 4)


@pytest.mark.parametrize(
    ("before", "after", "what"),
    [
        ("012", "201", ""),
        ("012", "12", "panel 'panel 1' is gone"),
        ("012", "02", "panel 'panel 2' is gone"),
        ("12", "012", "panel 'panel 1' is new"),
        ("10", "01", ""),
    ],
)
def test_untitled_panels_are_known_by_what_they_show_and_where_they_stand(before: str, after: str, what: str) -> None:
    records = []
    for order in (before, after):
        figure = Figure()
        panels(figure, map(int, order))
        records.append(capture(figure))
    assert compare(*records).changes == ([what] if what else [])


def test_what_changed_in_a_panel_is_said_of_it_in_whatever_order_they_are_made() -> None:
    records = []
    for order, more in (((0, 1, 2), 0.0), ((2, 0, 1), 0.4)):
        figure = Figure()
        panels(figure, order, more)
        records.append(capture(figure))
    changes = compare(*records).changes
    assert [text[:35] for text in changes] == ["curve 'line 1' in 'panel 2' moved: "]


def test_guests_keep_their_hosts_and_lie_where_they_lay_though_another_panel_was_made_first() -> None:
    records = []
    for first in (False, True):
        figure = Figure()
        if first:
            figure.add_axes((0.1, 0.8, 0.8, 0.1))
        host = figure.add_axes((0.1, 0.1, 0.8, 0.6))
        host.plot([0, 1])
        host.twinx().plot([0, 5])
        if not first:
            figure.add_axes((0.1, 0.8, 0.8, 0.1))
        records.append(capture(figure))
    assert compare(*records).changes == []

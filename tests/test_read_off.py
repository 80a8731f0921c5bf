"""Points read off a printed figure: drawn over our curve, judged within their reading error."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path

import matplotlib.figure
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from replicate.errors import PaperDefinitionError, PrintedFileError
from replicate.exhibits.read_off import LABEL, Point, read_points, values_at, with_points

Run = Callable[..., tuple[int, str, str]]

HEADER = "point,curve,x,y,x_error,y_error\n"

_PAPER = """
from replicate.exhibits import Paper

paper = Paper(
    id="decay", package=__name__, title="Decay", authors=("N. N.",), citation="N. N., 2000.", year=2000,
    modules=("fig_1",), numbered=("fig-1",),
)
"""
_FIGURE = """
import math

from decay import paper


@paper.figure("fig-1", "A decay", points=True)
def fig_1(fig):
    axes = fig.subplots()
    times = [place / 10 for place in range(51)]
    axes.plot(times, [math.exp(-time) for time in times], label="decay")
"""


def draw(fig: matplotlib.figure.Figure) -> None:
    axes = fig.subplots()
    axes.plot([0.0, 1.0, 2.0], [0.0, 2.0, 2.0], label="line")
    axes.axvline(5.0, label="wall")


def written(folder: Path, text: str) -> Path:
    path = folder / "fig-1.csv"
    path.write_text(HEADER + text, encoding="utf-8")
    return path


def test_values_are_those_nearest_to_the_point_within_the_error_of_x(tmp_path: Path) -> None:
    points = read_points(written(tmp_path, "a,line,0.5,1.1,0.1,0.1\nb,line,0.5,1.5,0.1,0.1\nc,line,1.5,2.1,0,0.1\n"))
    values = values_at(draw, points, (4.0, 3.0))["y"]
    assert values["a"] == pytest.approx(1.1)  # the line passes 1.1 between x = 0.4 and 0.6
    assert values["b"] == pytest.approx(1.2)  # its highest there
    assert values["c"] == 2.0


def test_a_curve_is_what_is_drawn(tmp_path: Path) -> None:
    def scales(fig: matplotlib.figure.Figure) -> None:
        left, right = fig.subplots(1, 2)
        left.loglog([1.0, 100.0], [1.0, 1e-4], label="slope")
        left.axhline(0.5, label="limit")
        right.step([0.0, 1.0, 2.0], [0.0, 1.0, 3.0], where="post", label="stairs")

    text = (
        "a,slope,10,0.02,0,0.01\n"  # x^-2, straight on these axes
        "b,slope,10,0.02,5,0.01\n"  # which passes 0.02 at x = 7.07
        "c,limit,50,0.4,0,0.1\n"
        "d,stairs,1.5,2.0,0,0.1\n"
        "e,stairs,−0.5,2.0,0.6,0.1\n"  # a minus sign of typesetters
        "f,stairs,1.5,0.9?,0,0.1\n"
        "g,stairs,2.5,2.0,0.1,0.1\n"  # beyond the curve
    )
    values = values_at(scales, read_points(written(tmp_path, text)), (4.0, 3.0))["y"]
    assert values["a"] == pytest.approx(10.0**-2)
    assert values["b"] == pytest.approx(0.02)
    assert values["c"] == pytest.approx(0.5)
    assert (values["d"], values["e"], values["f"]) == (1.0, 0.0, 1.0)
    assert pd.isna(values["g"])


def test_several_curves_of_one_label_need_their_panel(tmp_path: Path) -> None:
    def panels(fig: matplotlib.figure.Figure) -> None:
        for number, axes in enumerate(fig.subplots(1, 2)):
            axes.plot([0.0, 1.0], [0.0, 1.0 + number], label="line")
            axes.set_title(f"({'ab'[number]})")

    points = read_points(written(tmp_path, "a,line,0.5,1.1,0.1,0.1\n"))
    for read in (lambda: values_at(panels, points, (4.0, 3.0)), lambda: with_points(panels, points)(Figure())):
        with pytest.raises(
            PaperDefinitionError, match=r"fig-1\.csv:2: point 'a': 2 curves are 'line'.*: '\(a\)', '\(b"
        ):
            read()
    path = tmp_path / "fig-1.csv"
    path.write_text(HEADER.replace("\n", ",panel\n") + "a,line,0.5,1.1,0,0.1,(b)\n", encoding="utf-8")
    assert values_at(panels, read_points(path), (4.0, 3.0))["y"]["a"] == pytest.approx(1.0)


def test_points_are_drawn_over_the_figure(tmp_path: Path) -> None:
    points = read_points(written(tmp_path, "a,line,0.5,1.1,0.1,0.1\nb,wall,5.0,1.5,0,0.3\n"))
    fig = matplotlib.figure.Figure()
    with_points(draw, points)(fig)
    (marks,) = (line for line in fig.axes[0].lines if line.get_label() == LABEL)
    assert np.array_equal(np.asarray(marks.get_xydata()), [[0.5, 1.1], [5.0, 1.5]])


def test_a_curve_that_is_not_there(tmp_path: Path) -> None:
    points = read_points(written(tmp_path, "a,lime,0.5,1.1,0.1,0.1\n"))
    with pytest.raises(
        PaperDefinitionError, match=r"fig-1\.csv:2: point 'a': there is no curve 'lime'; curves: 'line', 'wall'"
    ):
        values_at(draw, points, (4.0, 3.0))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,line,0.5,x,0.1,0.1\n", "fig-1.csv:2: column 'y': 'x' is not a number"),
        ("a,line,0.5,1,0.1,-0.1\n", "fig-1.csv:2: column 'y_error': '-0.1' is not a number that is not negative"),
        ("a,line,1,1,0,0\na,line,1,1,0,0\n", "fig-1.csv:3: point 'a' appears twice"),
        ("", "fig-1.csv:1: holds no point"),
        ("a,line,0,5,1,1,0,1,0,1\n", "fig-1.csv:2: has 10 cells, the header has 6; numbers have decimal points"),
        ("a,line,0.5,1,0.1\n", "fig-1.csv:2: column 'y_error': '' is not a number"),
        ('a,line,"0,5",1,0.1,0.1\n', "fig-1.csv:2: column 'x': '0,5' is not a number"),
    ],
)
def test_damaged_files(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(PrintedFileError, match=message):
        read_points(written(tmp_path, text))


def test_a_paper_with_points(replicate: Run) -> None:
    folder = Path("papers/decay")
    (folder / "printed").mkdir(parents=True)
    (folder / "__init__.py").write_text(_PAPER)
    (folder / "fig_1.py").write_text(_FIGURE)
    (folder / "printed" / "fig-1.csv").write_text(
        HEADER + "early,decay,1.0,0.38,0.05,0.02\nlate,decay,3,0.15,0.05,0.02\n"
    )
    status, _, err = replicate("report", "decay", "--papers", "papers", "-j1", "--no-cache")
    assert status == 0, err
    verdicts = Path("build/verdicts.csv").read_text().splitlines()[1:]
    assert [line.split(",")[2:6] for line in verdicts] == [
        ["early", "y", "0.38", "reproduced"],
        ["late", "y", "0.15", "unexplained"],
    ]


@pytest.mark.parametrize("nothing", ["pass", "import matplotlib.pyplot as plt; plt.plot([1])", "fig.subplots()"])
def test_a_figure_with_points_that_draws_nothing_is_empty(nothing: str) -> None:
    def draw_nothing(fig: matplotlib.figure.Figure) -> None:
        exec(nothing, {"fig": fig})  # noqa: S102  -- what a careless author writes

    points = [Point("p1", "line", 1.0, "2", 0.1, 0.1)]
    fig = matplotlib.figure.Figure()
    drawn = with_points(draw_nothing, points)
    drawn(fig)
    assert not any(axes.has_data() for axes in fig.axes)
    assert inspect.unwrap(drawn) is draw_nothing  # whose file and line the message names
    plt.close("all")


def test_what_a_wrong_function_returns_is_handed_on() -> None:
    async def late(fig: matplotlib.figure.Figure) -> None:
        draw(fig)

    made = with_points(late, [Point("p1", "line", 1.0, "2", 0.1, 0.1)])(matplotlib.figure.Figure())
    assert inspect.iscoroutine(made)
    made.close()

"""Points read off a printed figure: drawn over our curve, judged within their reading error."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib.figure
import pytest

from replicate.errors import PaperDefinitionError, PrintedFileError
from replicate.exhibits.read_off import LABEL, read_points, values_at, with_points

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


def test_points_are_drawn_over_the_figure(tmp_path: Path) -> None:
    points = read_points(written(tmp_path, "a,line,0.5,1.1,0.1,0.1\n"))
    fig = matplotlib.figure.Figure()
    with_points(draw, points)(fig)
    assert [container.get_label() for container in fig.axes[0].containers] == [LABEL]


def test_a_curve_that_is_not_there(tmp_path: Path) -> None:
    points = read_points(written(tmp_path, "a,lime,0.5,1.1,0.1,0.1\n"))
    with pytest.raises(PaperDefinitionError, match="point 'a': there is no curve 'lime'; curves: 'line', 'wall'"):
        values_at(draw, points, (4.0, 3.0))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,line,0.5,x,0.1,0.1\n", "fig-1.csv:2: column 'y': 'x' is not a number"),
        ("a,line,0.5,1,0.1,-0.1\n", "fig-1.csv:2: column 'y_error': '-0.1' is not a number that is not negative"),
        ("a,line,1,1,0,0\na,line,1,1,0,0\n", "fig-1.csv:3: point 'a' appears twice"),
        ("", "fig-1.csv:1: holds no point"),
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

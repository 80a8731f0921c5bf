"""A page that would be too heavy gives way where it is heaviest, says so, and keeps what is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from synthetic import FolderPaper

from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import FigureResult, Results, TableResult
from replicate.report import build_report
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge

MOST_BYTES, MOST_ELEMENTS = 2_000_000, 25_000
ROWS = [f"r{number}" for number in range(700)]
COLUMNS = ["a", "b", "c"]
WRONG = [("r2", "a"), ("r350", "b"), ("r699", "c")]


def frame() -> pd.DataFrame:
    return pd.DataFrame({column: np.arange(700.0) for column in COLUMNS}, index=ROWS)


def scattered(fig: object) -> None:
    msg = f"nothing is drawn on {fig}: the test brings the drawing"
    raise AssertionError(msg)


def drawing(points: int) -> str:
    """Return a drawing with many points, as matplotlib writes them."""
    marks = "".join(f'<g><path d="M {x} {x % 97} L 1 1" style="fill: #123456"/></g>' for x in range(points))
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><g id="axes_1">{marks}</g></svg>'


def test_a_page_on_which_all_is_wrong_is_within_the_limits(tmp_path: Path) -> None:
    paper = FolderPaper("wrong", "wrong", "Wrong", ("N. N.",), "Wrong (2000)", 2000, (), ())
    paper.data_folder = tmp_path
    rows = ROWS
    paper.table("table-1", "All", rows=rows, columns=COLUMNS).reading("as-written", "As written")(frame)
    paper._loaded = True
    printed: dict[Key, PrintedValue] = {
        (row, column): PrintedValue("99999", row, column) for row in rows for column in COLUMNS
    }
    results: Results = {("wrong", "table-1"): TableResult("wrong", "table-1", {"as-written": frame().loc[rows]})}
    judgement = judge(paper, results, Inputs({"table-1": printed}))
    for path in build_report([paper], results, judgement, tmp_path / "report"):
        text = path.read_text(encoding="utf-8")
        assert len(text.encode()) <= MOST_BYTES, path.name
        assert text.count("<") - text.count("</") <= MOST_ELEMENTS, path.name
    text = (tmp_path / "report" / "wrong.html").read_text(encoding="utf-8")
    shown = re.search(r"(\d+) of 700 rows are shown, to keep the page light: first those", text)
    assert shown is not None
    assert int(shown[1]) == text.count('<tr class="printed">') >= 100
    assert "And 1900 more for the same reason" in text  # of 2100, in the list of what is wrong


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the page of a paper with a table of 2,100 printed values and a figure of 20,000 points."""
    folder = tmp_path_factory.mktemp("heavy")
    paper = FolderPaper("heavy", "heavy", "Heavy", ("N. N.",), "Heavy (2000)", 2000, (), ())
    paper.data_folder = folder
    paper.table("table-1", "Many", rows=ROWS, columns=COLUMNS).reading("as-written", "As written")(frame)
    paper.table("table-2", "Few", rows=["A"], columns=["x"]).reading("as-written", "As written")(frame)
    paper.figure("fig-1", "Points", alt="Points all over.")(scattered)
    paper._loaded = True
    printed: dict[Key, PrintedValue] = {
        (row, column): PrintedValue(str(99999 if (row, column) in WRONG else number), row, column)
        for number, row in enumerate(ROWS)
        for column in COLUMNS
    }
    results: Results = {
        ("heavy", "table-1"): TableResult("heavy", "table-1", {"as-written": frame()}),
        ("heavy", "table-2"): TableResult("heavy", "table-2", {"as-written": pd.DataFrame({"x": [1.0]}, index=["A"])}),
        ("heavy", "fig-1"): FigureResult("heavy", "fig-1", drawing(20_000), b"png", pd.DataFrame(), []),
    }
    inputs = Inputs({"table-1": printed, "table-2": {("A", "x"): PrintedValue("1.0", "A", "x")}})
    judgement = judge(paper, results, inputs)
    build_report([paper], results, judgement, folder / "report")
    return (folder / "report" / "heavy.html").read_text(encoding="utf-8")


def exhibit(page: str, id: str) -> str:
    return re.split(r'(?=<section class="exhibit)', page.partition(f' id="{id}">')[2])[0]


def test_a_heavy_page_is_within_the_limits(page: str) -> None:
    assert len(page.encode()) <= MOST_BYTES
    assert page.count("<") - page.count("</") <= MOST_ELEMENTS


def test_what_is_wrong_stays_with_its_cards(page: str) -> None:
    table = exhibit(page, "table-1")
    for row, column in WRONG:
        cell = table.partition(f'id="table-1.{row}.{column}"')[2].partition("</td>")[0]
        assert "99999" in cell
        assert 'class="card unexplained"' in cell
    assert table.count('class="card ') == len(WRONG)
    assert "Press one of the symbols that are buttons" in table
    assert table.count('<tr class="printed">') == len(ROWS)


def test_exhibits_that_are_light_give_nothing(page: str) -> None:
    assert 'class="card reproduced"' in exhibit(page, "table-2")


def test_a_heavy_drawing_is_a_picture_beside_the_page(page: str) -> None:
    figure = exhibit(page, "fig-1")
    (image,) = re.findall(r"<img [^>]*>", figure)
    assert re.search(r'src="data/figures/heavy/fig-1\.(svg|png)"', image)
    assert 'alt="Points all over."' in image
    assert "is a picture beside this page" in figure
    assert "img-src data: 'self';" in page


def test_other_pages_show_no_pictures_beside_them(page: str, tmp_path: Path) -> None:
    assert page  # the heavy one was built
    paper = FolderPaper("light", "light", "Light", ("N. N.",), "Light (2000)", 2000, (), ())
    paper.data_folder = tmp_path
    paper._loaded = True
    for path in build_report([paper], {}, judge(paper, {}, Inputs()), tmp_path / "report"):
        assert "img-src data:;" in path.read_text(encoding="utf-8")

"""Charts for parameters of the reader's choice: arguments, files and errors."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from command import status_of
from matplotlib.figure import Figure as Canvas

from replicate.errors import OutputError, PaperDefinitionError, ReplicateError, UnknownPaperError
from replicate.exhibits import Paper
from replicate.run.charts import draw_chart, file_name, find_chart, read_parameters


@pytest.fixture
def paper() -> Paper:
    paper = Paper("lab", "lab", "A laboratory", ("N. N.",), "N. N., 2000.", 2000, modules=(), numbered=())

    @paper.chart("decay", "A decay", parameters={"rate": "per second", "until": "seconds"}, size=(3.0, 2.0))
    def draw(fig: Canvas, rate: float, until: float) -> None:
        if rate <= 0.0:
            msg = f"rate must be positive, not {rate:g}"
            raise ValueError(msg)
        t = np.linspace(0.0, until, 201)
        fig.subplots().plot(t, np.exp(-rate * t))

    @paper.chart("other", "Another", parameters={"x": "anything"})
    def other(fig: Canvas, x: float) -> None:
        fig.subplots().set_title(f"{x:g}")

    return paper


def test_the_first_chart_is_the_default_and_others_go_by_name(paper: Paper) -> None:
    assert find_chart(paper).id == "decay"
    assert find_chart(paper, "other").id == "other"
    with pytest.raises(UnknownPaperError, match="no chart 'third'; known: decay, other"):
        find_chart(paper, "third")
    with pytest.raises(PaperDefinitionError, match="defined twice"):
        paper.chart("decay", "Again", parameters={"x": ""})
    with pytest.raises(PaperDefinitionError, match="no parameters"):
        paper.chart("plain", "Plain", parameters={})


@pytest.mark.parametrize("arguments", [["--until", "3", "--rate", "0.5"], ["--rate=0.5", "--until=3"]])
def test_parameters_are_read_in_either_form(paper: Paper, arguments: list[str]) -> None:
    assert read_parameters(find_chart(paper), arguments) == {"rate": 0.5, "until": 3.0}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "needs --rate: per second"),
        (["--rate", "1"], "needs --until"),
        (["--rate"], "--rate needs a value"),
        (["--rate", "fast"], "'fast' is not a number"),
        (["--rate", "inf"], "'inf' is not a number"),
        (["--rate", "1", "--rate", "2"], "given twice"),
        (["--speed", "1"], "'--speed' is not a parameter"),
        (["rate", "1"], "'rate' is not a parameter"),
    ],
)
def test_what_is_wrong_with_the_parameters_is_said(paper: Paper, arguments: list[str], said: str) -> None:
    with pytest.raises(ReplicateError, match=re.escape(said)):
        read_parameters(find_chart(paper), arguments)


def test_files(paper: Paper, tmp_path: Path) -> None:
    chart, values = find_chart(paper), {"rate": 0.5, "until": 3.0}
    assert file_name(paper, chart, values) == "lab-decay-rate-0.5-until-3.svg"
    assert file_name(paper, chart, values | {"rate": 0.12345678}) == "lab-decay-rate-0.12345678-until-3.svg"
    svg, again, png = (tmp_path / "new" / name for name in ("a.svg", "b.svg", "a.png"))
    (tmp_path / "new").mkdir()
    for path in (svg, again, png):
        path.write_bytes(draw_chart(paper, chart, values, path))
    assert svg.read_text().startswith("<?xml")
    assert svg.read_bytes() == again.read_bytes()
    assert png.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(OutputError, match=r"must end in \.svg or \.png"):
        draw_chart(paper, chart, values, tmp_path / "a.txt")
    with pytest.raises(ReplicateError, match="chart 'decay': rate must be positive, not -1"):
        draw_chart(paper, chart, {"rate": -1.0, "until": 3.0}, svg)


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    run = partial(status_of, "chart")
    assert run("krajewski", "--chart", "design", "--tau", "0.35") == 0
    assert capsys.readouterr().out == "chart: build/charts/krajewski-design-tau-0.35.svg\n"
    assert (tmp_path / "build/charts/krajewski-design-tau-0.35.svg").is_file()
    assert run("krajewski", "--out", "mine.svg", "--chart=design", "--tau=0.35") == 0
    assert (tmp_path / "mine.svg").read_bytes() == (
        tmp_path / "build/charts/krajewski-design-tau-0.35.svg"
    ).read_bytes()
    capsys.readouterr()
    (tmp_path / "own.svg").write_text("mine", encoding="utf-8")
    assert run("krajewski", "--out", "own.svg", "--chart=design", "--tau=0.35") == 2
    assert "replicate: own.svg: is in the way" in capsys.readouterr().err
    assert (tmp_path / "own.svg").read_text(encoding="utf-8") == "mine"
    assert run("krajewski", "--out", "mine.svg/a.svg", "--chart=design", "--tau=0.35") == 2
    assert capsys.readouterr().err.startswith("replicate: mine.svg: cannot be written: ")
    assert run("krajewski", "--tau", "0") == 2
    assert capsys.readouterr().err == "replicate: chart 'combined': tau must be between 0.01 and 20, not 0\n"
    assert run("bayhan", "--tau", "1") == 2
    assert capsys.readouterr().err == "replicate: bayhan has no charts\n"

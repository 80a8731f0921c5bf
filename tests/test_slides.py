"""Slides: as many as the text has headings, one figure each, and whatever does not fit is an error."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import synthetic
import toy_class

from replicate.errors import TemplateError
from replicate.exhibits.results import FigureResult
from replicate.handout.edition import Document, edition
from replicate.handout.slides import slides
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger

SLIDE = "\n## Slide {number}\n\nWords with $x_1 = {{{{ value('table-1', 'A', 'y', digits=3) }}}}$.\n\n{figure}\n"
AXES = {"title": "", "xlabel": "t", "ylabel": "y", "xlim": [0, 1], "ylim": [0, 1], "legend": []}
FIGURE = "{{ figure('fig-1') }}\nIts caption."
DOTS = "{{ dots('table-1', columns=['x'], readings={'as-written': 'recomputed'}) }}"

Make = Callable[..., Document]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Make the slides of a small paper from their text."""

    def document(text: str, *, only_read: bool = False) -> Document:
        (tmp_path / "toy").mkdir(exist_ok=True)
        (tmp_path / "toy" / "slides.md").write_text(text, encoding="utf-8")
        paper = synthetic.paper(tmp_path / "toy")
        results = synthetic.results(as_written=synthetic.frame(ax=0.5, ay=98.765))
        figure = results["toy", "fig-1"]
        assert isinstance(figure, FigureResult)
        results["toy", "fig-1"] = replace(figure, svg=toy_class.SVG, axes=[AXES])
        judged = judge(paper, results, Inputs(synthetic.printed(), Ledger()))
        return edition(paper, results, judged.verdicts, solutions=False, kind="slides", only_read=only_read)

    return document


def text_of(count: int, figure: str = FIGURE) -> str:
    """Return a text of so many slides, the last of which has another figure."""
    some = "".join(SLIDE.format(number=number, figure=FIGURE) for number in range(2, count))
    return f"# A story\n\n::: lead\nWhy?\n:::\n\n{FIGURE}\n{some}{SLIDE.format(number=count, figure=figure)}"


def test_each_heading_begins_a_slide_of_the_shape_of_a_screen(make: Make) -> None:
    content = slides(make(text_of(6)))
    assert len(re.findall(rb"/Type\s*/Page\b", content)) == 6
    ((width, height),) = set(re.findall(rb"/MediaBox\s*\[0 0 ([\d.]+) ([\d.]+)\]", content))
    assert float(width) / float(height) == pytest.approx(16 / 9, rel=1e-3)
    assert b"<pdfuaid:part>1</pdfuaid:part>" in content
    assert slides(make(text_of(6))) == content


def test_dots_stand_where_the_numbers_are(make: Make) -> None:
    document = make(text_of(5, DOTS))
    (drawn,) = (drawing for drawing in document.drawings.values() if drawing.name.startswith("dots"))
    assert "as printed, recomputed" in drawn.alt
    rings = re.findall(r'<use xlink:href="#\w+" x="([\d.]+)"[^>]*stroke: #595959', drawn.svg)
    assert len(rings) >= 2  # one for each printed number of the column, and that of the legend
    assert "98.8" in str(document.formulas)  # a number of the text comes from the results


def test_who_only_reads_a_text_draws_nothing(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("replicate.handout.placing.pictures_of", None)
    assert make(text_of(5, DOTS), only_read=True).drawings
    with pytest.raises(TemplateError, match="no column 'z'"):
        make(text_of(5, "{{ dots('table-1', columns=['z']) }}"), only_read=True)
    with pytest.raises(TemplateError):
        make(text_of(5, DOTS))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (text_of(4), "toy/slides.md: 4 slides, allowed: 5 to 8; each heading begins one"),
        (text_of(9), "toy/slides.md: 9 slides, allowed: 5 to 8"),
        (text_of(5, "No figure."), "the slide 'Slide 5' has no figures, allowed: one"),
        (text_of(5, f"{FIGURE}\n\n{DOTS}"), "the slide 'Slide 5' has 2 figures, allowed: one"),
        (text_of(5, "{{ table('table-1') }}\n\n" + FIGURE), "the slide 'Slide 5' has a table"),
        (text_of(5, "A paragraph.\n\n" * 12 + FIGURE), "too little room for a figure"),
        (text_of(5, FIGURE + "\n\n" + "A paragraph.\n\n" * 40), "cannot be typeset: panicked with"),
        (
            text_of(5, "{{ dots('table-1', columns=['z']) }}"),
            "toy/slides.md:35: dots('table-1'): there is no column 'z'; allowed: x, y",
        ),
        (text_of(5, "{{ dots('table-9') }}"), "dots('table-9'): no such table was computed; the paper has: 'table-1'"),
    ],
)
def test_what_is_no_slide_is_one_line(make: Make, text: str, message: str) -> None:
    with pytest.raises(TemplateError, match=re.escape(message)) as raised:
        slides(make(text))
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--variants", "2"], "--variants is about exercises, and slides have none"),
        (["--points", "2"], "--points is about exercises"),
        (["--solutions"], "--solutions is about exercises"),
    ],
)
def test_options_of_exercises_are_refused(
    replicate: Callable[..., tuple[int, str, str]], options: list[str], message: str
) -> None:
    status, _, errors = replicate("handout", "bayhan", "--bundled", "--format", "slides", *options)
    assert status == 2
    assert message in errors

"""What a lecturer sets for all sheets: which exercises, points, title, date, language; the code on each page."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import pytest
import toy_class

from replicate.errors import ReplicateError
from replicate.handout import Form, Sheet, handouts
from replicate.handout.edition import edition
from replicate.handout.printout import form_code, markup, pdf
from replicate.handout.webpage import webpage
from replicate.languages import language
from replicate.resources import templates_dir


def test_a_selection_keeps_numbers_and_is_part_of_the_form(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(select=(2, 3)))
    files = dict(toy.files(["Ada"], "1"))
    rows = list(csv.DictReader(io.StringIO(files["toy-key.csv"].decode())))
    assert {row["exercise"] for row in rows} == {"sums"}
    form = Form.read(rows[0]["form"])
    assert form.select == (2, 3)
    source = markup(edition(toy.paper, toy.results, (), solutions=False, form=form, sheet=Sheet(select=form.select)))
    assert re.findall(r"Exercise (\d)", source) == ["2", "3"]
    assert "Divide" not in source
    assert list(toy.again(form)) == [(f"toy-{form.key}.pdf", files["toy-Ada.pdf"])]
    whole = dict(toy_class.class_set(tmp_path, monkeypatch).files(["Ada"], "1"))["toy-key.csv"].decode()
    numbers = [row["answer"] for row in csv.DictReader(io.StringIO(whole)) if row["exercise"] == "sums"]
    assert [row["answer"] for row in rows] == numbers  # a selection changes no numbers


def test_points_title_and_date_are_on_the_sheet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = Sheet(title="Week 3: «PI» & more", date="30 November 2026", points=(4.0, 1.0, 2.5))
    toy = toy_class.class_set(tmp_path, monkeypatch)
    document = edition(toy.paper, toy.results, (), solutions=False, sheet=sheet)
    source, page = markup(document), webpage(document)
    assert re.findall(r"#tool\[(.*?)\]", source) == ["4 points", "Python, 1 point", "2.5 points"]
    assert "30 November 2026" in source
    assert "30 November 2026" in page
    assert "<h1>Week 3: «PI» &amp; more</h1>" in page
    assert "Week 3: «PI» &".encode("utf-16-be").hex() in pdf(document).hex() or b"Week 3" in pdf(document)


def test_a_page_names_formulas_in_headings_and_keeps_them_with_their_punctuation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch)
    page = webpage(edition(toy.paper, toy.results, (), solutions=True, sheet=toy.sheet))
    (why,) = re.findall(r"<h3>[^\n]*Why <span class=\"tied\">(<math .*?</math>)\?</span>", page)
    assert re.search(r"<math [^>]*aria-label=\"([^\"]*)\"", why)[1] == "x is less than y"  # type: ignore[index]
    ends = re.findall(r"display=\"inline\"[^>]*>(?:(?!</math>).)*</math>([,.;:!?)][^\n]{,7})", page)
    assert len(ends) > 2
    assert all(end[1:] == "</span>" for end in ends)
    assert ".tied { white-space: nowrap; }" in page


def test_a_german_sheet_with_english_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch)
    document = edition(toy.paper, toy.results, (), solutions=True, sheet=Sheet(language=language("de"), points=(1.0,)))
    source, page = markup(document), webpage(document)
    assert "Aufgabe 1" in source
    assert "1 Punkt" in source
    assert '<html lang="en-GB">' in page  # what is in it is English
    assert '<p class="kicker" lang="de-DE">Arbeitsblatt mit Lösungen</p>' in page
    assert "<strong>Lösung</strong>" in page
    assert b"<pdfuaid:part>1</pdfuaid:part>" in pdf(document)


def test_a_text_in_the_language_is_used_if_there_is_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch)
    german = "# Spielzeug\n\n## Aufgaben\n\n::: exercise\n## Teilen\nWas ist 1/4?\n:::\n"
    (tmp_path / "toy" / "handout.de.md").write_text(german, encoding="utf-8")
    document = edition(toy.paper, toy.results, (), solutions=False, sheet=Sheet(language=language("de")))
    assert document.title == "Spielzeug"
    assert '<html lang="de-DE">' in webpage(document)
    assert re.search(rb"<dc:language>.*>de-DE<", pdf(document), re.DOTALL)


def test_a_third_language_is_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    english = (templates_dir() / "languages" / "en.toml").read_text(encoding="utf-8")
    (tmp_path / "fr.toml").write_text(
        english.replace('"gb"', '"fr"').replace('"Exercise"', '"Exercice"'), encoding="utf-8"
    )
    toy = toy_class.class_set(tmp_path, monkeypatch)
    french = Sheet(language=language(str(tmp_path / "fr.toml")))
    assert "Exercice 1" in markup(edition(toy.paper, toy.results, (), solutions=False, sheet=french))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("region = 'fr'", r"sv.toml: needs a text 'region' and a table \[words\]"),
        ("region = 1\n[words]\n", "needs a text 'region'"),
        ("region = ''\n[words]\nhandout = 'H'\n", r"sv.toml: \[words\] lacks 'about'"),
        ("[words\n", "sv.toml:1: is not readable TOML"),
    ],
)
def test_a_language_that_is_incomplete_is_one_line(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "sv.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ReplicateError, match=message):
        language(str(tmp_path / "sv.toml"))


def test_every_language_has_all_words() -> None:
    files = sorted(path.stem for path in (templates_dir() / "languages").glob("*.toml"))
    assert {"de", "en"} <= set(files)
    for tag in files:
        assert language(tag).words.keys() == language("en").words.keys()


def test_the_code_on_a_sheet_is_its_form() -> None:
    """Modules read out of the SVG are those of a QR code made from the text alone."""
    import segno

    form = "bayhan:2b6cdeb0ee62:2026W:2.4"
    drawn = form_code(form).decode()
    assert drawn == form_code(form).decode()
    modules = {(int(x), int(y)) for x, y in _dark(drawn)}
    expected = segno.make_qr(form, error="m", boost_error=False).matrix
    assert modules == {(x, y) for y, row in enumerate(expected) for x, dark in enumerate(row) if dark}


def _dark(svg: str) -> list[tuple[int, int]]:
    """Follow the path of horizontal strokes, one per run of dark modules."""
    x, y, dark = 0.0, 0.0, []
    for command, numbers in re.findall(r"([MmhHvV])([^MmhHvVz\"]*)", re.findall(r' d="([^"]*)"', svg)[0]):
        values = [float(value) for value in re.findall(r"-?\d*\.?\d+", numbers)]
        if command == "M":
            x, y = values
        elif command == "m":
            x, y = x + values[0], y + values[1]
        elif command == "h":
            dark += [(int(x + step), int(y)) for step in range(int(values[0]))]
            x += values[0]
    return dark


def test_each_page_of_a_sheet_has_the_form_and_the_shared_handout_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch)
    ((_, content),) = handouts([toy.paper], toy.results, (), solutions=[False])
    form = Form.of("toy", "1", "Ada")
    assert str(form) in markup(edition(toy.paper, toy.results, (), solutions=False, form=form))
    assert "<form>" not in markup(edition(toy.paper, toy.results, (), solutions=False))
    assert len(content) < len(dict(toy.files(["Ada"], "1"))["toy-Ada.pdf"])

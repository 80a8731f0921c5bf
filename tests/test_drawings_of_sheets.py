"""Figures of a class's sheets: no two threads draw at once, and an artist draws both kinds of pictures elsewhere."""

from __future__ import annotations

import io
import threading
import xml.etree.ElementTree as ET
from base64 import b64decode
from pathlib import Path

import pytest
import toy_class
from matplotlib import image

from replicate.errors import ReplicateError
from replicate.handout import Form, Sheet, own_exercises
from replicate.handout.artist import Artist
from replicate.handout.drawings import Wanted
from replicate.handout.edition import AT_ONCE
from replicate.papers.bayhan import paper as bayhan

TEXT = "# A toy\n\n## Exercises\n"
OWN_TEXT = """## Read
Read the slope.

{{ figure('line') }}
A caption.

::: solution
${{ fixed(answer['answer'], 0) }}$

{{ figure('answered') }}
:::
"""
OWN_PROGRAM = """
from replicate.exhibits.variants import Answer, VariedFigure

def variant(rng):
    return {"a": rng.randint(2, 999)}

def answers(inputs):
    return Answer(inputs["a"], tolerance=0.5)

def draw(figure, inputs):
    axes = figure.subplots()
    axes.axis("off")
    axes.plot([0, inputs["a"]])

figures = {
    "line": VariedFigure("A line", "It rises.", draw, (1.0, 1.0)),
    "answered": VariedFigure("Its slope", "It rises.", draw, (1.2, 1.0), in_key=True),
}
"""


@pytest.fixture
def own(tmp_path: Path) -> Path:
    folder = tmp_path / "reading"
    folder.mkdir()
    (folder / "exercise.md").write_text(OWN_TEXT, encoding="utf-8")
    (folder / "exercise.py").write_text(OWN_PROGRAM, encoding="utf-8")
    return folder


def test_without_an_artist_the_thread_that_reports_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, own: Path
) -> None:
    drawn: list[tuple[tuple[str, ...], str]] = []
    pictures = {"svg": toy_class.SVG.encode(), "png": toy_class.PNG}

    def draw(wanted: Wanted, _: object) -> tuple[bytes, ...]:
        drawn.append(((wanted.figure, *wanted.kinds), threading.current_thread().name))
        return tuple(pictures[kind] for kind in wanted.kinds)

    monkeypatch.setattr(Wanted, "drawn", draw)
    students = ["Ada", "Bob", "Zoë", "Eve"]
    sheet = Sheet(own=tuple(own_exercises(own)))
    made = dict(toy_class.class_set(tmp_path, monkeypatch, TEXT, sheet=sheet).files(students, "1", "moodle"))
    assert [name for name in made if name.endswith(".pdf")] == [f"toy-{one}.pdf" for one in [*students, "key"]]
    wanted = {
        ("line", "svg", "png"),
        ("answered", "png"),
        ("answered", "svg"),
    }  # for the file of questions, for the key
    assert {name for _, name in drawn} == {threading.current_thread().name}
    assert sorted(some for some, _ in drawn) == sorted(some for some in wanted for _ in students)


def test_an_artist_draws_for_a_class_of_thirty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, own: Path) -> None:
    students = [f"{number}" for number in range(AT_ONCE + 5)]
    sheet = Sheet(own=tuple(own_exercises(own)))
    with Artist(bayhan.package, (own,)) as artist, monkeypatch.context() as elsewhere:
        elsewhere.delattr(Wanted, "drawn")
        class_set = toy_class.class_set(tmp_path, monkeypatch, TEXT, sheet=sheet, artist=artist)
        made = dict(class_set.files(students, "1", "moodle"))
        wrong = Wanted("toy", "0", "reading", "none", "1", "", (1.0, 1.0))
        with pytest.raises(ReplicateError, match="KeyError: 'none'"):
            artist.order([wrong])(wrong)
    assert list(made) == ["toy-key.csv", *(f"toy-{one}.pdf" for one in students), "toy-key.pdf", "toy-moodle.xml"]
    assert made["toy-key.pdf"].count(b"/S/Figure") == len(students)
    pictures = [b64decode(file.text or "") for file in ET.fromstring(made["toy-moodle.xml"]).iter("file")]  # noqa: S314  -- ours
    assert len(pictures) == 2 * len(students)
    assert {image.imread(io.BytesIO(picture)).ndim for picture in pictures} == {3}
    here = toy_class.class_set(tmp_path, monkeypatch, TEXT, sheet=sheet)
    last = Form.of("toy", "1", students[-1])
    assert list(dict(here.again(last)).values()) == [made[f"toy-{students[-1]}.pdf"]]

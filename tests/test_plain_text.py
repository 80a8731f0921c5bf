"""Characters that steer a terminal or a page never reach one raw, wherever a paper has them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.errors import TemplateError
from replicate.plain_text import read_text, steering, visible
from replicate.terminal.console import console

Run = Callable[..., tuple[int, str, str]]

STEERING = [
    *("\x00", "\x1b[2J", "\x07", "\x7f", "\x9b31m", "\r", "\u202e", "\u2066", "\u200f", "\u2028"),
    *("\u200b", "\u200c", "\u200d", "\u2060", "\u2061", "\u2064", "\u206a", "\ufeff", "\u00ad", "\U000e0041"),
]
#: Persian, Hindi, a pictograph of three, and a sign that stands before Arabic numbers.
WRITTEN = ["می\u200cخواهم", "क्\u200dष", "👩🏽\u200d🔬", "\u0600١", "one\r\ntwo\t–\u00a0é"]


@pytest.mark.parametrize("text", STEERING)
def test_what_steers_is_named_and_written_out(text: str) -> None:
    assert steering(f"a{text}b").startswith(f"U+{ord(text[0]):04X}")
    assert text[0] not in visible(f"a{text}b")


@pytest.mark.parametrize("text", WRITTEN)
def test_how_a_script_is_written_is_left(text: str) -> None:
    assert not steering(text)
    assert visible(text) == text


@given(st.text())
def test_nothing_that_steers_is_left_and_nothing_else_is_changed(text: str) -> None:
    shown = visible(text)
    assert not steering(shown)
    assert steering(text) or shown == text
    shown.encode("utf-8")


def test_what_has_no_width_in_a_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "notes.md"
    path.write_text("one\nMis\u200bprint\n", encoding="utf-8")
    with pytest.raises(TemplateError, match=r"^notes\.md:2: holds the character U\+200B ZERO WIDTH SPACE"):
        read_text(path, "notes.md", TemplateError)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"one\ntwo \xff\n", "lab/notes.md:2: is not UTF-8 text"),
        (b"one\n\ntwo \x1b[2J\n", "lab/notes.md:3: holds the character U+001B"),
        ("one\r\n\u202etwo".encode(), "lab/notes.md:2: holds the character U+202E RIGHT-TO-LEFT OVERRIDE"),
    ],
)
def test_a_file_is_refused_with_its_line(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "notes.md"
    path.write_bytes(content)
    with pytest.raises(TemplateError) as caught:
        read_text(path, "lab/notes.md", TemplateError)
    assert str(caught.value).startswith(said)


def test_marks_and_line_ends_of_other_systems_are_read(tmp_path: Path) -> None:
    path = tmp_path / "notes.md"
    path.write_bytes("\ufeffone\r\ntwo\té\n".encode())
    assert read_text(path, "notes.md", TemplateError) == "one\ntwo\té\n"


@pytest.mark.parametrize("text", STEERING)
def test_the_terminal_shows_it_written_out(capsys: pytest.CaptureFixture[str], text: str) -> None:
    from rich.table import Table as Grid

    grid = Grid()
    grid.add_row(f"cell {text}")
    screen = console()
    screen.print(f"line {text}", markup=False)
    screen.print(grid)
    out = capsys.readouterr().out
    assert "line" in out
    assert "cell" in out
    assert text[0] not in out


PLACES = [
    ("notes.md", "The roots hold.", "The roots{} hold.", "lab_paper/notes.md:1: holds the character U+001B"),
    ("ledger.toml", "is wrong:", "is{} wrong:", "lab_paper/ledger.toml:"),
    ("printed/table-1.csv", "1.414", "1.414{}", "lab_paper/printed/table-1.csv:2: holds the character U+001B"),
]


@pytest.mark.parametrize(("name", "before", "after", "said"), PLACES)
def test_data_files_of_a_paper(replicate: Run, folder: Path, name: str, before: str, after: str, said: str) -> None:
    path = folder / name
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after.format("\x1b[2J")))
    status, out, err = replicate("report", "lab", "-j1")
    assert status == 2
    assert said in err
    assert "\x1b" not in out + err


def test_what_a_paper_computes(replicate: Run, folder: Path) -> None:
    path = folder / "exhibits.py"
    path.write_text(path.read_text().replace('"It is 1.41."', r'"It is\x1b[2J 1.41\u202e, \x00 yes."'))
    assert replicate("report", "lab", "-j1")[0] == 0
    for page in Path("build/report").glob("*.html"):
        assert not steering(page.read_text(encoding="utf-8"))
    assert not steering(Path("build/junit.xml").read_text(encoding="utf-8"))
    status, out, err = replicate("show", "lab", "claims", "-j1")
    assert status == 0
    assert "1.41" in out
    assert not steering(out + err)


def test_an_exception_of_a_paper(replicate: Run, folder: Path) -> None:
    path = folder / "exhibits.py"
    path.write_text(path.read_text().replace("import math", 'import math\nraise ValueError("no\\x1b[2J")', 1))
    status, out, err = replicate("list", "lab")
    assert status == 2
    assert not steering(out + err)

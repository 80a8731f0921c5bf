"""Files that are none, never end or keep a reader busy: one line with the file's name, and soon."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pypandoc
import pytest
import synthetic
from conftest import Run

from replicate import plain_text
from replicate.display import markdown, pandoc
from replicate.display.markdown import MarkdownBatch
from replicate.display.pandoc import NoPandocError, convert
from replicate.errors import LedgerError, PrintedFileError, ReplicateError, UnreadableTextError
from replicate.handout.roster import read_roster
from replicate.plain_text import parse_toml, read_text
from replicate.verdicts.ledger import Ledger


def _device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def _circle(path: Path) -> None:
    path.symlink_to(path.name)


def _large(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(plain_text.LARGEST + 1)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (os.mkfifo, "cannot be read: it is a pipe"),
        (_device, "cannot be read: it is a device"),
        (_circle, "cannot be read: Too many levels of symbolic links"),
        (Path.mkdir, "cannot be read: Is a directory"),
        (_large, "is larger than 16 MiB; allowed: texts that a person wrote"),
    ],
    ids=["pipe", "device", "circle", "folder", "large"],
)
def test_what_is_no_text_file_is_one_line(tmp_path: Path, make: Callable[[Path], None], said: str) -> None:
    path = tmp_path / "table-1.csv"
    make(path)
    with pytest.raises(PrintedFileError) as caught:
        read_text(path, "toy/table-1.csv", PrintedFileError)
    assert str(caught.value) == f"toy/table-1.csv: {said}"


def test_a_folder_in_the_place_of_a_ledger_is_no_missing_ledger(tmp_path: Path) -> None:
    (tmp_path / "ledger.toml").mkdir()
    with pytest.raises(LedgerError, match=r"ledger\.toml: cannot be read: Is a directory"):
        Ledger.load(tmp_path / "ledger.toml", synthetic.paper(tmp_path))


def test_a_roster_may_come_from_a_pipe(tmp_path: Path) -> None:
    path = tmp_path / "roster"
    os.mkfifo(path)
    writer = threading.Thread(target=path.write_text, args=("id,name\na1,Ada\nb2,Bo\n",))
    writer.start()
    assert read_roster(path) == ["a1", "b2"]
    writer.join()


LONG = "x" * 300


@pytest.mark.skipif(sys.platform == "win32", reason="links in a circle and short names are of POSIX")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("report", "lab", "--out", "circle"), "circle: cannot be written: it is a link that leads nowhere"),
        (("report", "lab", "--out", "nowhere"), "nowhere: cannot be written: it is a link that leads nowhere"),
        (("report", "lab", "--out", LONG), "File name too long"),
        (("diff", "lab", "--accepted", LONG), "File name too long"),
        (("list", "--papers", "circle"), "there is no folder circle"),
        (("list", "--papers", LONG), "File name too long"),
        (("init", "circle"), "circle: cannot be written: it is a link that leads nowhere"),
        (("handout", "lab", "--exercises", LONG), "File name too long"),
    ],
)
def test_links_that_lead_nowhere_and_long_names_are_one_line(
    replicate: Run, arguments: tuple[str, ...], said: str
) -> None:
    Path("circle").symlink_to("circle")
    Path("nowhere").symlink_to("there/is/none")
    status, _, errors = replicate(*arguments, "-j1") if arguments[0] not in ("init", "list") else replicate(*arguments)
    assert status == 2
    assert errors.endswith(f"{said}\n")
    assert "unexpected" not in errors


@pytest.mark.parametrize("text", ["a = " + "[" * 10**5, "a = " + "{b = " * 10**4])
def test_brackets_without_end_are_one_line(text: str) -> None:
    with pytest.raises(ReplicateError, match=r"^x\.toml: is not readable TOML: too many brackets inside each other$"):
        parse_toml(text, "x.toml", ReplicateError)


def test_a_text_that_keeps_pandoc_busy_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pandoc, "TIME_LIMIT", 2.0)
    monkeypatch.setattr(markdown, "_LIMIT_ALONE", 4.0)
    batch = MarkdownBatch("toy.html")
    page = batch.block("A text.") + batch.block(f"Before.\n\nAnother {'[' * 40} one.\n\nAfter.")
    with pytest.raises(
        UnreadableTextError, match=r"^toy\.html: pandoc cannot convert the text 'Another \[\["
    ) as caught:
        batch.substitute(page)
    assert caught.value.why.startswith("it takes more than 2 seconds")


@pytest.mark.parametrize("program", ["/bin/false", "/nowhere/pandoc", "/x\x1b[31m"])
def test_a_pandoc_that_does_not_run_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], program: str
) -> None:
    monkeypatch.setenv("PYPANDOC_PANDOC", program)
    monkeypatch.setattr(pypandoc, "__pandoc_path", None)
    with pytest.raises(NoPandocError, match=r"^PYPANDOC_PANDOC names .*, which is not a pandoc that runs: unset it"):
        convert("A text.", "html", "markdown")
    assert capfd.readouterr() == ("", "")


def test_an_integer_that_python_does_not_read_is_named_with_its_line() -> None:
    text = f"a = 1\nb = {'9' * 5000}\n"
    with pytest.raises(ReplicateError, match=r"^x\.toml:2: is not readable TOML: an integer of too many digits$"):
        parse_toml(text, "x.toml", ReplicateError)

"""A report that would come out the same is not written again; whatever it is made of, or of its own files, counts."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import Run

Change = Callable[[Path, Path], object]  # given the paper's folder and that of the output


@pytest.fixture
def written(replicate: Run, folder: Path) -> tuple[list[str], Path]:
    """Write a report and return the command, and the folder of the output."""
    command = ["report", "--papers", str(folder.parent)]
    code, *_ = replicate(*command)
    assert code == 0
    return command, Path("build")


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Note every time that pages are written."""
    from replicate.report import pages as module

    noted: list[str] = []
    original = module.build_report

    def build(*arguments: Any, **options: Any) -> list[Path]:
        noted.append("written")
        return original(*arguments, **options)

    monkeypatch.setattr(module, "build_report", build)
    return noted


def _state(out: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in sorted(out.rglob("*")) if path.is_file()}


def test_nothing_is_written_again_and_the_same_is_said(
    replicate: Run, written: tuple[list[str], Path], pages: list[str]
) -> None:
    command, out = written
    before = _state(out)
    kept = replicate(*command)
    assert pages == []
    assert _state(out) == before
    (out / "cache" / "report.json").unlink()
    assert replicate(*command) == kept
    assert pages == ["written"]
    assert _state(out) == before


def test_nothing_is_loaded_that_an_untouched_report_does_not_need(
    replicate: Run, written: tuple[list[str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    from replicate.exhibits import Paper

    command, _ = written
    with monkeypatch.context() as patched:
        patched.setattr(Paper, "load", lambda _paper: pytest.fail("a paper is loaded"))
        assert replicate(*command)[0] == 0
    code = (
        f"import sys; sys.argv = {['replicate', *command]!r}\nfrom replicate.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code\n"
        "print(*sorted({'pandas', 'scipy', 'matplotlib', 'jinja2', 'replicate.loops'} & sys.modules.keys()))"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.splitlines()[-1] == ""


def _append(name: str, text: str) -> Change:
    def change(paper: Path, _out: Path) -> None:
        with (paper / name).open("a", encoding="utf-8") as file:
            file.write(text)

    return change


def _to_output(name: str, content: bytes | None) -> Change:
    def change(_paper: Path, out: Path) -> None:
        if content is None:
            (out / name).unlink()
        else:
            (out / name).write_bytes(content)

    return change


def _other_version(_paper: Path, out: Path) -> None:
    path = out / "cache" / "report.json"
    kept = json.loads(path.read_text())
    kept["versions"]["numpy"] = "1.0"
    path.write_text(json.dumps(kept))


CHANGES: dict[str, Change] = {
    "prose of the paper": _append("notes.md", "\nOne more sentence.\n"),
    "a file beside it": lambda paper, _out: (paper / "new.txt").write_text("new"),
    "a page that is gone": _to_output("report/index.html", None),
    "a version": _other_version,
    "no result": lambda _paper, out: next((out / "cache").rglob("*.result")).unlink(),
    "a damaged note": _to_output("cache/report.json", b"{}"),
    "no note": _to_output("cache/report.json", None),
    "a note that is a list": _to_output("cache/report.json", b"[]"),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_changes_has_the_report_written_again(
    replicate: Run, written: tuple[list[str], Path], folder: Path, pages: list[str], change: Change
) -> None:
    command, out = written
    change(folder, out)
    code, *_ = replicate(*command)
    assert code == 0
    assert pages == ["written"]
    replicate(*command)
    assert pages == ["written"]


@pytest.mark.parametrize("name", ["report/index.html", "results.csv"])
def test_a_file_that_somebody_has_changed_is_seen(replicate: Run, written: tuple[list[str], Path], name: str) -> None:
    command, out = written
    (out / name).write_text("mine")
    code, _, error = replicate(*command)
    assert code == 2
    assert name in error
    assert (out / name).read_text() == "mine"


def test_another_title_of_the_project_has_the_report_written_again(
    replicate: Run, folder: Path, pages: list[str]
) -> None:
    project = Path("replicate.toml")
    for title in ("One", "Two", "Two"):
        project.write_text(f'title = "{title}"\npapers = ["{folder.parent}"]\n')
        assert replicate("report")[0] == 0
    assert len(pages) == 2
    assert "Two" in Path("build/report/index.html").read_text()


@pytest.mark.parametrize("options", [["--no-cache"], ["--single-file"], ["lab"]])
def test_what_else_is_asked_for_is_done(
    replicate: Run, written: tuple[list[str], Path], pages: list[str], options: list[str]
) -> None:
    command, _ = written
    assert replicate(*command, *options)[0] == 0
    assert pages == ["written"]

"""A report that would come out the same is not written again; whatever it is made of, or of its own files, counts."""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import Run

Change = Callable[[Path, Path], object]  # given the paper's folder and that of the output


@pytest.fixture
def written(replicate: Run, folder: Path, lab_results: Callable[[Path], Path]) -> tuple[list[str], Path]:
    """Write a report and return the command, and the folder of the output."""
    command = ["report", "--papers", str(folder.parent)]
    lab_results(Path("build/cache"))
    code, _, said = replicate(*command)
    assert code == 0
    assert "4 of 4 results kept" in said
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
    assert _loaded(command) == ""


def _loaded(command: list[str]) -> str:
    """Run a command in a process of its own, and return which large modules it has loaded."""
    code = (
        f"import sys; sys.argv = {['replicate', *command]!r}\nfrom replicate.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code\n"
        "print(*sorted({'pandas', 'scipy', 'matplotlib', 'jinja2', 'replicate.loops'} & sys.modules.keys()))"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    return said.splitlines()[-1]


@pytest.mark.usefixtures("replicate")
def test_a_report_stands_in_which_a_figure_has_changed(folder: Path) -> None:
    """The results that were not computed anew say of the figure's module that they do not use it as it was."""
    more, face, command = folder / "more.py", folder / "__init__.py", ["report", "--papers", str(folder.parent)]
    face.write_text(face.read_text().replace('"exhibits",', '"exhibits", "more",'))
    figure = (
        f"from {folder.name} import paper\n\n\n"
        "@paper.figure('fig-9', 'Nine')\ndef _draw(figure):\n    figure.add_subplot().plot([0, 1])\n"
    )
    for text in (figure, f"{figure}\n"):
        more.write_text(text)
        assert _loaded(command) != ""
    assert _loaded(command) == ""


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


def test_a_single_file_goes_when_it_is_no_longer_asked_for(
    replicate: Run, written: tuple[list[str], Path], pages: list[str]
) -> None:
    command, out = written
    before = _state(out)
    (out / "mine.html").write_text("mine")
    assert replicate(*command, "--single-file")[0] == 0
    assert (out / "lab.html").is_file()
    assert replicate(*command)[0] == 0
    assert _state(out) == before | {"build/mine.html": b"mine"}
    assert replicate(*command)[0] == 0
    assert pages == ["written"] * 2


def _replace(name: str, old: str, new: str) -> Change:
    def change(paper: Path, _out: Path) -> None:
        text = (paper / name).read_text()
        assert old in text
        (paper / name).write_text(text.replace(old, new))

    return change


PARTS: dict[str, Change] = {
    "figure": _replace("exhibits.py", "t / 3.0", "t / 4.0"),
    "claim": _replace("exhibits.py", "It is 1.41.", "It is 1.414."),
    "cell of a table": _replace("printed/table-1.csv", "1.414", "1.415"),
    "ledger": _replace("ledger.toml", "The last digit is wrong", "Its last digit is wrong"),
    "notes": _append("notes.md", "\nOne more sentence.\n"),
}


@pytest.fixture(scope="module")
def results_of_two(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where the first test leaves the results of `two` for the others."""
    return tmp_path_factory.mktemp("two") / "cache"


@pytest.fixture
def two(replicate: Run, folder: Path, results_of_two: Path) -> Path:
    """Write a project of two papers, its report, and return the first paper's folder."""
    for name in ("one", "other"):
        shutil.copytree(folder, Path("papers") / name, ignore=shutil.ignore_patterns("__pycache__"))
        for path in Path("papers", name).glob("*.py"):
            path.write_text(path.read_text().replace("lab_paper", name).replace('id="lab"', f'id="{name}"'))
    Path("replicate.toml").write_text('title = "Two"\n')
    if results_of_two.is_dir():
        shutil.copytree(results_of_two, "build/cache")
    assert replicate("report")[0] == 0
    if not results_of_two.is_dir():
        shutil.copytree("build/cache", results_of_two, ignore=shutil.ignore_patterns("report.json"))
    return Path("papers/one")


def _as_anew(replicate: Run) -> None:
    """Compare a report, file by file, with one that is written into an empty folder; count files that were kept."""
    assert replicate("report", "--no-cache", "--out", "fresh")[0] == 0
    kept, fresh = (
        {path.relative_to(out): path.read_bytes() for path in Path(out).rglob("*") if path.is_file()}
        for out in ("build", "fresh")
    )
    hidden = {path for path in (*kept, *fresh) if path.parts[0] in {"cache", ".replicate"}}
    assert {path: text for path, text in kept.items() if path not in hidden} == {
        path: text for path, text in fresh.items() if path not in hidden
    }
    shutil.rmtree("fresh")


@pytest.mark.parametrize("change", PARTS.values(), ids=PARTS)
def test_what_is_left_as_it_stands_is_what_a_run_in_an_empty_folder_writes(
    replicate: Run, two: Path, monkeypatch: pytest.MonkeyPatch, change: Change
) -> None:
    from replicate.report import pages as module
    from replicate.report.weight import within_limits as original

    filled: list[str] = []

    def noted(views: Any, page: Any) -> str:
        text = original(views, page)
        filled.append(text)
        return text

    monkeypatch.setattr(module, "within_limits", noted)
    change(two, Path("build"))
    assert replicate("report")[0] in {0, 1}
    assert len(filled) == 1, "of the other paper nothing has changed"
    _as_anew(replicate)


def test_papers_that_come_and_go_leave_no_page(replicate: Run, two: Path) -> None:
    shutil.move(two, "aside")
    assert replicate("report")[0] == 0
    assert not Path("build/report/one.html").exists()
    _as_anew(replicate)
    shutil.move("aside", two)
    assert replicate("report")[0] == 0
    _as_anew(replicate)
    with (two / "notes.md").open("a") as file:
        file.write("\nMore.\n")
    assert replicate("report", "other")[0] == 0
    assert replicate("report")[0] == 0
    _as_anew(replicate)


def test_nothing_of_others_is_believed(replicate: Run, two: Path) -> None:
    """A note that another user wrote, beside a page of that user's, is worth nothing."""
    page, note = Path("build/report/other.html"), Path("build/cache/report.json")
    manifest = Path("build/.replicate/manifest.json")
    before = hashlib.sha256(page.read_bytes()).hexdigest()
    forged = page.read_text().replace("<h1>", "<h1>Forged ")
    page.write_text(forged)
    after = hashlib.sha256(forged.encode()).hexdigest()
    for path in (note, manifest):
        assert before in path.read_text()
        path.write_text(path.read_text().replace(before, after))
    with (two / "notes.md").open("a") as file:
        file.write("\nMore.\n")
    assert replicate("report")[0] == 0
    assert "Forged" not in page.read_text()
    _as_anew(replicate)


def test_a_page_is_renewed_when_what_it_shows_of_a_module_beside_it_has_changed(replicate: Run, two: Path) -> None:
    """The results stay the same to the last digit, and the source that the page shows does not."""
    text = (two / "exhibits.py").read_text()
    (two / "exhibits.py").write_text(text.replace("t / 3.0", "1.0 * t / 3.0"))
    assert replicate("report")[0] == 0
    _as_anew(replicate)
    (two / "exhibits.py").write_text(text)
    assert replicate("report")[0] == 0
    assert "1.0 * t" not in Path("build/report/one.html").read_text()
    _as_anew(replicate)

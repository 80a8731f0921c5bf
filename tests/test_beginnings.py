"""A new project and a new paper work as they are made; what is not the author's own yet is counted as open work."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.diff.check import problems
from replicate.diff.comparison import Comparison
from replicate.display.addresses import TRIALS
from replicate.errors import OutputError, PaperDefinitionError
from replicate.exhibits.definitions import PAGES
from replicate.new_paper import new_paper
from replicate.new_project import new_project
from replicate.report import pages, site
from replicate.run.library import Library
from replicate.run.outcome import recompute
from replicate.run.project import find_project


def test_a_new_paper_holds_but_for_what_is_still_to_do(tmp_path: Path) -> None:
    new_project(tmp_path / "mine", "Of mine")
    new_paper("demo", tmp_path / "mine" / "papers")
    papers = Library(find_project(tmp_path / "mine")).papers()
    outcome = recompute(papers, jobs=1, cache_dir=None)
    assert outcome.failures == []
    assert outcome.judgement.problems == []
    assert [v.verdict for v in outcome.judgement.verdicts if v.row == "A"] == ["reproduced", "reproduced"]
    assert [exhibit.kind for exhibit in papers[0].exhibits.values()] == ["table", "figure", "claims"]
    lines = problems(outcome, Comparison())
    assert len(lines) > 10
    assert all(": still to do: " in line for line in lines)
    assert any(line.startswith("demo/notes.md:1: ") for line in lines)


def test_a_new_paper_is_in_good_style(tmp_path: Path) -> None:
    folder = new_paper("demo", tmp_path)
    options = ["--isolated", "--no-cache", "--select", "E,F,I", "--line-length", "120"]
    command = [sys.executable, "-m", "ruff", "check", *options]
    done = subprocess.run([*command, "."], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_test_of_a_new_paper_passes(tmp_path: Path) -> None:
    new_paper("demo", tmp_path)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "demo"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("id", ["", "Demo", "1st", "a-b", "class", "../x", "statistics", "numpy", "search"])
def test_ids_that_cannot_be_imported_are_refused(id: str, tmp_path: Path) -> None:
    with pytest.raises(PaperDefinitionError):
        new_paper(id, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_no_paper_has_the_name_of_a_page_of_the_report() -> None:
    others = {site.INDEX, pages.METHODS, pages.VERDICTS, pages.ERRATA, pages.SEARCH, TRIALS}
    assert {f"{id}.html" for id in PAGES} == others


def test_an_existing_folder_is_left_alone(tmp_path: Path) -> None:
    new_paper("demo", tmp_path)
    with pytest.raises(OutputError, match="exists already"):
        new_paper("demo", tmp_path)


@pytest.mark.parametrize("name", ["replicate.toml", "papers", ".github", "README.md"])
def test_a_project_overwrites_nothing(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError, match="exists already; nothing was written"):
        new_project(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize(("name", "step"), [("mine", "  cd mine\n"), ("a b", "  cd 'a b'\n"), (".", "this folder")])
def test_the_next_steps_can_be_typed(name: str, step: str, replicate: Callable[..., tuple[int, str, str]]) -> None:
    status, out, _ = replicate("init", name)
    assert (status, step in out, "cd ." in out) == (0, True, False)

"""Discovery, running and caching, on a small paper that is installed as a user would install one."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import installed_paper
import pytest

from replicate.errors import PaperDefinitionError, ReplicateError, UnknownPaperError
from replicate.exhibits import Paper
from replicate.exhibits.results import ClaimsResult, FigureResult, Results, TableResult
from replicate.run import parallel as run
from replicate.run.library import Library

Keep = Callable[[Path], Path]


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    with installed_paper.installed(tmp_path / "site") as folder:
        yield folder


@pytest.fixture
def paper(folder: Path) -> Paper:
    assert folder.is_dir()
    return Library().paper("lab")


def computed(paper: Paper, cache: Path | None = None, jobs: int = 1) -> tuple[Results, list[run.Progress]]:
    steps: list[run.Progress] = []
    return run.run([paper], jobs=jobs, cache_dir=cache, progress=steps.append), steps


def from_cache(steps: list[run.Progress]) -> set[str]:
    return {str(step.unit) for step in steps if step.from_cache}


UNITS = {"lab/table-1 (as-written)", "lab/table-1 (decimal)", "lab/fig-1", "lab/claims"}


def test_an_installed_paper_is_found(paper: Paper) -> None:
    assert list(paper.exhibits) == ["table-1", "fig-1", "fig-2", "claims"]


@pytest.mark.usefixtures("folder")
def test_unknown_names_list_the_known_ones() -> None:
    with pytest.raises(UnknownPaperError, match=r"no paper 'lap'; known: .*lab"):
        Library().paper("lap")
    with pytest.raises(UnknownPaperError, match=r"lab has no exhibit 'table-9'; known: table-1, fig-1"):
        Library().select(["lab/table-9"])


@pytest.mark.usefixtures("folder")
def test_selection_of_exhibits() -> None:
    papers, exhibits = Library().select(["lab/fig-1", "lab/table-1"])
    assert [paper.id for paper in papers] == ["lab"]
    assert exhibits == [("lab", "fig-1"), ("lab", "table-1")]
    assert Library().select(["lab"])[1] is None
    assert Library().select(["lab", "lab/fig-1"])[1] == [("lab", id) for id in papers[0].exhibits]


@pytest.mark.parametrize("value", ["lab_paper:nothing", "no_such_module:paper", "lab_paper:__name__"])
def test_an_entry_point_that_names_no_paper_is_refused(folder: Path, value: str) -> None:
    points = folder.parent / "lab_paper-1.0.dist-info" / "entry_points.txt"
    points.write_text(f"[replicate.papers]\nlab = {value}\n")
    with pytest.raises(PaperDefinitionError, match="entry point 'lab'"):
        Library().paper("lab")


def test_two_papers_of_one_name_are_refused(folder: Path) -> None:
    points = folder.parent / "lab_paper-1.0.dist-info" / "entry_points.txt"
    points.write_text("[replicate.papers]\nlab = lab_paper:paper\nlab2 = lab_paper:paper\n")
    with pytest.raises(PaperDefinitionError, match="the paper 'lab' is already defined"):
        Library().paper("lab")


def test_everything_computable_is_computed(paper: Paper) -> None:
    results, steps = computed(paper)
    assert list(results) == [("lab", "table-1"), ("lab", "fig-1"), ("lab", "claims")]
    table, figure, claims = results.values()
    assert isinstance(table, TableResult)
    assert table.frames["decimal"].loc["3", "log"] == math.log10(3)
    assert isinstance(figure, FigureResult)
    assert figure.curves["curve"].unique().tolist() == ["output"]
    assert isinstance(claims, ClaimsResult)
    assert claims.findings["root"].verdict == "holds"
    assert {str(step.unit) for step in steps} == UNITS
    assert [step.done for step in steps] == [1, 2, 3, 4]


def test_the_number_of_workers_does_not_matter(paper: Paper) -> None:
    alone, _ = computed(paper, jobs=1)
    together, _ = computed(paper, jobs=2)
    assert list(alone) == list(together)
    one, other = alone["lab", "table-1"], together["lab", "table-1"]
    assert isinstance(one, TableResult)
    assert isinstance(other, TableResult)
    assert list(one.frames) == list(other.frames)
    assert all(one.frames[reading].equals(other.frames[reading]) for reading in one.frames)
    figure, same = alone["lab", "fig-1"], together["lab", "fig-1"]
    assert isinstance(figure, FigureResult)
    assert isinstance(same, FigureResult)
    assert (figure.svg, figure.png, figure.axes) == (same.svg, same.png, same.axes)
    assert figure.curves.equals(same.curves)
    assert alone["lab", "claims"] == together["lab", "claims"]


def test_a_reading_that_raises_takes_nothing_down(paper: Paper, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAB_BREAKS", "1")
    results, _ = computed(paper)
    table = results["lab", "table-1"]
    assert isinstance(table, TableResult)
    assert list(table.frames) == ["decimal"]
    (line,) = run.failures(results)
    assert line.startswith("lab/table-1 (as-written): ValueError: the kettle is empty (lab_paper/exhibits.py:")
    assert "\n" not in line


def test_results_are_kept(paper: Paper, tmp_path: Path) -> None:
    first, _ = computed(paper, tmp_path)
    again, steps = computed(paper, tmp_path)
    assert from_cache(steps) == UNITS
    assert run.failures(first) == run.failures(again) == []
    figure, same = first["lab", "fig-1"], again["lab", "fig-1"]
    assert isinstance(figure, FigureResult)
    assert isinstance(same, FigureResult)
    assert figure.svg == same.svg


def test_failures_are_not_kept(paper: Paper, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAB_BREAKS", "1")
    computed(paper, tmp_path)
    monkeypatch.delenv("LAB_BREAKS")
    results, steps = computed(paper, tmp_path)
    assert from_cache(steps) == UNITS - {"lab/table-1 (as-written)"}
    assert run.failures(results) == []


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("ledger.toml", True),
        ("notes.md", True),
        ("slides.md", True),
        ("handout.de.md", True),
        ("test_lab.py", True),
        ("exhibits.py", False),
        ("printed/table-1.csv", False),
    ],
)
def test_a_source_makes_results_stale_and_what_is_said_of_them_does_not(
    paper: Paper, folder: Path, lab_results: Keep, tmp_path: Path, name: str, *, kept: bool
) -> None:
    lab_results(tmp_path / "cache")
    with (folder / name).open("a") as file:
        file.write("\n")
    _, steps = computed(paper, tmp_path / "cache")
    assert from_cache(steps) == (UNITS if kept else set())


def test_a_damaged_cache_is_computed_again(paper: Paper, lab_results: Keep, tmp_path: Path) -> None:
    cache = lab_results(tmp_path / "cache")
    files = list(cache.rglob("*.result"))
    assert len(files) == len(UNITS)
    for file in files:
        file.write_bytes(b"nonsense")
    results, steps = computed(paper, cache)
    assert from_cache(steps) == set()
    assert run.failures(results) == []


def test_part_of_a_paper(paper: Paper) -> None:
    results = run.run([paper], [("lab", "fig-1"), ("lab", "fig-2")], jobs=1, cache_dir=None)
    assert list(results) == [("lab", "fig-1")]


def test_no_workers_is_an_error(paper: Paper) -> None:
    with pytest.raises(ReplicateError, match="jobs must be at least 1, not 0"):
        run.run([paper], jobs=0, cache_dir=None)

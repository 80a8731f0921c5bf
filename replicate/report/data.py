"""Write what a run leaves behind: results, verdicts, errata, inventory, tables, figures and a JUnit file.

Same results, same bytes: no clock, no absolute paths, rows in the order of the papers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from replicate.display.addresses import address, pages_of
from replicate.display.consequences import errors
from replicate.display.csv_text import csv_text, curves_text, table_text
from replicate.display.junit import junit
from replicate.exhibits import Figure, Paper
from replicate.exhibits.results import FigureResult, Results, TableResult
from replicate.verdicts.rows import ExhibitRow, Judgement, ResultRow, VerdictRow

RESULT_COLUMNS = ("paper", "exhibit", "row", "column", "printed", "reading", "computed", "match")
VERDICT_COLUMNS = (
    "paper",
    "exhibit",
    "row",
    "column",
    "printed",
    "verdict",
    "reading",
    "computed",
    "corrected",
    "cause",
    "explanation",
    "lower",
    "upper",
    "convention",
    "consequence",
)
ERRATA_COLUMNS = (
    "paper",
    "exhibit",
    "row",
    "column",
    "printed",
    "verdict",
    "computed",
    "corrected",
    "consequence",
    "cause",
    "explanation",
    "informed",
    "answer",
)
EXHIBIT_COLUMNS = ("paper", "exhibit", "kind", "title", "status", "reason")


DATA = "data"


def expected_files(papers: Iterable[Paper]) -> list[str]:
    """Return files that a run will write, as far as they are known before, by name inside the output folder."""
    figures = (
        f"figures/{paper.id}/{exhibit.id}.svg"
        for paper in papers
        for exhibit in paper.exhibits.values()
        if isinstance(exhibit, Figure)
    )
    return ["results.csv", "verdicts.csv", "exhibits.csv", "junit.xml", "report/index.html", *figures]


def write_outputs(papers: Sequence[Paper], results: Results, judgement: Judgement, folder: Path) -> None:
    """Write everything but the report into a folder.

    Parameters
    ----------
    papers
        Those that were run.
    judgement
        Of all of them together.
    folder
        An existing folder; see `replicate.staging.staged` for how to replace an earlier state safely.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    _write_data(papers, results, judgement, folder)
    # A second copy inside the report, so that the report can be mailed whole.
    _write_data(papers, results, judgement, folder / "report" / DATA)
    _write(folder / "junit.xml", junit([paper.id for paper in papers], results, judgement))


def _write_data(papers: Sequence[Paper], results: Results, judgement: Judgement, folder: Path) -> None:
    _write(folder / "results.csv", _records(judgement.results, RESULT_COLUMNS))
    pages = {paper.id: pages_of(paper) for paper in papers}
    _write(folder / "verdicts.csv", _addressed(judgement.verdicts, VERDICT_COLUMNS, pages))
    _write(folder / "errata.csv", _addressed(errors(judgement.verdicts), ERRATA_COLUMNS, pages))
    _write(folder / "exhibits.csv", _records(judgement.exhibits, EXHIBIT_COLUMNS))
    (folder / "tables").mkdir()
    (folder / "figures").mkdir()
    for (paper, exhibit), result in results.items():
        if isinstance(result, TableResult):
            for reading, frame in result.frames.items():
                _write(folder / "tables" / paper / f"{exhibit}.{reading}.csv", table_text(frame))
        elif isinstance(result, FigureResult) and not result.error:
            place = folder / "figures" / paper
            _write(place / f"{exhibit}.svg", result.svg)
            _write(place / f"{exhibit}.png", result.png)
            _write(place / f"{exhibit}.csv", curves_text(result.curves))


def _records(records: Iterable[ResultRow | VerdictRow | ExhibitRow], columns: Sequence[str]) -> str:
    return csv_text(columns, ([_one_line(getattr(record, name)) for name in columns] for record in records))


def _addressed(rows: Iterable[VerdictRow], columns: Sequence[str], pages: Mapping[str, Mapping[str, str]]) -> str:
    """Return verdicts as CSV, each with its place in the report in the last column."""
    return csv_text(
        (*columns, "address"),
        (
            [
                *(_one_line(getattr(row, name)) for name in columns),
                address(pages[row.paper][row.exhibit], row.exhibit, row.row, row.column),
            ]
            for row in rows
        ),
    )


def _one_line(text: Any) -> str:
    return " ".join(str(text).split())


def _write(path: Path, content: str | bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)

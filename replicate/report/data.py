"""Write what a run leaves behind: results, verdicts, errata, inventory, tables, figures, their columns, a JUnit file.

Same results, same bytes: no clock, no absolute paths, rows in the order of the papers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from replicate.display.addresses import address, pages_of
from replicate.display.consequences import errors
from replicate.display.csv_text import csv_text, curves_text, table_text
from replicate.display.junit import junit
from replicate.display.keeping import Keep, made_anew
from replicate.exhibits import Figure, Paper, Table
from replicate.exhibits.results import FigureResult, Result, Results, TableResult
from replicate.report.columns import COLUMN_COLUMNS, column_rows, named_curves, named_drawing
from replicate.report.pages import DATA
from replicate.staging import write
from replicate.verdicts.rows import ExhibitRow, Judgement, RangeRow, ResultRow, VerdictRow

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
RANGE_COLUMNS = (
    "paper", "exhibit", "row", "column", "printed", "reading", "match", "lower", "upper", "certainty",
)  # fmt: skip
EXHIBIT_COLUMNS = ("paper", "exhibit", "kind", "title", "status", "reason")


def expected_files(papers: Iterable[Paper]) -> list[str]:
    """Return files that a run will write, as far as they are known before, by name inside the output folder."""
    found = ["results.csv", "verdicts.csv", "errata.csv", "exhibits.csv", "columns.csv", "junit.xml"]
    found.append("report/index.html")
    for paper in papers:
        for exhibit in paper.exhibits.values():
            if isinstance(exhibit, Figure):
                found += [f"figures/{paper.id}/{exhibit.id}{ending}" for ending in (".svg", ".png", ".csv")]
            elif isinstance(exhibit, Table):
                found += [f"tables/{paper.id}/{exhibit.id}.{reading}.csv" for reading in exhibit.readings]
    return found


def write_outputs(
    papers: Sequence[Paper],
    results: Results,
    judgement: Judgement,
    folder: Path,
    keeps: Mapping[str, Keep] = MappingProxyType({}),
) -> dict[str, bytes]:
    """Write everything but the report into a folder.

    Parameters
    ----------
    papers
        Those that were run.
    judgement
        Of all of them together.
    folder
        An existing folder; see `replicate.staging.staged` for how to replace an earlier state safely.
    keeps
        By paper: keeps the files of its exhibits as long as nothing that they are made of has changed.

    Returns
    -------
    dict
        The files of the data by name.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    files = data_files(papers, results, judgement, keeps)
    for name, content in files.items():
        write(folder / name, content)
        # The same bytes inside the report, so that the report can be mailed whole.
        write(folder / "report" / DATA / name, content)
    write(folder / "junit.xml", junit([paper.id for paper in papers], results, judgement).encode())
    return files


def data_files(
    papers: Sequence[Paper],
    results: Results,
    judgement: Judgement,
    keeps: Mapping[str, Keep] = MappingProxyType({}),
) -> dict[str, bytes]:
    """Return the files of the data by name."""
    pages = {paper.id: pages_of(paper) for paper in papers}
    found: dict[str, str | bytes] = {
        "results.csv": _records(judgement.results, RESULT_COLUMNS),
        "verdicts.csv": _addressed(judgement.verdicts, VERDICT_COLUMNS, pages),
        "errata.csv": _addressed(errors(judgement.verdicts), ERRATA_COLUMNS, pages),
        "exhibits.csv": _records(judgement.exhibits, EXHIBIT_COLUMNS),
        "ranges.csv": _records(judgement.ranges, RANGE_COLUMNS),
        "columns.csv": csv_text(COLUMN_COLUMNS, (one for paper in papers for one in column_rows(paper, results))),
    }
    for (paper, _), result in results.items():
        kept = keeps.get(paper, made_anew)
        for name, make in _of_exhibit(result).items():
            found[name] = make if isinstance(make, bytes) else kept(name, make)
    return {name: text.encode() if isinstance(text, str) else text for name, text in found.items()}


def _of_exhibit(result: Result) -> dict[str, bytes | Callable[[], str]]:
    """Return the files of one exhibit by name: their content, or what makes it."""
    if isinstance(result, TableResult):
        place = f"tables/{result.paper}/{result.exhibit}"
        return {f"{place}.{reading}.csv": partial(table_text, frame) for reading, frame in result.frames.items()}
    if isinstance(result, FigureResult) and not result.error:
        place = f"figures/{result.paper}/{result.exhibit}"
        return {
            f"{place}.svg": partial(named_drawing, result.svg),
            f"{place}.png": result.png,
            f"{place}.csv": lambda: curves_text(named_curves(result)),
        }
    return {}


def _records(records: Iterable[ResultRow | VerdictRow | ExhibitRow | RangeRow], columns: Sequence[str]) -> str:
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

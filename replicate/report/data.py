"""Write what a run leaves behind: results, verdicts, inventory, tables, figures and a JUnit file.

Same results, same bytes: no clock, no absolute paths, rows in the order of the papers.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from replicate.exhibits import Paper
from replicate.verdicts.rows import ExhibitRow, Judgement, ResultRow, VerdictRow
from replicate.display.junit import junit
from replicate.exhibits.results import FigureResult, Results, TableResult

if TYPE_CHECKING:
    import pandas as pd

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
)
EXHIBIT_COLUMNS = ("paper", "exhibit", "kind", "title", "status", "reason")

#: Digits of every computed number in the tables; twelve are far more than any paper prints.
DIGITS = 12


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
    _write(folder / "results.csv", _records(judgement.results, RESULT_COLUMNS))
    _write(folder / "verdicts.csv", _records(judgement.verdicts, VERDICT_COLUMNS))
    _write(folder / "exhibits.csv", _records(judgement.exhibits, EXHIBIT_COLUMNS))
    _write(folder / "junit.xml", junit([paper.id for paper in papers], results, judgement))
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


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    r"""Return a CSV with ``\n`` line ends; ``None`` and NaN become blank cells.

    Examples
    --------
    >>> print(csv_text(["row", "Mp"], [["PA", 0.1 + 0.2], ["ZN", None]]), end="")
    row,Mp
    PA,0.3
    ZN,
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([number_text(cell) for cell in row] for row in rows)
    return buffer.getvalue()


def number_text(value: object, digits: int = DIGITS) -> str:
    """Return a cell as text: numbers with the given significant digits, nothing for ``None`` and NaN."""
    if value is None:
        return ""
    if isinstance(value, bool) or not isinstance(value, Real):
        return "" if str(value) in {"<NA>", "NaT"} else str(value)
    number = float(value) + 0.0  # no negative zero
    return "" if number != number else f"{number:.{digits}g}"  # noqa: PLR0124  -- NaN


def table_text(frame: pd.DataFrame) -> str:
    """Return a reading as CSV in the paper's own layout: row keys in the first column, then the columns."""
    header = ["row" if frame.index.name is None else str(frame.index.name), *map(str, frame.columns)]
    return csv_text(header, frame.itertuples(index=True, name=None))


def curves_text(curves: pd.DataFrame) -> str:
    """Return the curves of a figure as CSV; they come rounded to nine significant digits."""
    return csv_text(list(curves.columns), curves.itertuples(index=False, name=None))


def _records(records: Iterable[ResultRow | VerdictRow | ExhibitRow], columns: Sequence[str]) -> str:
    return csv_text(columns, ([_one_line(getattr(record, name)) for name in columns] for record in records))


def _one_line(text: Any) -> str:
    return " ".join(str(text).split())


def _write(path: Path, content: str | bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)

"""The accepted state of every exhibit: what it is and how it is read back.

In the accepted folder, for each paper: ``<exhibit>.csv`` holds the computed values and verdicts of a table
(``row,column,reading,computed,printed,verdict``), of the claims (``row,verdict,computed``), or the curves of
a figure (``panel,curve,x,y``). Beside it ``<exhibit>.json`` has what is said of the exhibit, and the axes of a figure.
A figure also has a picture for people in ``<exhibit>.png``, small and never compared. Numbers have nine significant
digits. ``SHA256SUMS`` says how each file was when it was accepted.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from replicate.diff.accepted_files import CURVE_COLUMNS, keyed, read_cells, read_curves, read_record
from replicate.diff.words import Words, read_words, with_words, without_words, words_of, words_text
from replicate.display.csv_text import csv_text, curves_text, number_text
from replicate.errors import AcceptedStateError
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.figures.polylines import Points
from replicate.figures.record import VERSION, Record, record_text
from replicate.run.outcome import Outcome
from replicate.verdicts.ledger import Ledger

if TYPE_CHECKING:
    import pandas as pd

DIGITS = 9
ENDINGS = (".csv", ".json", ".png")

TABLE_COLUMNS = ("row", "column", "reading", "computed", "printed", "verdict")
CLAIM_COLUMNS = ("row", "verdict", "computed")


@dataclass(frozen=True)
class TableState:
    """A table or claims: the other columns by (row, column, reading), or by (row,), and what is said of them."""

    cells: Mapping[tuple[str, ...], Mapping[str, str]]
    words: Words | None = None  # if nothing of the kind was accepted


@dataclass(frozen=True)
class FigureState:
    """A figure: points by (panel, curve), the description of every panel and of the whole, and what is said of it.

    `version` is that of the accepted file, as in `replicate.figures.record`.
    """

    curves: Mapping[tuple[str, str], Points]
    axes: Sequence[Mapping[str, Any]]
    figure: Mapping[str, Any] = field(default_factory=dict)
    version: int = VERSION
    words: Words | None = None  # if none were accepted

    @property
    def record(self) -> Record:
        """The record of the figure."""
        return Record(self.figure, self.axes, self.curves, self.version)


State = TableState | FigureState


def present_state(outcome: Outcome, result: Result) -> State:
    """Return what a run computed, as it would be read back after accepting it."""
    if isinstance(result, FigureResult):
        return replace(figure_state(result.curves, result.axes, result.figure), words=_words(outcome, result))
    columns, rows = _rows(outcome, result)
    return TableState(dict(keyed(columns, row) for row in rows), _words(outcome, result))


def figure_state(
    curves: pd.DataFrame, axes: Sequence[Mapping[str, Any]], figure: Mapping[str, Any] | None = None
) -> FigureState:
    """Return the state of a figure whose curves are in a frame with the columns ``panel, curve, x, y``."""
    places: dict[tuple[str, str], list[int]] = {}
    for place, (panel, curve) in enumerate(zip(curves["panel"], curves["curve"], strict=True)):
        places.setdefault((str(panel), str(curve)), []).append(place)
    points = curves[["x", "y"]].to_numpy(dtype=float)
    return FigureState({key: points[rows] for key, rows in places.items()}, axes, figure or {})


def read_state(folder: Path, paper: str, exhibit: str, kind: type[Result]) -> State | str:
    """Return the accepted state of an exhibit, or the name of the file that is missing.

    Raises
    ------
    AcceptedStateError
        If a file is damaged; the message names file and line.
    """
    data, axes = folder / paper / f"{exhibit}.csv", folder / paper / f"{exhibit}.json"
    for path in (data, axes) if kind is FigureResult else (data,):
        if not path.is_file():
            return path.name
    if kind is FigureResult:
        return _read_figure(data, axes)
    cells = read_cells(data, CLAIM_COLUMNS if kind is ClaimsResult else TABLE_COLUMNS)
    return TableState(cells, read_words(axes) if axes.is_file() else None)


def _read_figure(data: Path, axes: Path) -> FigureState:
    described = read_record(axes)
    figure, words = without_words(described.figure, f"{axes.parent.name}/{axes.name}")
    state = FigureState(read_curves(data), described.panels, figure, described.version, words)
    known = {str(panel["panel"]) for panel in state.axes}
    for panel, curve in state.curves:
        if panel not in known:
            msg = f"{data.parent.name}/{axes.name}: does not describe panel '{panel}', where curve '{curve}' is"
            raise AcceptedStateError(msg)
    return state


def files_of(folder: Path, exhibit: str) -> list[Path]:
    """Return the files of an exhibit in a paper's folder, those that exist."""
    return [path for end in ENDINGS if (path := folder / f"{exhibit}{end}").is_file()]


def is_state(folder: Path, exhibit: str) -> bool:
    """Whether the files of an exhibit are those of an accepted state, going by the first column of the data.

    Earlier versions had fewer of the others.
    """
    data = folder / f"{exhibit}.csv"
    if not data.is_file():
        return False
    first = re.split(rb"[,\r\n]", data.read_bytes(), maxsplit=1)[0].decode(errors="replace")
    return first in {TABLE_COLUMNS[0], CLAIM_COLUMNS[0], CURVE_COLUMNS[0]}


def state_files(outcome: Outcome, result: Result) -> dict[str, bytes]:
    """Return the files, by name, that describe the present state of an exhibit."""
    if not isinstance(result, FigureResult):
        return {
            f"{result.exhibit}.csv": csv_text(*_rows(outcome, result)).encode(),
            f"{result.exhibit}.json": words_text(_words(outcome, result)).encode(),
        }
    return {
        f"{result.exhibit}.csv": curves_text(result.curves).encode(),
        f"{result.exhibit}.json": record_text(with_words(result.figure, _words(outcome, result)), result.axes).encode(),
        f"{result.exhibit}.png": _small(result.png),
    }


def restated_figure(outcome: Outcome, result: Result, accepted: FigureState) -> dict[str, bytes]:
    """Return the file, by its name, that says the present words of a figure, whose drawing stays as accepted."""
    record = record_text(with_words(accepted.figure, _words(outcome, result)), accepted.axes)
    return {f"{result.exhibit}.json": record.encode()}


def is_picture(path: Path) -> bool:
    """Whether a file is a picture that can be shown."""
    from PIL import Image

    try:
        with Image.open(path) as picture:
            picture.load()
    except (OSError, ValueError, SyntaxError):  # all that Pillow says of damaged files
        return False
    return True


def _small(png: bytes) -> bytes:
    """Return a picture of half the size in few colours, for people to glance at."""
    from PIL import Image

    with Image.open(io.BytesIO(png)) as picture:
        half = (picture.width // 2, picture.height // 2)
        small = picture.convert("RGB").resize(half, Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    small.quantize(64, dither=Image.Dither.NONE).save(buffer, format="png", optimize=True)
    return buffer.getvalue()


def _words(outcome: Outcome, result: Result) -> Words:
    """Return what the paper's own files say of an exhibit, and what checking its claims found."""
    (paper,) = (paper for paper in outcome.papers if paper.id == result.paper)
    ledger = outcome.inputs[paper.id].ledger if paper.id in outcome.inputs else Ledger()
    evidence = None
    if isinstance(result, ClaimsResult):
        evidence = {id: finding.evidence for id, finding in result.findings.items()}
    return words_of(paper.exhibits[result.exhibit], ledger.of(result.exhibit), evidence)


def _rows(outcome: Outcome, result: TableResult | ClaimsResult) -> tuple[Sequence[str], list[tuple[str, ...]]]:
    """Return header and rows of the accepted CSV of a table or of claims."""
    if isinstance(result, ClaimsResult):
        found = result.findings.items()
        return CLAIM_COLUMNS, [(id, one.verdict, number_text(one.value, DIGITS)) for id, one in found]
    verdicts = {
        (verdict.row, verdict.column): (verdict.printed, str(verdict.verdict))
        for verdict in outcome.judgements[result.paper].verdicts
        if verdict.exhibit == result.exhibit
    }
    return TABLE_COLUMNS, [
        (row, column, reading, number_text(value, DIGITS), *verdicts.get((row, column), ("", "")))
        for reading, row, column, value in _values(result)
    ]


def _values(result: TableResult) -> Iterator[tuple[str, str, str, object]]:
    for reading, frame in result.frames.items():
        for row, values in zip(frame.index, frame.itertuples(index=False, name=None), strict=True):
            for column, value in zip(frame.columns, values, strict=True):
                yield reading, str(row), str(column), value

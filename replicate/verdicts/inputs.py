"""What judging a paper needs besides its results: printed numbers and ledger, read and checked before computing.

A typing error in a data file is reported at once, not after the run.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from importlib.resources.abc import Traversable
from pathlib import PurePosixPath

from replicate.errors import TemplateError
from replicate.exhibits import Exhibit, Paper, Table
from replicate.exhibits.file_names import display_name
from replicate.exhibits.printed import Key, PrintedValue, read_printed
from replicate.exhibits.read_off import COLUMN
from replicate.plain_text import read_text
from replicate.verdicts.ledger import Ledger
from replicate.verdicts.prose import check_syntax

Printed = Mapping[str, Mapping[Key, PrintedValue]]

_TEXTS = ("notes", "handout")


@dataclass(frozen=True)
class Inputs:
    """A paper's own data files.

    Attributes
    ----------
    printed
        By exhibit id: the printed numbers by (row, column).
    unused
        A line for each file of printed numbers that belongs to no exhibit.
    """

    printed: Printed = field(default_factory=dict)
    ledger: Ledger = field(default_factory=Ledger)
    unused: tuple[str, ...] = ()


def _points(table: Table) -> dict[Key, PrintedValue]:
    return {
        (point.id, COLUMN): PrintedValue(
            point.y, point.id, COLUMN, point.line, reading_error=Decimal(str(point.y_error))
        )
        for point in table.points
    }


def read_inputs(paper: Paper) -> Inputs:
    """Read printed numbers and ledger of a paper, and check the syntax of its texts.

    Raises
    ------
    PrintedFileError, LedgerError, TemplateError
        If a file is missing or malformed; the message names file, line and cell.
    """
    folder = paper.load().folder()
    printed = {
        id: _points(exhibit) if exhibit.points else read_printed(folder / "printed" / f"{id}.csv", exhibit)
        for id, exhibit in paper.exhibits.items()
        if isinstance(exhibit, Table) and exhibit.printed
    }
    ledger = Ledger.load_all(folder, paper)
    for entry in ledger.entries:
        for text in (entry.explanation, entry.evidence):
            check_syntax(text, entry.file, entry.line)
    for file in sorted(folder.iterdir(), key=lambda file: file.name):
        if file.name.endswith(".md") and file.name.startswith(_TEXTS):
            check_syntax(read_text(file, display_name(file), TemplateError), display_name(file))
    return Inputs(printed, ledger, tuple(_unused(paper, folder / "printed")))


def _unused(paper: Paper, folder: Traversable) -> Iterator[str]:
    """Yield a line for each file of printed numbers that nothing reads."""
    printed = {f"{id}.csv" for id, exhibit in paper.exhibits.items() if isinstance(exhibit, Table) and exhibit.printed}
    points = {f"{id.removesuffix('-points')}.csv" for id, exhibit in paper.exhibits.items() if _is_read_off(exhibit)}
    data = {PurePosixPath(name).name for exhibit in paper.exhibits.values() for name in paper.data_of(exhibit)}
    for file in sorted(folder.iterdir(), key=lambda file: file.name) if folder.is_dir() else ():
        if file.name.endswith(".csv") and file.name not in printed | points | data:
            allowed = ", ".join(sorted(printed | points)) or "none"
            yield f"{display_name(file)}: belongs to no exhibit with printed values; read: {allowed}"


def _is_read_off(exhibit: Exhibit) -> bool:
    return isinstance(exhibit, Table) and bool(exhibit.points)

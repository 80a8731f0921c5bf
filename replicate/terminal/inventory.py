"""Lists of papers and of the exhibits of a paper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from replicate.exhibits import Claims, Exhibit, Paper, Table
from replicate.terminal.gaps import reasons, standing
from replicate.terminal.mathtext import readable

_NARROW = 90


def print_papers(papers: Iterable[Paper], console: Console) -> None:
    """Print one line per paper: id, title, year, and how many exhibits of each kind it has."""
    grid = _grid("paper", "year", "title", "exhibits")
    for paper in papers:
        kinds = Counter(exhibit.kind for exhibit in paper.exhibits.values())
        exhibits = ", ".join(_counted(count, kind) for kind, count in kinds.items())
        grid.add_row(Text(paper.id), str(paper.year), Text(readable(paper.title)), exhibits)
    console.print(grid)


def print_exhibits(paper: Paper, console: Console, accepted: Path) -> None:
    """Print one line per exhibit (id, kind, status, title, readings), then what is missing and why.

    On a narrow terminal, where five columns would leave no room for words, kind and readings are left out.
    """
    console.print(Text(paper.citation))
    narrow = console.width < _NARROW
    grid = _grid("exhibit", "status", "title") if narrow else _grid("exhibit", "kind", "status", "title", "readings")
    for exhibit in paper.exhibits.values():
        id, status, title = exhibit.id, standing(paper, exhibit, accepted), readable(exhibit.title)
        cells = (id, status, title) if narrow else (id, exhibit.kind, status, title, _content(exhibit))
        grid.add_row(*map(Text, cells))
    console.print(grid)
    missing = reasons(paper, accepted)
    if missing:
        console.print(Text("\nWhat cannot be computed, and why", style="bold"))
    for reason, exhibits in missing.items():
        console.print(Padding(Text(f"{', '.join(exhibits)}: {readable(reason)}"), (0, 0, 0, 2)))


def _content(exhibit: Exhibit) -> str:
    if isinstance(exhibit, Table):
        return ", ".join(exhibit.readings) if len(exhibit.readings) > 1 else ""
    if isinstance(exhibit, Claims):
        return _counted(len(exhibit.claims), "claim")
    return ""


def _counted(count: int, kind: str) -> str:
    """Return a number of things; claims come as one exhibit, whose kind is a plural already."""
    if kind == "claims":
        return "claims" if count == 1 else f"{count} sets of claims"
    return f"{count} {kind}{'s' if count != 1 else ''}"


def _grid(*headings: str) -> Grid:
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for heading in headings:
        grid.add_column(
            heading,
            no_wrap=heading in {"paper", "exhibit", "kind", "status"},
            overflow="fold",
            min_width=28 if heading == "title" and "readings" in headings else None,
        )
    return grid

"""A table in pieces that fit a page: a tower of one column beside itself, very many columns below each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from replicate.display.labels import key_text
from replicate.display.spanners import Span, spans

if TYPE_CHECKING:
    from replicate.display.tables import Cell, TableView

_TOWER, _MOST_STRETCHES = 14, 3  # lines of a table with one column from which on it is a tower; pieces at most
_WIDEST = 16  # columns that fit a page laid sideways


@dataclass(frozen=True)
class Piece:
    """Some columns of some rows of a table.

    Attributes
    ----------
    columns
        Their keys.
    first
        Place of the first of them among those of the table.
    spans
        The columns in groups that stand under one head.
    rows
        Number in the table, key and cells of each row.
    """

    columns: list[str]
    first: int
    spans: list[Span]
    rows: list[tuple[int, str, list[Cell]]]


def pieces(view: TableView) -> list[Piece]:
    """Return the pieces of a table; one that fits is a single piece."""
    rows = [(number, row, cells) for number, (row, cells) in enumerate(view.rows, 1)]
    count = -(-len(view.columns) // _WIDEST)
    if count < 2:
        return [_piece(view, view.columns, 0, stretch) for stretch in _stretches(view, rows)]
    ends = [len(view.columns) * place // count for place in range(count + 1)]
    return [
        _piece(view, view.columns[start:end], start, [(number, row, cells[start:end]) for number, row, cells in rows])
        for start, end in pairwise(ends)
    ]


def _piece(view: TableView, columns: list[str], first: int, rows: list[tuple[int, str, list[Cell]]]) -> Piece:
    labels = [view.table.labels.get(column, key_text(column)) for column in columns]
    return Piece(columns, first, spans(labels), rows)


def _stretches(view: TableView, rows: Sequence[tuple[int, str, list[Cell]]]) -> list[list[tuple[int, str, list[Cell]]]]:
    """Return the rows of a table; those of a long one with a single column in stretches of similar length.

    The stretches can stand beside each other, where the whole would be a mostly white tower.
    """
    total = max(1, view.line_count)
    wanted = min(_MOST_STRETCHES, -(-total // _TOWER)) if len(view.columns) == 1 else 1
    stretches: list[list[tuple[int, str, list[Cell]]]] = [[] for _ in range(wanted)]
    height = 0
    for entry in rows:
        stretches[height * wanted // total].append(entry)
        height += view.height(entry[2])
    return [stretch for stretch in stretches if stretch] or [[]]

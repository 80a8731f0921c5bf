"""Compare the cells of a table, or the claims of a paper, with the accepted ones.

The columns of the accepted CSV are compared by what they hold: ``computed`` as numbers, ``printed`` and
``verdict`` exactly. Printed value and verdict belong to the cell and are reported once, not for every reading.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from replicate.diff.changes import Change, Kind, moved, relative
from replicate.exhibits import AS_WRITTEN
from replicate.figures.differences import same_number

#: Of an accepted table, by (row, column, reading): the other columns. A claim has neither column nor reading.
Cells = Mapping[tuple[str, ...], Mapping[str, str]]

#: The columns that are compared and the kind of a change in them, the kind that matters most last.
_FIELDS: dict[str, Kind] = {"computed": "value", "printed": "printed", "verdict": "verdict"}


@dataclass(frozen=True)
class CellChange:
    """A computed value, or a claim, that is not as accepted.

    Attributes
    ----------
    key
        ``(row, column, reading)``, or ``(row,)`` for a claim.
    before, after
        The columns of the accepted CSV; ``None`` on the side where there is no such cell.
    columns
        Those that differ and are reported here.
    """

    key: tuple[str, ...]
    before: Mapping[str, str] | None
    after: Mapping[str, str] | None
    columns: tuple[str, ...] = ()

    @property
    def kind(self) -> Kind:
        """What matters most about it."""
        if self.before is None or self.after is None:
            return "new" if self.before is None else "removed"
        return _FIELDS[self.columns[-1]]

    @property
    def reading(self) -> str:
        """The reading whose value changed; empty as written, or if only what is said of the cell changed."""
        told = not self.columns or "computed" in self.columns
        reading = (*self.key, "", "")[2]
        return reading if told and reading != AS_WRITTEN else ""

    @property
    def name(self) -> str:
        """Row, column and, other than as written, the reading."""
        return " ".join(self.key[:2]) + (f" ({self.reading})" if self.reading else "")

    def change(self, paper: str, exhibit: str) -> Change:
        """Say it in words."""
        if self.before is None or self.after is None:
            word = "new" if self.before is None else "gone"
            return Change(paper, exhibit, self.kind, f"{self.name} is {word}", self.name)
        one, other = self.before.get(self.columns[-1], ""), self.after.get(self.columns[-1], "")
        size = None
        if "computed" in self.columns:
            size = relative(self.before["computed"], self.after["computed"])
        text = f"{self.name} {'; '.join(self._words(self.before, self.after))}"
        return Change(paper, exhibit, self.kind, text, self.name, one, other, size)

    def _words(self, before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
        for column in self.columns:
            one, other = before.get(column, ""), after.get(column, "")
            if column == "computed":
                yield moved(one, other)
            else:
                yield f"{column} {one or 'nothing'} -> {other or 'nothing'}"


def compare_cells(before: Cells, after: Cells) -> tuple[list[CellChange], int]:
    """Compare two states of a table or of claims.

    Returns
    -------
    changes
        Those of verdicts first, then in the order of the table.
    unchanged
        Number of computed values (or claims) that did not change.
    """
    changes: list[CellChange] = []
    unchanged = 0
    told: set[tuple[tuple[str, ...], str]] = set()
    for key in dict.fromkeys((*before, *after)):
        old, new = before.get(key), after.get(key)
        if old is None or new is None:
            changes.append(CellChange(key, old, new))
            continue
        differ = []
        for column, kind in _FIELDS.items():
            one, other = old.get(column, ""), new.get(column, "")
            if kind == "value":
                if not same_number(one, other):
                    differ.append(column)
            elif one != other and (key[:2], column) not in told:
                told.add((key[:2], column))
                differ.append(column)
        if differ:
            changes.append(CellChange(key, old, new, tuple(differ)))
        else:
            unchanged += 1
    changes.sort(key=lambda change: change.kind != "verdict")
    return changes, unchanged

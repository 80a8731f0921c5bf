"""The page that shows what changed: words, both states in one picture, how far apart they are, and cells.

It stands alone like the pages of the report, and a script that it does not need adds a swipe between the two
pictures of a figure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from replicate.diff.accepted import FigureState
from replicate.diff.cells import CellChange
from replicate.diff.changes import relative
from replicate.diff.comparison import Comparison, ExhibitDiff
from replicate.diff.counts import summary
from replicate.display.addresses import address, pages_of
from replicate.display.labels import heading
from replicate.display.rendering import render
from replicate.exhibits import Claims, Paper
from replicate.exhibits.numerals import parse_number
from replicate.figures.differences import percent
from replicate.run.outcome import Outcome
from replicate.verdicts.rows import CLAIM_COLUMN

if TYPE_CHECKING:
    from replicate.diff.drawings import Drawings

#: Pictures of more figures than this would make the page too heavy; it says how to see the others.
MOST_FIGURES = 24

# A change of a rule may move every value of a table.
_MOST_CELLS = 200


@dataclass(frozen=True)
class CellRow:
    """A changed cell as the template sees it: both computed values, also if only what is said of them changed."""

    cell: CellChange
    before: str
    after: str
    moved: bool
    size: str
    printed: tuple[str, str]  # empty where the print is as it was
    verdicts: tuple[str, str]  # empty where the verdict is as it was
    print: str  # as it is
    verdict: str
    direction: str  # whether the value came nearer to the print or went away from it
    address: str  # of the cell, relative to the report's folder


@dataclass(frozen=True)
class DiffView:
    """A changed exhibit as the template sees it; one that is not a figure, or one too many, has no `drawings`."""

    diff: ExhibitDiff
    label: str
    title: str
    drawings: Drawings | None = None
    cells: list[CellRow] = field(default_factory=list)
    more_cells: int = 0
    too_many: bool = False
    labels: Mapping[str, str] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """Id of the section."""
        return self.diff.name.replace("/", "-")

    @property
    def texts(self) -> list[str]:
        """What changed, in words, but for the cells, which have a table of their own with the names of the paper."""
        listed = {cell.name for cell in self.diff.cells}
        texts = [change.text.replace(" -> ", " → ") for change in self.diff.changes if change.where not in listed]
        if listed:
            count = len(self.diff.cells)
            texts.append(f"{count} cell{'s' if count > 1 else ''} changed, listed below")
        return [*texts[:-1], f"{texts[-1]}; {self.diff.same}"] if self.diff.same else texts


def page(
    comparison: Comparison, outcome: Outcome, commits: Sequence[tuple[str, str]] = (), jobs: int | None = None
) -> str:
    """Return the page of a comparison.

    Parameters
    ----------
    commits
        Names and commits of what is compared.
    jobs
        Number of processes that draw.

    Raises
    ------
    TemplateError
        If a title cannot be converted.
    """
    papers = {paper.id: paper for paper in outcome.papers}
    names = {diff.name: _name(diff, papers.get(diff.paper)) for diff in comparison.changed}
    figures = [(diff, names[diff.name][0] or diff.name) for diff in comparison.changed if _has_pictures(diff)]
    drawings = _drawn(figures[:MOST_FIGURES], jobs)
    views = [
        DiffView(
            diff,
            *names[diff.name],
            drawings.get(diff.name),
            [_row(cell, diff, papers.get(diff.paper)) for cell in diff.cells[:_MOST_CELLS]],
            max(0, len(diff.cells) - _MOST_CELLS),
            too_many=diff.name not in drawings and _has_pictures(diff),
            labels=_labels(diff, papers.get(diff.paper)),
        )
        for diff in comparison.changed
    ]
    return render(
        "diff.html",
        "diff/index.html",
        comparison=comparison,
        summary=summary(comparison),
        views=views,
        commits=commits,
    )


def _has_pictures(diff: ExhibitDiff) -> bool:
    """Whether it is a figure in one state at least, and not just its picture is missing or its words are others."""
    drawn = any(isinstance(state, FigureState) for state in (diff.before, diff.after))
    return drawn and any(change.where != "picture" and change.kind != "words" for change in diff.changes)


def _drawn(figures: Sequence[tuple[ExhibitDiff, str]], jobs: int | None) -> dict[str, Drawings]:
    """Return the pictures by exhibit; where nothing is drawn, nothing that draws is loaded."""
    if not figures:
        return {}
    from replicate.diff.drawings import draw_all

    return {diff.name: pictures for (diff, _), pictures in zip(figures, draw_all(figures, jobs), strict=True)}


def _name(diff: ExhibitDiff, paper: Paper | None) -> tuple[str, str]:
    exhibit = paper.exhibits.get(diff.exhibit) if paper else None
    return heading(diff.exhibit, exhibit.title if exhibit else "")


def _labels(diff: ExhibitDiff, paper: Paper | None) -> Mapping[str, str]:
    exhibit = paper.exhibits.get(diff.exhibit) if paper else None
    if isinstance(exhibit, Claims):
        return {id: claim.text for id, claim in exhibit.claims.items()}
    return getattr(exhibit, "labels", {})


def _address(cell: CellChange, diff: ExhibitDiff, paper: Paper | None) -> str:
    page = pages_of(paper).get(diff.exhibit, "") if paper else ""
    row, column = (*cell.key, CLAIM_COLUMN)[:2]
    return address(page or f"{diff.paper}.html", diff.exhibit, row, column)


def direction(printed: str, before: str, after: str) -> str:
    """Return whether a computed value moved to the print or away from it; empty where that cannot be said.

    Examples
    --------
    >>> direction("1.20", "1.3", "1.21"), direction("1.20", "1.21", "1.3"), direction("stable", "1", "2")
    ('nearer to the print', 'further from the print', '')
    """
    number = parse_number(printed)
    try:
        old, new = (abs(float(text) - float(number)) for text in (before, after)) if number is not None else (0.0, 0.0)
    except ValueError:
        return ""
    return "" if old == new else "nearer to the print" if new < old else "further from the print"


def _row(cell: CellChange, diff: ExhibitDiff, paper: Paper | None) -> CellRow:
    before, after = cell.before or {}, cell.after or {}
    values = before.get("computed", ""), after.get("computed", "")
    size = relative(*values) if "computed" in cell.columns else None
    printed, verdicts = ((before.get(name, ""), after.get(name, "")) for name in ("printed", "verdict"))
    small = size is not None and abs(size) < 1.0
    nothing = ("", "")
    return CellRow(
        cell,
        *values,
        "computed" in cell.columns or not cell.columns,
        f"{'+' if size > 0 else '−'}{percent(abs(size))}" if small and size is not None else "",
        printed if "printed" in cell.columns else nothing,
        verdicts if "verdict" in cell.columns or not cell.columns else nothing,
        printed[1] or printed[0],
        verdicts[1] or verdicts[0],
        direction(printed[1], *values) if "computed" in cell.columns else "",
        _address(cell, diff, paper),
    )

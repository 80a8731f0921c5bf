"""The page that shows what changed: words, both states in one picture, how far apart they are, and cells.

It stands alone like the pages of the report, and a script that it does not need adds a swipe between the two
pictures of a figure.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from replicate.diff.cells import CellChange
from replicate.diff.changes import relative
from replicate.diff.comparison import Comparison, ExhibitDiff
from replicate.diff.counts import summary
from replicate.diff.drawings import MOST_FIGURES, Drawings, draw_all
from replicate.display.labels import heading
from replicate.display.rendering import render
from replicate.exhibits import Paper
from replicate.figures.differences import percent
from replicate.run.outcome import Outcome

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


@dataclass(frozen=True)
class DiffView:
    """A changed exhibit as the template sees it; one that is no figure, or one too many, has no `drawings`."""

    diff: ExhibitDiff
    label: str
    title: str
    drawings: Drawings | None = None
    cells: list[CellRow] = field(default_factory=list)
    more_cells: int = 0
    too_many: bool = False

    @property
    def id(self) -> str:
        """Id of the section."""
        return self.diff.name.replace("/", "-")


def page(comparison: Comparison, outcome: Outcome, jobs: int | None = None) -> str:
    """Return the page of a comparison.

    Parameters
    ----------
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
    drawn = draw_all(figures[:MOST_FIGURES], jobs)
    drawings = {diff.name: pictures for (diff, _), pictures in zip(figures, drawn, strict=False)}
    views = [
        DiffView(
            diff,
            *names[diff.name],
            drawings.get(diff.name),
            [_row(cell) for cell in diff.cells[:_MOST_CELLS]],
            max(0, len(diff.cells) - _MOST_CELLS),
            too_many=diff.name not in drawings and _has_pictures(diff),
        )
        for diff in comparison.changed
    ]
    return render("diff.html", "diff/index.html", comparison=comparison, summary=summary(comparison), views=views)


def _has_pictures(diff: ExhibitDiff) -> bool:
    """Whether it is a figure, and not just a file is missing."""
    return bool(diff.pairs) and any(change.kind != "new" or change.where != "picture" for change in diff.changes)


def _name(diff: ExhibitDiff, paper: Paper | None) -> tuple[str, str]:
    exhibit = paper.exhibits.get(diff.exhibit) if paper else None
    return heading(diff.exhibit, exhibit.title if exhibit else "")


def _row(cell: CellChange) -> CellRow:
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
    )

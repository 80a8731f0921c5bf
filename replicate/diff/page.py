"""The page that shows what changed: words, both states in one picture, how far apart they are, and cells.

It stands alone like the pages of the report, and a script that it does not need adds a swipe between the two
pictures of a figure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from markupsafe import Markup

from replicate.accepted import FigureState
from replicate.diff.cells import CellChange
from replicate.diff.changes import relative
from replicate.diff.comparison import Comparison, ExhibitDiff
from replicate.diff.counts import summary
from replicate.diff.distance import Distances
from replicate.diff.redraw import MOST_CURVES, differences, overlay, picture
from replicate.diff.wording import percent
from replicate.exhibits import Paper
from replicate.outcome import Outcome
from replicate.report.figures import description, inline_svg
from replicate.report.labels import heading
from replicate.report.rendering import render

# A change of a rule may move every value of a table.
_MOST_CELLS = 200


@dataclass(frozen=True)
class CellRow:
    """A changed cell as the template sees it."""

    cell: CellChange
    before: str
    after: str
    size: str
    verdicts: tuple[str, str]  # empty where the verdict is as it was


@dataclass(frozen=True)
class DiffView:
    """A changed exhibit as the template sees it; pictures are elements of the page."""

    diff: ExhibitDiff
    label: str
    title: str
    overlay: str = ""
    differences: str = ""
    pictures: tuple[Markup, Markup] | None = None
    not_drawn: int = 0
    cells: list[CellRow] = field(default_factory=list)
    more_cells: int = 0

    @property
    def id(self) -> str:
        """Id of the section."""
        return self.diff.name.replace("/", "-")


def page(comparison: Comparison, outcome: Outcome) -> str:
    """Return the page of a comparison.

    Raises
    ------
    TemplateError
        If a title cannot be converted.
    """
    papers = {paper.id: paper for paper in outcome.papers}
    views = [_view(diff, papers.get(diff.paper)) for diff in comparison.changed]
    return render("diff.html", "diff/index.html", comparison=comparison, summary=summary(comparison), views=views)


def _view(diff: ExhibitDiff, paper: Paper | None) -> DiffView:
    exhibit = paper.exhibits.get(diff.exhibit) if paper else None
    label, title = heading(diff.exhibit, exhibit.title if exhibit else "")
    if isinstance(diff.before, FigureState) and isinstance(diff.after, FigureState):
        return _figure(diff, label, title, diff.before, diff.after)
    shown = diff.cells[:_MOST_CELLS]
    return DiffView(diff, label, title, cells=[_row(cell) for cell in shown], more_cells=len(diff.cells) - len(shown))


def _figure(diff: ExhibitDiff, label: str, title: str, before: FigureState, after: FigureState) -> DiffView:
    id = diff.name.replace("/", "-")
    name = label or title or diff.exhibit
    same = {(str(pair.axes["panel"]), pair.name) for pair in diff.pairs if not pair.moved}
    moved = sorted((pair for pair in diff.pairs if pair.moved), key=lambda pair: -_size(pair.distance))
    order = list(dict.fromkeys((*before.curves, *after.curves)))
    pictures = [
        _element(picture(state, f"{id}-{when}", order), f"{id}-{when}", f"{name}, {when}", description("", state.axes))
        for when, state in (("accepted", before), ("new", after))
    ]
    drawn = [pair for pair in moved if pair.values is not None or len(pair.distance[0].points)][:MOST_CURVES]
    both = curves = Markup()
    words = " ".join(change.text + "." for change in diff.changes)
    if len(same) < len(order):
        svg = overlay(before, after, same, f"{id}-overlay")
        both = _element(svg, f"{id}-overlay", f"{name}: accepted and new curves in one picture", words)
    if drawn:
        svg = differences(drawn, f"{id}-differences")
        curves = _element(svg, f"{id}-differences", f"{name}: how far the curves moved", words)
    return DiffView(
        diff,
        label,
        title,
        both,
        curves,
        (pictures[0], pictures[1]),
        len(moved) - len(drawn) if drawn else 0,
    )


def _element(svg: str, id: str, title: str, words: str) -> Markup:
    return Markup(inline_svg(svg, id, title, words))  # noqa: S704 -- our own drawing


def _size(distance: Sequence[Distances]) -> float:
    return max((part.largest for part in distance), default=0.0)


def _row(cell: CellChange) -> CellRow:
    before, after = cell.before or {}, cell.after or {}
    values = before.get("computed", ""), after.get("computed", "")
    size = relative(*values) if "computed" in cell.columns else None
    verdicts = (before.get("verdict", ""), after.get("verdict", ""))
    small = size is not None and abs(size) < 1.0
    return CellRow(
        cell,
        *values,
        f"{'+' if size > 0 else '−'}{percent(abs(size))}" if small and size is not None else "",
        verdicts if verdicts[0] != verdicts[1] else ("", ""),
    )

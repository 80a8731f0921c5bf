"""Exhibits as the templates see them: everything looked up, counted and sorted."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from markupsafe import Markup

from replicate.display import numbers, scores
from replicate.display.inline_svg import description, inline_svg
from replicate.display.labels import heading
from replicate.display.scores import Score
from replicate.display.source_code import Source, sources
from replicate.display.tables import TableView, classes, table_view
from replicate.exhibits import Claim, Claims, Exhibit, Figure, Finding, Paper, Table
from replicate.exhibits.numerals import parse_number
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import ClaimsResult, FigureResult, Result, TableResult
from replicate.verdicts.rows import ExhibitRow, Judgement, VerdictRow


@dataclass(frozen=True)
class FigureView:
    """A figure: the drawing as an element of the page or in a file beside it, or the reason why there is none."""

    figure: Figure
    svg: Markup
    error: str
    files: list[tuple[str, str]]  # (format, address)
    description: str = ""
    lightest: str = ""  # address of the drawing's file with the fewest bytes
    beside: str = ""  # address of the file that is shown in place of an element

    @property
    def names(self) -> list[str]:
        """The names of the curves that a legend lists, as the figure writes them."""
        found = re.findall(r' data-legend="([^"]*)"', self.svg)
        return [html.unescape(name) for name in dict.fromkeys(found)]


@dataclass(frozen=True)
class ClaimView:
    """A claim and what its check found, or the reason why the check failed."""

    claim: Claim
    finding: Finding | None
    value: str
    error: str

    @property
    def found(self) -> str:
        """Its verdict as names of classes, by which a page selects what it shows."""
        return classes([self.finding.verdict] if self.finding else [])


@dataclass(frozen=True)
class ExhibitView:
    """One exhibit; exactly one of `table`, `figure`, `claims` is set where it is `whole` and could be computed."""

    id: str
    label: str
    title: str
    kind: str
    status: str
    reason: str
    page: str
    score: Score
    verdicts: list[VerdictRow]
    sources: list[Source] = field(default_factory=list)
    table: TableView | None = None
    figure: FigureView | None = None
    claims: list[ClaimView] = field(default_factory=list)
    caption: str = ""
    files: list[tuple[str, str]] = field(default_factory=list)

    @property
    def found(self) -> str:
        """Its verdicts as names of classes, by which a page selects what it shows."""
        return classes(one.verdict for one in self.verdicts)

    @property
    def failed(self) -> bool:
        """Whether what stands in its place says why there is nothing to see."""
        return bool(
            (self.table and self.table.errors and not self.table.verdicts) or (self.figure and self.figure.error)
        )


def outlines(paper: Paper, judgement: Judgement, page_of: Mapping[str, str]) -> list[ExhibitView]:
    """Return a paper's exhibits in the order of its inventory, without what they show.

    Parameters
    ----------
    judgement
        Of this paper, or of several.
    page_of
        By exhibit: the file name of the page on which it stands.
    """
    rows = {row.exhibit: row for row in judgement.exhibits if row.paper == paper.id}
    verdicts: dict[str, list[VerdictRow]] = {}
    for verdict in (verdict for verdict in judgement.verdicts if verdict.paper == paper.id):
        verdicts.setdefault(verdict.exhibit, []).append(verdict)
    return [
        _outline(exhibit, rows[exhibit.id], verdicts.get(exhibit.id, []), page_of[exhibit.id])
        for exhibit in paper.exhibits.values()
    ]


def _outline(exhibit: Exhibit, row: ExhibitRow, verdicts: list[VerdictRow], page: str) -> ExhibitView:
    label, title = heading(exhibit.id, exhibit.title)
    return ExhibitView(
        id=exhibit.id,
        label=label,
        title=title,
        kind=exhibit.kind,
        status=row.status,
        reason=row.reason,
        page=page,
        score=scores.claims(verdicts) if isinstance(exhibit, Claims) else scores.values(verdicts),
        verdicts=verdicts,
    )


def whole(outline: ExhibitView, exhibit: Exhibit, result: Result | None) -> ExhibitView:
    """Return an exhibit with its table, figure or claims, if there is a result, and their sources."""
    match exhibit, result:
        case Table(), TableResult():
            base = f"data/tables/{result.paper}/{exhibit.id}"
            return replace(
                outline,
                table=table_view(exhibit, result, outline.verdicts),
                caption=exhibit.caption,
                sources=sources([reading.compute for reading in exhibit.readings.values()]),
                files=[(f"CSV, {id}" if len(result.frames) > 1 else "CSV", f"{base}.{id}.csv") for id in result.frames],
            )
        case Figure(), FigureResult():
            return replace(
                outline, figure=_figure(exhibit, result), caption=exhibit.caption, sources=sources([exhibit.draw])
            )
        case Claims(), ClaimsResult():
            checks = [claim.check for claim in exhibit.claims.values()]
            return replace(outline, claims=list(_claims(exhibit, result)), sources=sources(checks))
        case _:
            return outline


def _figure(figure: Figure, result: FigureResult) -> FigureView:
    if result.error:
        return FigureView(figure, Markup(""), result.error, [])
    base = f"data/figures/{result.paper}/{figure.id}"
    said = description(figure.alt, result.axes)
    svg = inline_svg(result.svg, f"svg-{figure.id}", figure.title, said, result.axes)
    files = [(suffix.upper(), f"{base}.{suffix}") for suffix in ("svg", "png", "csv")]
    lightest = f"{base}.{'png' if len(result.png) < len(result.svg) else 'svg'}"
    return FigureView(figure, Markup(svg), "", files, said, lightest)  # noqa: S704 -- drawn here; its texts are escaped


def _claims(claims: Claims, result: ClaimsResult) -> Iterable[ClaimView]:
    for claim in claims.claims.values():
        finding = result.findings.get(claim.id)
        printed = PrintedValue(claim.printed) if parse_number(claim.printed) is not None else None
        value = ""
        if finding:
            value = numbers.quoted(finding.value, finding.evidence) or numbers.shown(finding.value, printed)
        yield ClaimView(claim, finding, value, result.errors.get(claim.id, ""))

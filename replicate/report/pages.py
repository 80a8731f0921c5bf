"""The report: an overview of all papers and one page per paper (or per part of a long one).

Every page stands alone: style and script are inside it, nothing is fetched but drawings too heavy for a page, and all
can be read without the script.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import dropwhile, takewhile
from pathlib import Path
from types import MappingProxyType
from typing import Any

from replicate.display.addresses import address, page_name, pages_of, parts
from replicate.display.consequences import consequential
from replicate.display.environment import versions
from replicate.display.keeping import Keep, made_anew
from replicate.display.rendering import render
from replicate.errors import TemplateError
from replicate.exhibits import Paper
from replicate.exhibits.file_names import display_name
from replicate.exhibits.results import Results
from replicate.plain_text import read_text
from replicate.report.advice import advice
from replicate.report.errata_sheet import Erratum, Sheet, sheets
from replicate.report.notes import Piece, pieces, place
from replicate.report.search import KINDS, hits
from replicate.report.single_file import self_contained
from replicate.report.site import INDEX, Site
from replicate.report.views import ExhibitView, outlines, whole
from replicate.report.weight import within_limits
from replicate.resources import templates_dir
from replicate.run.modules import distributions_used
from replicate.verdicts.prose import Prose
from replicate.verdicts.rows import Judgement, VerdictRow

METHODS = "methods.html"
VERDICTS = "verdicts.html"  # in its place, where the project has no page on methods
ERRATA = "errata.html"
SEARCH = "search.html"
DATA = "data"  # the folder of what can be downloaded

_MOST_GRAVE = 8


@dataclass(frozen=True)
class Page:
    """A page of a paper: its file name, its prose, and the exhibits that stand on it."""

    paper: Paper
    part: str  # empty on the paper's main page
    title: str
    prose: list[Piece]
    exhibits: list[ExhibitView]

    @property
    def file(self) -> str:
        """The page's file name."""
        return page_name(self.paper.id, self.part)

    @property
    def by_id(self) -> dict[str, ExhibitView]:
        """The exhibits of the page by id."""
        return {exhibit.id: exhibit for exhibit in self.exhibits}

    @property
    def opening(self) -> str:
        """The prose before the first heading or exhibit: what a reader should see on the first screen."""
        before = takewhile(lambda piece: piece.kind == "text", self.prose)
        return "\n\n".join(piece.text for piece in before)

    @property
    def abstract(self) -> str:
        """The first paragraph of the opening."""
        return self.opening.partition("\n\n")[0]

    @property
    def body(self) -> list[Piece]:
        """The prose after the opening."""
        return list(dropwhile(lambda piece: piece.kind == "text", self.prose))

    @property
    def verdicts(self) -> list[VerdictRow]:
        """All verdicts on the page."""
        return [verdict for exhibit in self.exhibits for verdict in exhibit.verdicts]

    @property
    def unplaced(self) -> list[ExhibitView]:
        """The exhibits that the prose does not place, in the order of the inventory."""
        placed = {piece.text for piece in self.prose if piece.kind == "exhibit"}
        return [exhibit for exhibit in self.exhibits if exhibit.id not in placed]


def build_report(
    papers: Sequence[Paper],
    results: Results,
    judgement: Judgement,
    out_dir: Path,
    about: Site | None = None,
    keep: Keep = made_anew,
    keeps: Mapping[str, Keep] = MappingProxyType({}),
    uses: Callable[[Iterable[str]], set[str]] = distributions_used,
) -> list[Path]:
    """Write the report.

    Parameters
    ----------
    papers
        Loaded papers, in the order in which the report lists them.
    results
        What was computed, by (paper, exhibit).
    judgement
        Of all papers together.
    about
        Title, introduction and methods of the report as a whole.
    out_dir
        Folder of the pages; figures and tables are expected in ``../figures`` and ``../tables``.
    keep
        Keeps texts of the pages as they were converted, between runs.
    keeps
        By paper: keeps its pages as long as nothing that they are made of has changed.
    uses
        Returns the distributions that packages of papers use.

    Returns
    -------
    list of Path
        The files written, the overview first. Nothing is written before every page is complete.

    Raises
    ------
    TemplateError
        If prose asks for something that does not exist or cannot be converted.
    OSError
        If a file cannot be written.
    """
    site = {paper.id: paper_pages(paper, results, judgement) for paper in papers}
    about = about or Site()
    shared: dict[str, Any] = {"about": about, "language": about.language, "theme": about.theme, "keep": keep}
    advised = {id: advice(exhibit for page in pages for exhibit in page.exhibits) for id, pages in site.items()}
    found = sheets(papers, judgement)
    grave = [_listed(found, row) for row in consequential(judgement.verdicts)[:_MOST_GRAVE]]
    stamp = versions(uses(paper.package for paper in papers))
    overview: dict[str, Any] = {"stamp": stamp, "site": site, "papers": papers, "advised": advised, "grave": grave}
    texts = {INDEX: render("index.html", INDEX, **overview, **shared)}
    name = METHODS if about.methods else VERDICTS
    verdicts = (templates_dir() / "verdicts.md").read_text(encoding="utf-8")
    texts[name] = render("methods.html", name, verdicts=verdicts, **shared)
    mistakes = [erratum for sheet in found for erratum in sheet.errata]
    unexplained = [erratum for sheet in found for erratum in sheet.unexplained]
    texts[ERRATA] = render("errata.html", ERRATA, sheets=found, **shared)
    listed = hits(papers, judgement, {sheet.paper.id: sheet.errata for sheet in found})
    texts[SEARCH] = render("search.html", SEARCH, hits=listed, kinds=KINDS, **shared)
    for paper in papers:
        kept = keeps.get(paper.id, made_anew)
        for page in site[paper.id]:
            fill = partial(
                render,
                "paper.html",
                page.file,
                pages=site[paper.id],
                mistakes=[erratum for erratum in mistakes if erratum.page == page.file],
                unexplained=[erratum for erratum in unexplained if erratum.page == page.file],
                in_one_file=False,
                **shared,
            )
            texts[page.file] = kept(f"report/{page.file}", partial(_filled, fill, page, results))
    out_dir.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (out_dir / name).write_bytes(text.encode())
    return [out_dir / name for name in texts]


def _filled(fill: Callable[..., str], page: Page, results: Results) -> str:
    """Return a page with all that its exhibits show, light enough for a phone."""
    views = [whole(view, page.paper.exhibits[view.id], results.get((page.paper.id, view.id))) for view in page.exhibits]
    return within_limits(views, lambda lighter: fill(page=replace(page, exhibits=list(lighter))))


def _listed(found: Iterable[Sheet], row: VerdictRow) -> tuple[Paper, Erratum, VerdictRow, str]:
    """Return an error with its paper, the erratum that it belongs to, and its address."""
    sheet, erratum = next(
        (sheet, erratum)
        for sheet in found
        if sheet.paper.id == row.paper
        for erratum in sheet.errata
        if row in erratum.rows
    )
    return sheet.paper, erratum, row, address(erratum.page, row.exhibit, row.row, row.column)


def single_page(
    paper: Paper, results: Results, judgement: Judgement, data: Mapping[str, bytes], about: Site | None = None
) -> str:
    """Return a paper with all its parts as one page that needs no file beside it.

    Parameters
    ----------
    data
        What `replicate.report.data.data_files` returns.

    Raises
    ------
    TemplateError
        If prose asks for something that does not exist or cannot be converted.
    """
    about = about or Site()
    outline = outlines(paper, judgement, pages_of(paper))
    texts = [text for _, text in _texts(paper, results, judgement, outline)]
    views = [whole(view, paper.exhibits[view.id], results.get((paper.id, view.id))) for view in outline]
    page = Page(paper, "", paper.title, pieces("\n\n".join(texts)), views)
    (sheet,) = sheets([paper], judgement)
    text = render(
        "paper.html",
        page.file,
        page=page,
        pages=[page],
        mistakes=sheet.errata,
        unexplained=sheet.unexplained,
        in_one_file=True,
        language=about.language,
        theme=about.theme,
    )
    own = {page.file, *(page_name(paper.id, part) for part in parts(paper))}
    return self_contained(text, own, {f"{DATA}/{name}": content for name, content in data.items()})


def paper_pages(paper: Paper, results: Results, judgement: Judgement) -> list[Page]:
    """Return the pages of a paper, the main page first; their exhibits are outlines."""
    views = outlines(paper, judgement, pages_of(paper))
    pages = []
    for part, notes in _texts(paper, results, judgement, views):
        here = [view for view in views if view.page == page_name(paper.id, part)]
        title, text = _title(notes, f"Part {part}") if part else (paper.title, notes)
        pages.append(Page(paper, part, title, pieces(text), here))
    return pages


def _texts(
    paper: Paper, results: Results, judgement: Judgement, views: Sequence[ExhibitView]
) -> Iterator[tuple[str, str]]:
    """Yield the parts of a paper with the text of their notes, in which exhibits have their places."""
    folder = paper.folder()
    for part, file in [("", "notes.md"), *parts(paper).items()]:
        prose = Prose(paper, results, judgement.verdicts, {"exhibit": _Placing(page_name(paper.id, part), views)})
        notes = folder / file
        name = display_name(notes)
        yield part, prose.render(read_text(notes, name, TemplateError), name) if notes.is_file() else ""


class _Placing:
    """The function `exhibit` of the notes: puts an exhibit where it is called, once."""

    def __init__(self, page: str, views: Sequence[ExhibitView]) -> None:
        self._page = page
        self._views = {view.id: view for view in views}
        self._placed: set[str] = set()

    def __call__(self, id: str) -> str:
        view = self._views.get(id)
        if view is None:
            msg = f"exhibit('{id}'): no such exhibit; allowed: {', '.join(self._views) or 'none'}"
            raise TemplateError(msg)
        if view.page != self._page:
            return f"[{view.label or view.title}]({view.page}#{id})"
        if id in self._placed:
            msg = f"exhibit('{id}') is placed twice on this page; link to it with [text](#{id})"
            raise TemplateError(msg)
        self._placed.add(id)
        return place(id)


def _title(text: str, default: str) -> tuple[str, str]:
    """Split off a first-level heading at the start."""
    match = re.match(r"\s*# (.+)\n", text)
    return (match[1].strip(), text[match.end() :]) if match else (default, text)

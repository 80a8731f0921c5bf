"""What the search page lists: exhibits, claims and errata of all papers, each with its address."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from replicate.display.addresses import address
from replicate.display.labels import cited, heading
from replicate.exhibits import Claims, Exhibit, Paper
from replicate.report.errata_sheet import Erratum
from replicate.verdicts.rows import CLAIM_COLUMN, Judgement

KINDS = ("exhibits", "claims", "errata")


@dataclass(frozen=True)
class Hit:
    """An entry of the search page.

    Attributes
    ----------
    title, words
        Markdown: what is shown, and what is searched besides.
    paper
        Author and year, as one would cite it.
    verdict
        Of a claim or an erratum; empty for an exhibit.
    """

    kind: str
    title: str
    address: str
    paper: str
    verdict: str = ""
    words: str = ""


def hits(
    papers: Sequence[Paper],
    judgement: Judgement,
    page_of: Mapping[str, Mapping[str, str]],
    errata: Mapping[str, Sequence[Erratum]],
) -> list[Hit]:
    """Return the entries, paper by paper: exhibits, claims, errata.

    Parameters
    ----------
    page_of
        By paper and exhibit: the file name of the page.
    errata
        By paper, worst first.
    """
    verdicts = {
        (row.paper, row.exhibit, row.row): row.verdict for row in judgement.verdicts if row.column == CLAIM_COLUMN
    }
    return [
        hit
        for paper in papers
        for hit in (
            *(_exhibit(paper, exhibit, page_of[paper.id][exhibit.id]) for exhibit in paper.exhibits.values()),
            *_claims(paper, page_of[paper.id], verdicts),
            *(_erratum(paper, erratum) for erratum in errata[paper.id] if not erratum.claim),
        )
    ]


def _exhibit(paper: Paper, exhibit: Exhibit, page: str) -> Hit:
    label, title = heading(exhibit.id, exhibit.title)
    name = f"{label}: {title}" if label and title else label or title
    return Hit(KINDS[0], name, f"{page}#{exhibit.id}", cited(paper), words=getattr(exhibit, "caption", ""))


def _claims(paper: Paper, page_of: Mapping[str, str], verdicts: Mapping[tuple[str, str, str], str]) -> Iterable[Hit]:
    for exhibit in paper.exhibits.values():
        for claim in exhibit.claims.values() if isinstance(exhibit, Claims) else ():
            place = address(page_of[exhibit.id], exhibit.id, claim.id, CLAIM_COLUMN)
            verdict = verdicts.get((paper.id, exhibit.id, claim.id), "")
            yield Hit(KINDS[1], claim.text, place, cited(paper), verdict, claim.where)


def _erratum(paper: Paper, erratum: Erratum) -> Hit:
    first = erratum.first
    cell = f"{erratum.named(first.row)}, {erratum.named(first.column)}"
    more = f" and {len(erratum.rows) - 1} more" if len(erratum.rows) > 1 else ""
    right = f", should be {erratum.right(first)}" if erratum.right(first) else ""
    title = f"{erratum.exhibit}, {cell}{more}: printed {first.printed}{right}"
    return Hit(KINDS[2], title, erratum.address, cited(paper), first.verdict, first.explanation)

"""What the search page lists: exhibits, claims and errata of all papers, each with its address."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from replicate.display.addresses import address, page_name, parts_of
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
        Author and year, as one would cite it, and the part.
    verdict
        Of a claim or an erratum; empty for an exhibit.
    """

    kind: str
    title: str
    address: str
    paper: str
    verdict: str = ""
    words: str = ""


def hits(papers: Sequence[Paper], judgement: Judgement, errata: Mapping[str, Sequence[Erratum]]) -> list[Hit]:
    """Return the entries, paper by paper: exhibits, claims, errata.

    Parameters
    ----------
    errata
        By paper, worst first.
    """
    verdicts = {
        (row.paper, row.exhibit, row.row): row.verdict for row in judgement.verdicts if row.column == CLAIM_COLUMN
    }
    found: list[Hit] = []
    for paper in papers:
        parts = parts_of(paper)
        found += [_exhibit(paper, exhibit, parts[exhibit.id]) for exhibit in paper.exhibits.values()]
        found += _claims(paper, parts, verdicts)
        found += [_erratum(paper, erratum) for erratum in errata[paper.id] if not erratum.claim]
    return found


def _exhibit(paper: Paper, exhibit: Exhibit, part: str) -> Hit:
    label, title = heading(exhibit.id, exhibit.title)
    name = f"{label}: {title}" if label and title else label or title
    place = f"{page_name(paper.id, part)}#{exhibit.id}"
    return Hit(KINDS[0], name, place, _cited(paper, part), words=getattr(exhibit, "caption", ""))


def _claims(paper: Paper, parts: Mapping[str, str], verdicts: Mapping[tuple[str, str, str], str]) -> Iterable[Hit]:
    for exhibit in paper.exhibits.values():
        for claim in exhibit.claims.values() if isinstance(exhibit, Claims) else ():
            part = parts[exhibit.id]
            place = address(page_name(paper.id, part), exhibit.id, claim.id, CLAIM_COLUMN)
            verdict = verdicts.get((paper.id, exhibit.id, claim.id), "")
            yield Hit(KINDS[1], claim.text, place, _cited(paper, part), verdict, claim.where)


def _erratum(paper: Paper, erratum: Erratum) -> Hit:
    first = erratum.first
    more = f" and {len(erratum.rows) - 1} more" if len(erratum.rows) > 1 else ""
    right = f", should be {erratum.right(first)}" if erratum.right(first) else ""
    title = f"{erratum.exhibit}, {erratum.named(first)}{more}: printed {first.printed}{right}"
    return Hit(KINDS[2], title, erratum.address, _cited(paper, erratum.part), first.verdict, first.explanation)


def _cited(paper: Paper, part: str) -> str:
    return f"{cited(paper)}, part {part}" if part else cited(paper)

"""What a reader of the paper should correct or beware of, collected from all its exhibits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from replicate.display.tables import Note
from replicate.report.views import ClaimView, ExhibitView
from replicate.verdicts.rows import ERRORS

_TITLES = {
    "misprint": ("Misprints", "The print is wrong; the corrected value follows from the evidence given."),
    "damaged": (
        "Wrong in the print or in the copy at hand",
        "The corrected value follows from the evidence given; our copy cannot tell whether the paper itself is wrong.",
    ),
    "discrepant": ("Discrepancies", "The values differ from what the paper defines, for a documented cause."),
    "claims": ("Sentences that do not hold", "Claims that the computation contradicts, wholly or in part."),
    "unexplained": ("Open questions", "The values differ and no cause was found."),
}


@dataclass
class Group:
    """Errata of one kind: explanations of table cells, or claims, each with its exhibit."""

    id: str
    title: str
    meaning: str
    notes: list[tuple[ExhibitView, Note]] = field(default_factory=list)
    claims: list[tuple[ExhibitView, ClaimView]] = field(default_factory=list)


def errata(exhibits: Iterable[ExhibitView]) -> list[Group]:
    """Return the groups that are not empty: misprints first, open questions last."""
    groups = {id: Group(id, *texts) for id, texts in _TITLES.items()}
    for exhibit in exhibits:
        for note in exhibit.table.notes if exhibit.table else []:
            if note.verdict.verdict in groups:
                groups[note.verdict.verdict].notes.append((exhibit, note))
        for claim in exhibit.claims:
            if claim.finding and claim.finding.verdict in ERRORS:
                groups["claims"].claims.append((exhibit, claim))
    return [group for group in groups.values() if group.notes or group.claims]

"""The errata of every paper for one page: print, right value, evidence, consequence, and a text for the authors."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from replicate.display import numbers
from replicate.display.addresses import address, pages_of, parts_of
from replicate.display.consequences import errors
from replicate.display.distance import off
from replicate.display.labels import cell_keys, heading, key_text
from replicate.exhibits import Claims, Paper, Table
from replicate.verdicts.rows import CLAIM_COLUMN, Judgement, VerdictRow

_SENTENCE = re.compile(r"(?<=[\w)$%`*][.])\s+(?=[A-Z$*`])")
_TOLD = frozenset({"misprint", "damaged", "fails"})  # to the authors, besides all that has a consequence


@dataclass(frozen=True)
class Erratum:
    """Errors of one exhibit with one explanation.

    Attributes
    ----------
    rows
        The verdicts; the first speaks for all in what they share.
    exhibit
        What the exhibit is called on the page of its part.
    part
        The part of the paper that it belongs to, empty if the paper has none.
    claim
        The sentence of the paper, for a claim.
    where
        Where the paper makes it.
    address
        Where the first of them stands in the report.
    labels
        Display texts of row and column keys.
    columns
        Keys of the exhibit's columns, if it is a table.
    """

    rows: list[VerdictRow]
    exhibit: str
    part: str
    claim: str
    where: str
    address: str
    labels: dict[str, str]
    columns: Sequence[str]

    @property
    def first(self) -> VerdictRow:
        """The verdict that speaks for all."""
        return self.rows[0]

    @property
    def told(self) -> bool:
        """Whether the authors should hear of it."""
        return self.first.verdict in _TOLD or self.first.consequence not in {"", "none"}

    @property
    def title(self) -> str:
        """What the exhibit is called where other parts are at hand, too."""
        return f"Part {self.part}, {self.exhibit}" if self.part else self.exhibit

    def keys(self, row: VerdictRow) -> tuple[str, ...]:
        """Return the keys that name a cell inside its exhibit."""
        return cell_keys(row.row, row.column, self.columns)

    def named(self, row: VerdictRow) -> str:
        """Return what a cell is called inside its exhibit."""
        return ", ".join(self.labels.get(key, key_text(key)) for key in self.keys(row))

    @property
    def page(self) -> str:
        """File name of the page on which it stands."""
        return self.address.partition("#")[0]

    @property
    def reason(self) -> str:
        """The first sentence of the explanation."""
        text = " ".join(self.first.explanation.split())
        sentence = _SENTENCE.split(text, maxsplit=1)[0]
        # A full stop inside a formula, code or emphasis ends no sentence.
        return sentence if all(sentence.count(mark) % 2 == 0 for mark in "$`*") else text

    @staticmethod
    def number(row: VerdictRow) -> float | None:
        """Return what the deciding reading gives for a cell."""
        return next((one.number for one in row.values if one.reading == row.reading), None)

    @classmethod
    def exact(cls, row: VerdictRow) -> float | None:
        """Return the right value of a cell with all digits known: as computed, if that rounds to the corrected one."""
        number = cls.number(row)
        right = replace(row.value, text=row.corrected) if row.corrected and row.value else None
        if right is None or not right.states_number or (number is not None and not off(right, number)):
            return number
        return float(right.value)

    @classmethod
    def right(cls, row: VerdictRow) -> str:
        """Return the right value of a cell as text: the corrected one, or what the deciding reading gives.

        Empty where the definition differs, so that no one value is the right one.
        """
        return "" if row.cause == "definition" else cls.ours(row)

    @classmethod
    def ours(cls, row: VerdictRow) -> str:
        """Return the corrected value of a cell, or what the deciding reading gives, as text."""
        return row.corrected or numbers.shown(cls.number(row), row.value)


@dataclass(frozen=True)
class Sheet:
    """The errata of one paper, worst first, and what differs without an explanation."""

    paper: Paper
    errata: list[Erratum]
    unexplained: list[Erratum]

    @property
    def told(self) -> list[Erratum]:
        """What the text for the authors lists."""
        return [erratum for erratum in self.errata if erratum.told]


def sheets(papers: Sequence[Paper], judgement: Judgement) -> list[Sheet]:
    """Return the errata of every paper.

    Parameters
    ----------
    papers
        Loaded papers, in the order of the report.
    judgement
        Of all of them together.
    """
    found = []
    for paper in papers:
        own = [verdict for verdict in judgement.verdicts if verdict.paper == paper.id]
        unexplained = [verdict for verdict in own if verdict.verdict == "unexplained"]
        found.append(Sheet(paper, _grouped(paper, errors(own)), _grouped(paper, unexplained)))
    return found


def _grouped(paper: Paper, verdicts: Iterable[VerdictRow]) -> list[Erratum]:
    """Return verdicts in groups that share an exhibit and an explanation."""
    pages, known = pages_of(paper), parts_of(paper)
    groups: dict[tuple[str, ...], list[VerdictRow]] = {}
    for row in verdicts:
        own = row.row if row.column == CLAIM_COLUMN else ""
        groups.setdefault((row.exhibit, own, row.consequence, row.verdict, row.cause, row.explanation), []).append(row)
    found = []
    for rows in groups.values():
        row = rows[0]
        exhibit = paper.exhibits[row.exhibit]
        claim = exhibit.claims[row.row] if isinstance(exhibit, Claims) else None
        label, title = heading(row.exhibit, exhibit.title)
        place = address(pages[row.exhibit], row.exhibit, row.row, row.column)
        said = (claim.text, claim.where) if claim else ("", "")
        keys = (exhibit.labels, exhibit.columns) if isinstance(exhibit, Table) else ({}, ())
        found.append(Erratum(rows, label or title, known[row.exhibit], *said, place, *keys))
    return found

"""What judging a paper leaves behind: the rows of ``results.csv``, ``verdicts.csv`` and ``exhibits.csv``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from replicate.exhibits import ClaimVerdict
from replicate.exhibits.matching import MatchHow, MatchKind

ValueVerdict = Literal["reproduced", "reconstructed", "near", "misprint", "discrepant", "unexplained", "not-computable"]
Verdict = ValueVerdict | ClaimVerdict
Status = Literal["done", "partly", "not-computable"]

VALUE_VERDICTS: tuple[ValueVerdict, ...] = (
    "reproduced",
    "reconstructed",
    "near",
    "misprint",
    "discrepant",
    "unexplained",
    "not-computable",
)
CLAIM_VERDICTS: tuple[ClaimVerdict, ...] = ("holds", "holds-partly", "fails")
HOLDING: frozenset[Verdict] = frozenset({"reproduced", "reconstructed"})

CLAIM_COLUMN = "claim"


@dataclass(frozen=True)
class ResultRow:
    """One printed value under one reading; ``computed`` has 12 significant digits, or is empty."""

    paper: str
    exhibit: str
    row: str
    column: str
    printed: str
    reading: str
    computed: str
    match: MatchKind
    how: MatchHow


@dataclass(frozen=True)
class VerdictRow:
    """The verdict on one printed value or claim.

    Attributes
    ----------
    reading, computed
        The reading that decides the verdict, and what it gives.
    corrected
        For a misprint: what should stand there.
    cause, explanation
        From the ledger; for a reconstructed value the reading's title, for a claim its evidence. Markdown,
        one line.
    """

    paper: str
    exhibit: str
    row: str
    column: str
    printed: str
    verdict: Verdict
    reading: str
    computed: str
    corrected: str = ""
    cause: str = ""
    explanation: str = ""


@dataclass(frozen=True)
class ExhibitRow:
    """One exhibit of the paper's inventory, and how much of it could be computed."""

    paper: str
    exhibit: str
    kind: str
    title: str
    status: Status
    reason: str = ""


@dataclass(frozen=True)
class Judgement:
    """Everything that is said about one paper.

    Attributes
    ----------
    problems
        One line each: what keeps `replicate check` from passing.
    """

    results: list[ResultRow] = field(default_factory=list)
    verdicts: list[VerdictRow] = field(default_factory=list)
    exhibits: list[ExhibitRow] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

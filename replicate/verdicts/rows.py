"""What judging a paper leaves behind: the rows of ``results.csv``, ``verdicts.csv`` and ``exhibits.csv``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, get_args

from replicate.exhibits import ClaimVerdict, Consequence
from replicate.exhibits.matching import Match, MatchHow, MatchKind, computed_text
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import Proof
from replicate.verdicts.causes import Cause

if TYPE_CHECKING:
    from replicate.verdicts.strength import Strength

ValueVerdict = Literal[
    "reproduced",
    "consistent",
    "reconstructed",
    "near",
    "misprint",
    "damaged",
    "discrepant",
    "unexplained",
    "not-computable",
]
Certainty = Literal["", "witness", "proof", "joint-proof", "search", "joint-search"]
Verdict = ValueVerdict | ClaimVerdict
Status = Literal["done", "partly", "not-computable"]

VALUE_VERDICTS: tuple[ValueVerdict, ...] = get_args(ValueVerdict)
CLAIM_VERDICTS: tuple[ClaimVerdict, ...] = ("holds", "holds-partly", "undecided", "fails")
CONSEQUENCES: tuple[Consequence, ...] = ("safety", "formula", "comparison", "none")  # worst first
HOLDING: frozenset[Verdict] = frozenset({"reproduced", "consistent", "reconstructed"})
ERRORS: tuple[Verdict, ...] = ("misprint", "damaged", "discrepant", "fails", "holds-partly")

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
class RangeRow:
    """The range of one computed value over the printed inputs of a reading, and how certain its verdict is."""

    paper: str
    exhibit: str
    row: str
    column: str
    printed: str
    reading: str
    match: MatchKind
    lower: str
    upper: str
    certainty: Certainty


@dataclass(frozen=True)
class Computed:
    """What one reading gives for a printed value.

    Attributes
    ----------
    number
        ``None`` if there is none.
    word
        What is given if it is not a number: a word, a date, a pair of numbers.
    lower, upper
        Its range over the printed inputs of the reading; ``None`` if it takes none from the print.
    convention
        How the column's cells were shortened, judged by this reading.
    proof
        Of a number with a range that does not hold: what proves that no printed inputs give the print
        (`replicate.exhibits.results.Ranges`); empty where that is only the outcome of a search.
    printed
        The print that it is compared with.
    """

    reading: str
    number: float | None
    match: Match
    word: str = ""
    lower: float | None = None
    upper: float | None = None
    convention: str = ""
    proof: Proof | Literal[""] = ""
    printed: PrintedValue | None = None

    @property
    def text(self) -> str:
        """The number with 12 significant digits, or the word."""
        return self.word or computed_text(self.number)

    @property
    def certainty(self) -> Certainty:
        """How certain it is whether printed inputs give the print: some do, or a proof or a search says none do."""
        if self.lower is None:
            return ""
        if self.match.kind in {"equal", "consistent"}:
            return "witness"
        if self.proof:
            return "proof" if self.proof == "alone" else "joint-proof"
        return "joint-search" if self._reaches_print else "search"

    @property
    def _reaches_print(self) -> bool:
        """Whether the range and the numbers that round to the print have something in common."""
        if self.printed is None or self.lower is None or self.upper is None:
            return False
        low, high = self.printed.ends
        return self.lower <= high and low <= self.upper


@dataclass(frozen=True)
class VerdictRow:
    """The verdict on one printed value or claim: read once, matched once, and carried into every table.

    Attributes
    ----------
    reading, computed
        The reading that decides the verdict, and what it gives.
    corrected
        For a misprint or a damaged print: what should stand there.
    cause, explanation
        From the ledger; for a reconstructed value the reading's title, for a claim its evidence. Markdown,
        one line.
    lower, upper
        Ends of the exact range of the computed value while the printed inputs of the reading run through the
        intervals of their last digits; empty where the reading declares none. Twelve significant digits.
    convention
        ``rounded`` or ``truncated``: how the column's own cells were shortened; empty where they do not tell.
    consequence
        Of an error: what follows from it; empty for everything else.
    informed, answer
        Of an error: whether and when the authors heard of it, and what they said.
    value
        The print as it was read; ``None`` for a claim that prints no number.
    values
        What each reading gives for it, in the exhibit's order; empty for a claim that prints no number.
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
    cause: Cause | Literal[""] = ""
    explanation: str = ""
    lower: str = ""
    upper: str = ""
    convention: str = ""
    consequence: Consequence | Literal[""] = ""
    informed: str = ""
    answer: str = ""
    value: PrintedValue | None = None
    values: tuple[Computed, ...] = ()

    @property
    def results(self) -> list[ResultRow]:
        """One row of ``results.csv`` for each reading."""
        return [
            ResultRow(
                self.paper,
                self.exhibit,
                self.row,
                self.column,
                self.printed,
                one.reading,
                one.text,
                one.match.kind,
                one.match.how,
            )
            for one in self.values
        ]

    @property
    def ranges(self) -> list[RangeRow]:
        """One row of ``ranges.csv`` for each reading that takes inputs from the print."""
        return [
            RangeRow(
                self.paper,
                self.exhibit,
                self.row,
                self.column,
                self.printed,
                one.reading,
                one.match.kind,
                computed_text(one.lower),
                computed_text(one.upper),
                one.certainty,
            )
            for one in self.values
            if one.lower is not None
        ]


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
    unused
        Those of them that every command says: what the paper's files say of nothing, such as a ledger entry that
        explains no value.
    unreadable
        Those of them that break a run: a text asks for a result that does not exist.
    strengths
        How strong the match of a reading with its exhibit is, by paper, exhibit and reading.
    """

    verdicts: list[VerdictRow] = field(default_factory=list)
    exhibits: list[ExhibitRow] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    unused: list[str] = field(default_factory=list)
    unreadable: list[str] = field(default_factory=list)
    strengths: dict[tuple[str, str, str], Strength] = field(default_factory=dict)

    @property
    def results(self) -> list[ResultRow]:
        """Every printed value under every reading."""
        return [result for verdict in self.verdicts for result in verdict.results]

    @property
    def ranges(self) -> list[RangeRow]:
        """The range of every value over printed inputs."""
        return [found for verdict in self.verdicts for found in verdict.ranges]

    @property
    def compared(self) -> int:
        """How many printed values were compared with a computed one, each reading counted."""
        return sum(one.match.kind != "none" for verdict in self.verdicts for one in verdict.values)

    def extend(self, part: Judgement) -> None:
        """Add what is said about another part."""
        self.verdicts.extend(part.verdicts)
        self.exhibits.extend(part.exhibits)
        self.problems.extend(part.problems)
        self.unused.extend(part.unused)
        self.unreadable.extend(part.unreadable)
        self.strengths.update(part.strengths)

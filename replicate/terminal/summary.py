"""The one-screen summary at the end of a report: how many printed values hold, and how many claims."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from replicate.display import consequences
from replicate.display.words import CLAIM_VERDICTS, CONSEQUENCES, VERDICTS, Word
from replicate.terminal.colours import colour

if TYPE_CHECKING:
    from replicate.run.outcome import Outcome

Counts = Mapping[str, Mapping[str, Mapping[str, int]]]
"""By what is counted and by paper: how often each word was used."""


def counts_of(outcome: Outcome) -> Counts:
    """Return what the summary shows: verdicts, states of exhibits and consequences of errors, per paper."""
    said: dict[str, list[tuple[str, str]]] = {
        _ERRORS: [(row.paper, row.consequence or "none") for row in consequences.errors(outcome.judgement.verdicts)],
        _VERDICTS: [(row.paper, row.verdict) for row in outcome.judgement.verdicts],
        _EXHIBITS: [(row.paper, row.status) for row in outcome.judgement.exhibits],
    }
    return {
        what: {paper: dict(Counter(word for owner, word in pairs if owner == paper)) for paper in outcome.judgements}
        for what, pairs in said.items()
    }


def print_summary(counts: Counts, console: Console) -> None:
    """Print the verdicts on printed values and claims, and the state of the exhibits, per paper."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    table.add_column("")
    papers = list(counts[_VERDICTS])
    for heading in (*papers, "all"):
        table.add_column(heading, justify="right")
    _section(table, papers, "errors by consequence", CONSEQUENCES, counts[_ERRORS], total=False)
    _section(table, papers, "printed values", VERDICTS, counts[_VERDICTS])
    _section(table, papers, "claims", CLAIM_VERDICTS, counts[_VERDICTS])
    _section(table, papers, "exhibits", _STATUSES, counts[_EXHIBITS])
    console.print(table)


_ERRORS, _VERDICTS, _EXHIBITS = "errors", "verdicts", "exhibits"

_STATUSES = {
    word.id: word
    for word in (
        Word("done", "✓", "everything in it is computed"),
        Word("partly", "◐", "a part of it is computed"),
        Word("not-computable", "–", "nothing can be computed"),
    )
}


def _section(
    table: Table,
    papers: list[str],
    title: str,
    words: Mapping[str, Word],
    counts: Mapping[str, Mapping[str, int]],
    *,
    total: bool = True,
) -> None:
    """Add a line with the title and, if asked, the total, and one line for each word that occurs."""
    if table.row_count:
        table.add_row()
    per_paper = [sum(counts[paper].get(id, 0) for id in words) for paper in papers]
    table.add_row(Text(title, style="bold"), *(_numbers(per_paper, "bold") if total else ()))
    for id, word in words.items():
        numbers = [counts[paper].get(id, 0) for paper in papers]
        if any(numbers):
            table.add_row(Text(f"  {word.symbol} {word.name}", style=colour(id)), *_numbers(numbers, ""))


def _numbers(numbers: list[int], style: str) -> list[Text]:
    return [Text(str(number) if number else "·", style=style) for number in (*numbers, sum(numbers))]

"""The errors of a run, those that matter most first: what the overview counts and the errata list."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from replicate.display.words import CONSEQUENCES
from replicate.verdicts.rows import ERRORS, VerdictRow

_CONSEQUENCES = {id: place for place, id in enumerate(CONSEQUENCES)}
_VERDICTS = {id: place for place, id in enumerate(ERRORS)}


def errors(verdicts: Iterable[VerdictRow]) -> list[VerdictRow]:
    """Return the errors among verdicts, by consequence and verdict, otherwise in their order."""
    found = [verdict for verdict in verdicts if verdict.verdict in _VERDICTS]
    return sorted(found, key=lambda row: (_CONSEQUENCES[row.consequence or "none"], _VERDICTS[row.verdict]))


def consequential(verdicts: Iterable[VerdictRow]) -> list[VerdictRow]:
    """Return the errors from which something follows for what the paper says, worst first."""
    return [verdict for verdict in errors(verdicts) if verdict.consequence not in {"", "none"}]


def counted(verdicts: Iterable[VerdictRow]) -> str:
    """Return how many consequential errors of each kind there are, in words; empty if there is none.

    Trivial errors are not in it: they never share a number with consequential ones.
    """
    counter = Counter[str](verdict.consequence for verdict in consequential(verdicts))
    return ", ".join(f"{counter[id]} {word.name}" for id, word in CONSEQUENCES.items() if counter[id])

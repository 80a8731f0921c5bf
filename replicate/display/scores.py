"""How many verdicts of each kind: the numbers behind the small stacked bars."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from replicate.display.words import CLAIM_VERDICTS, VERDICTS, Word
from replicate.verdicts.rows import HOLDING, VerdictRow


@dataclass(frozen=True)
class Score:
    """Verdicts counted, best first; kinds that do not occur are left out."""

    counts: tuple[tuple[Word, int], ...]

    @property
    def total(self) -> int:
        """The number of verdicts."""
        return sum(count for _, count in self.counts)

    @property
    def holding(self) -> int:
        """How many printed values are equal under a reading, or how many claims hold."""
        return sum(count for word, count in self.counts if word.id in {*HOLDING, "holds"})

    def of(self, verdict: str) -> int:
        """Return how many verdicts of this kind there are."""
        return next((count for word, count in self.counts if word.id == verdict), 0)

    @property
    def sentence(self) -> str:
        """The counts as text."""
        return ", ".join(word.counted(count) for word, count in self.counts)


def values(verdicts: Iterable[VerdictRow]) -> Score:
    """Count the verdicts of printed values."""
    return _score(verdicts, VERDICTS)


def claims(verdicts: Iterable[VerdictRow]) -> Score:
    """Count the verdicts of claims."""
    return _score(verdicts, CLAIM_VERDICTS)


def _score(verdicts: Iterable[VerdictRow], words: Mapping[str, Word]) -> Score:
    counter = Counter[str](verdict.verdict for verdict in verdicts)
    return Score(tuple((word, counter[id]) for id, word in words.items() if counter[id]))

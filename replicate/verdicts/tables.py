"""The verdicts on the printed values of one table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from replicate.exhibits import AS_WRITTEN, Table
from replicate.exhibits.matching import Match, MatchKind, computed_text, match
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import TableResult
from replicate.verdicts.corrections import correction
from replicate.verdicts.ledger import CORRECTING_CAUSES, Cause, Ledger, LedgerEntry
from replicate.verdicts.rows import ERRORS, Computed, Judgement, ValueVerdict, VerdictRow

_CAUSE_VERDICTS: dict[Cause, ValueVerdict] = {
    "misprint": "misprint",
    "print-or-copy": "damaged",
    "scan": "damaged",
    "definition": "discrepant",
    "method": "discrepant",
    "optimiser": "discrepant",
    "rounding": "discrepant",
    "measured": "not-computable",
    "unavailable": "not-computable",
    "unknown": "unexplained",
}


_AGREEMENT: tuple[MatchKind, ...] = ("equal", "consistent", "near", "differs", "none")


@dataclass
class TableJudge:
    """The judging of one table.

    Attributes
    ----------
    paper
        Its id.
    printed
        The printed values by (row, column); empty where the paper prints none.
    judgement
        What `judge` fills: verdicts and problems.
    """

    paper: str
    table: Table
    result: TableResult
    printed: Mapping[Key, PrintedValue]
    ledger: Ledger
    judgement: Judgement = field(default_factory=Judgement)
    numbers: dict[str, dict[Key, float]] = field(default_factory=dict)  # by reading
    matches: dict[str, dict[Key, Match]] = field(default_factory=dict)  # by reading
    words: dict[str, dict[Key, str]] = field(default_factory=dict)  # by reading

    def judge(self) -> list[tuple[int, LedgerEntry]]:
        """Fill the judgement, and return which of its verdicts come from which ledger entry."""
        explained = []
        for reading in self.table.readings:
            self._read(reading)
        held = {key: self._held(key) for key in self.printed}
        entries = dict(self._assign({key for key, verdict in held.items() if verdict is None}))
        for key, value in self.printed.items():
            entry = entries.get(key)
            verdict = held[key] or (self._explained(key, entry) if entry else self._unexplained(key, value))
            if entry:
                explained.append((len(self.judgement.verdicts), entry))
            self.judgement.verdicts.append(verdict)
        return explained

    def _read(self, reading: str) -> None:
        """Take the numbers of one reading and compare them."""
        numbers, words = dict[Key, float](), dict[Key, str]()
        found = self.result.cells.get(reading)
        if reading in self.result.errors:
            self._problem(f"reading '{reading}' failed: {self.result.errors[reading]}")
        elif found is None:
            self._problem(f"reading '{reading}' was not computed")
        else:
            spread = {cell: value for key, value in self.printed.items() for cell in self._cells(key)}
            numbers, words, wrong = found.pick(spread)
            for line in wrong:
                self._problem(f"reading '{reading}': {line}")
        self.numbers[reading], self.words[reading], self.matches[reading] = numbers, words, {}
        for key, value in self.printed.items():
            # Of the cells that one printed number stands for, the one that agrees least speaks for all.
            matches = {cell: match(value, numbers.get(cell), word=words.get(cell, "")) for cell in self._cells(key)}
            least = max(matches, key=lambda cell: _AGREEMENT.index(matches[cell].kind))
            self.matches[reading][key] = matches[least]
            if least != key:
                _speak_for(key, least, numbers)
                _speak_for(key, least, words)

    def _cells(self, key: Key) -> list[Key]:
        return [key, *self.table.spans.get(key, ())]

    def _held(self, key: Key) -> VerdictRow | None:
        """Return the verdict on a value that some reading gives, as written first; ``None`` if none does."""
        for reading in self.table.readings.values():
            if self.matches[reading.id][key].kind == "equal":
                if reading.id == AS_WRITTEN:
                    return self._verdict_row(key, "reproduced", reading.id)
                return replace(self._verdict_row(key, "reconstructed", reading.id), explanation=reading.title)
        return None

    def _assign(self, open_keys: set[Key]) -> Iterator[tuple[Key, LedgerEntry]]:
        """Give each value that does not hold its ledger entry, and report entries that do not apply."""
        taken: set[Key] = set()
        for entry in self.ledger.of(self.table.id):
            place = self.ledger.place(entry)
            if entry.explicit:
                named = [(row, column) for row in entry.rows for column in entry.columns]
                self.judgement.problems.extend(
                    f"{place}: {self.table.id} {_cell(key)} "
                    + ("no longer differs" if key in self.printed else "is blank in the paper")
                    for key in named
                    if key not in open_keys
                )
                found = [key for key in named if key in open_keys]
            else:
                found = [key for key in self.printed if key in open_keys - taken and entry.covers(*key)]
                if not found:
                    self.judgement.problems.append(f"{place}: {self.table.id}: explains no printed value that differs")
            right = [key for key in found if self._correction_holds(key, entry)]
            taken.update(right)
            yield from ((key, entry) for key in right)

    def _correction_holds(self, key: Key, entry: LedgerEntry) -> bool:
        """Check that the reading of a wrong print gives a right value, and the one that the entry states."""
        if entry.cause not in CORRECTING_CAUSES:
            return True
        problem = correction(key, entry, self.printed, self.numbers[entry.reading]).problem
        if problem:
            place = f"{self.ledger.place(entry)}: {self.table.id} {_cell(key)}"
            self.judgement.problems.append(f"{place}: {problem}")
        return not problem

    def _explained(self, key: Key, entry: LedgerEntry) -> VerdictRow:
        corrected = ""
        if entry.cause in CORRECTING_CAUSES:
            corrected = correction(key, entry, self.printed, self.numbers[entry.reading]).text
        verdict = _CAUSE_VERDICTS[entry.cause]
        return replace(
            self._verdict_row(key, verdict, entry.reading),
            corrected=corrected,
            cause=entry.cause,
            explanation=" ".join(text for text in (entry.explanation, entry.evidence) if text),
            consequence=entry.consequence if verdict in ERRORS else "",
            informed=entry.informed,
            answer=entry.answer,
        )

    def _unexplained(self, key: Key, value: PrintedValue) -> VerdictRow:
        for reading in self.table.readings:
            if self.matches[reading][key].kind == "near":
                return self._verdict_row(key, "near", reading)
        if self.result.errors and not any(key in numbers for numbers in self.numbers.values()):
            return self._verdict_row(key, "unexplained", AS_WRITTEN)  # the failure is on record already
        computed = [
            f"{reading} {computed_text(self.numbers[reading].get(key)) or 'nothing'}" for reading in self.numbers
        ]
        self._problem(f"{_cell(key)}: printed {value.text}, computed {', '.join(computed)}: has no ledger entry")
        return self._verdict_row(key, "unexplained", AS_WRITTEN)

    def _verdict_row(self, key: Key, verdict: ValueVerdict, reading: str) -> VerdictRow:
        return VerdictRow(
            self.paper,
            self.table.id,
            *key,
            self.printed[key].text,
            verdict,
            reading,
            self.words[reading].get(key) or computed_text(self.numbers[reading].get(key)),
            value=self.printed[key],
            values=tuple(self._computed(key, id) for id in self.table.readings),
        )

    def _computed(self, key: Key, reading: str) -> Computed:
        number, word = self.numbers[reading].get(key), self.words[reading].get(key, "")
        return Computed(reading, number, self.matches[reading][key], word)

    def _problem(self, text: str) -> None:
        self.judgement.problems.append(f"{self.paper} {self.table.id}: {text}")


def _speak_for(key: Key, other: Key, given: dict[Key, Any]) -> None:
    given.pop(key, None)
    if other in given:
        given[key] = given[other]


def _cell(key: Key) -> str:
    return f"row '{key[0]}', column '{key[1]}'"

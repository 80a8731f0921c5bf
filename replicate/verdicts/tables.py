"""The verdicts on the printed values of one table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from replicate.exhibits import AS_WRITTEN, Table
from replicate.exhibits.conventions import tallies
from replicate.exhibits.matching import computed_text
from replicate.exhibits.printed import Key, PrintedValue
from replicate.exhibits.results import TableResult
from replicate.exhibits.rounded_inputs import given_cells
from replicate.verdicts.causes import CORRECTING_CAUSES, Cause
from replicate.verdicts.consequences import with_consequences
from replicate.verdicts.corrections import Correction, correction
from replicate.verdicts.ledger import Ledger, LedgerEntry
from replicate.verdicts.matches import other_convention, reading_matches, share_points
from replicate.verdicts.rows import ERRORS, Computed, Judgement, ValueVerdict, VerdictRow
from replicate.verdicts.strength import Strength, strengths

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
_GIVEN = "Given: what else is computed of this table takes it from the print."


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
    computed: dict[str, dict[Key, Computed]] = field(default_factory=dict)  # by reading
    strengths: dict[str, Strength] = field(default_factory=dict)  # by reading
    given: set[Key] = field(default_factory=set)  # cells that the first reading takes from the print

    def judge(self) -> list[tuple[int, LedgerEntry]]:
        """Fill the judgement, and return which of its verdicts come from which ledger entry."""
        explained = []
        for reading in self.table.readings:
            self._read(reading)
        if AS_WRITTEN in self.result.errors:
            return []  # what the text says is not known, so nothing can be said of the print
        points = [reading for reading in self.table.readings if reading in self.result.ranges]
        share_points(self.table, self.printed, self.computed, points)
        self.given = given_cells(self.table, self.table.readings[AS_WRITTEN])
        self.strengths = strengths(self.table, self.computed)
        self.judgement.strengths.update({(self.paper, self.table.id, id): one for id, one in self.strengths.items()})
        held = {key: self._held(key) for key in self.printed}
        entries = dict(self._assign({key for key, verdict in held.items() if verdict is None}))
        for key, value in self.printed.items():
            entry = entries.get(key)
            verdict = held[key] or (self._explained(key, entry) if entry else self._unexplained(key, value))
            if entry:
                explained.append((len(self.judgement.verdicts), entry))
            self.judgement.verdicts.append(verdict)
        self.judgement.verdicts[:] = with_consequences(self.table, self.judgement.verdicts)
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
        self.numbers[reading] = numbers
        ranges = self.result.ranges.get(reading)
        given = {cell: numbers.get(cell, words.get(cell)) for cell in {**numbers, **words}}
        self.computed[reading] = reading_matches(self.table, reading, self.printed, given, ranges)
        for key, one in self.computed[reading].items():  # of a print that spans cells, one speaks for all
            numbers.pop(key, None)
            if one.number is not None:
                numbers[key] = one.number

    def _cells(self, key: Key) -> list[Key]:
        return [key, *self.table.spans.get(key, ())]

    def _held(self, key: Key) -> VerdictRow | None:
        """Return the verdict on a value that some reading gives, as written first; ``None`` if none does."""
        others = [reading.id for reading in self.table.readings.values() if reading.id != AS_WRITTEN]
        as_written = self.computed[AS_WRITTEN][key].match.kind
        if as_written == "equal":
            return self._verdict_row(key, "reproduced", AS_WRITTEN)
        if as_written == "consistent":
            return self._verdict_row(key, "consistent", AS_WRITTEN)
        for id in others:
            if self.computed[id][key].match.kind == "equal" and self._strong(id, key) and not self._outdone(id, key):
                return self._under(id, key, "reconstructed")
        for id in others:
            kind = self.computed[id][key].match.kind
            if kind == "consistent" or (kind == "equal" and id in self.result.ranges):
                return self._under(id, key, "consistent")
        return None

    def _under(self, reading: str, key: Key, verdict: ValueVerdict) -> VerdictRow:
        return replace(self._verdict_row(key, verdict, reading), explanation=self.table.readings[reading].title)

    def _strong(self, reading: str, key: Key) -> bool:
        return self.strengths[reading].holds_for(self.table.quantity(*key))

    def _outdone(self, reading: str, key: Key) -> bool:
        """Say whether a reading that meets more values of the same quantity computes this one, and does not meet it."""
        quantity = self.table.quantity(*key)
        _, met = self.strengths[reading].lines[quantity]
        return any(
            self.computed[id][key].match.kind in {"near", "differs"}
            and self._strong(id, key)
            and self.strengths[id].lines.get(quantity, (0, 0))[1] > met
            for id in self.table.readings
            if id not in {AS_WRITTEN, reading}
        )

    def _assign(self, open_keys: set[Key]) -> Iterator[tuple[Key, LedgerEntry]]:
        """Give each value that does not hold its ledger entry, and report entries that do not apply."""
        taken: set[Key] = set()
        for entry in self.ledger.of(self.table.id):
            if entry.explicit:
                named = [(row, column) for row in entry.rows for column in entry.columns]
                self._unused(
                    f"{entry.place}: {self.table.id} {_cell(key)} "
                    + ("no longer differs" if key in self.printed else "is blank in the paper")
                    for key in named
                    if key not in open_keys
                )
                found = [key for key in named if key in open_keys]
            else:
                found = [
                    key
                    for key in self.printed
                    if key in open_keys - taken and entry.covers(*key) and not self._by_other_convention(key)
                ]
                if not found:
                    self._unused([f"{entry.place}: {self.table.id}: explains no printed value that differs"])
            right = [key for key in found if self._correction_holds(key, entry)]
            taken.update(right)
            yield from ((key, entry) for key in right)

    def _by_other_convention(self, key: Key) -> bool:
        return any(other_convention(found[key]) for found in self.computed.values())

    def _correction_holds(self, key: Key, entry: LedgerEntry) -> bool:
        """Check that the reading of a wrong print gives a right value, and the one that the entry states."""
        if entry.cause not in CORRECTING_CAUSES:
            return True
        problem = self._correction(key, entry).problem
        if problem:
            self.judgement.problems.append(f"{entry.place}: {self.table.id} {_cell(key)}: {problem}")
        return not problem

    def _correction(self, key: Key, entry: LedgerEntry) -> Correction:
        quantity = self.table.quantity(*key)
        others = {place: value for place, value in self.printed.items() if self.table.quantity(*place) == quantity}
        return correction(key, entry, others, self.numbers[entry.reading])

    def _explained(self, key: Key, entry: LedgerEntry) -> VerdictRow:
        corrected, reading = "", entry.reading
        if entry.cause in CORRECTING_CAUSES:
            corrected = self._correction(key, entry).text
        elif self.computed[reading][key].match.kind == "equal":
            reading = AS_WRITTEN  # one that gives the print, but is too weak to tell, does not say how far off it is
        verdict = _CAUSE_VERDICTS[entry.cause]
        return replace(
            self._verdict_row(key, verdict, reading),
            corrected=corrected,
            cause=entry.cause,
            explanation=" ".join(text for text in (entry.explanation, entry.evidence) if text),
            consequence=entry.consequence if verdict in ERRORS else "",
            informed=entry.informed,
            answer=entry.answer,
        )

    def _unexplained(self, key: Key, value: PrintedValue) -> VerdictRow:
        near = [id for id in self.table.readings if self.computed[id][key].match.kind == "near"]
        if near:
            best = next((id for id in near if other_convention(self.computed[id][key])), near[0])
            return replace(self._verdict_row(key, "near", best), explanation=self._remark(key, best))
        if self.result.errors and not any(key in numbers for numbers in self.numbers.values()):
            return self._verdict_row(key, "unexplained", AS_WRITTEN)  # the failure is on record already
        if key in self.given and not any(key in numbers for numbers in self.numbers.values()):
            return replace(self._verdict_row(key, "not-computable", AS_WRITTEN), explanation=_GIVEN)
        computed = [
            f"{reading} {computed_text(self.numbers[reading].get(key)) or 'nothing'}" for reading in self.numbers
        ]
        self._problem(f"{_cell(key)}: printed {value.text}, computed {', '.join(computed)}: has no ledger entry")
        return self._verdict_row(key, "unexplained", AS_WRITTEN)

    def _remark(self, key: Key, reading: str) -> str:
        """Say by which convention a near value would hold, or that only a reading too weak to tell brings it near."""
        one = self.computed[reading][key]
        weak = [id for id, found in self.computed.items() if found[key].match.kind == "equal"]
        if weak and not other_convention(one):
            strength = self.strengths[weak[0]]
            return f"Equal under the reading “{weak[0]}”, which is too weak to tell. {strength.sentence}"
        if not other_convention(one):
            chosen = reading != AS_WRITTEN and not self._strong(reading, key)
            return f"Near under the reading “{reading}” only, one of {len(self.table.readings)}." if chosen else ""
        count = tallies(self.table, {place: other.match for place, other in self.computed[reading].items()})
        verb = "truncated" if one.match.how == "truncated" else "rounded"
        own = count[self.table.quantity(*key)]
        line = "row" if self.table.cases_are_columns else "column"
        return f"Holds if it was {verb}; of its {line} {own.sentence}." if own.total > 1 else f"Holds if it was {verb}."

    def _verdict_row(self, key: Key, verdict: ValueVerdict, reading: str) -> VerdictRow:
        one = self.computed[reading][key]
        return VerdictRow(
            self.paper,
            self.table.id,
            *key,
            self.printed[key].text,
            verdict,
            reading,
            one.text,
            lower=computed_text(one.lower),
            upper=computed_text(one.upper),
            convention=one.convention if one.match.how else "",
            value=self.printed[key],
            values=tuple(self.computed[id][key] for id in self.table.readings),
        )

    def _unused(self, lines: Iterable[str]) -> None:
        for line in lines:
            self.judgement.problems.append(line)
            self.judgement.unused.append(line)

    def _problem(self, text: str) -> None:
        self.judgement.problems.append(f"{self.paper} {self.table.id}: {text}")


def _cell(key: Key) -> str:
    return f"row '{key[0]}', column '{key[1]}'"

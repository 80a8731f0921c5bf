"""The ledger: a paper's explanations of the printed values that do not hold.

``ledger.toml`` is a list of entries::

    [[entry]]
    exhibit = "table-2"
    rows = ["IAESPC"]            # row keys, or "*"
    columns = ["delay_time"]     # column keys, or "*"
    cause = "misprint"
    explanation = "..."          # Markdown; results are pulled in with {{ value(...) }}, never typed
    reading = "authors"          # optional: the reading that shows the right value; default "as-written"
    corrected = "1.67"           # optional, for misprint, print-or-copy and scan; default: the reading's value
    evidence = "..."             # optional; needed with a consequence
    consequence = "comparison"   # optional: none (default), comparison, safety or formula
    informed = "..."             # optional: when and how the authors heard of it
    answer = "..."               # optional: what they said

An entry whose rows and columns are both lists names its cells *explicitly*: each must be a printed value
that does not hold. With ``"*"`` it covers the cells that do not hold and must find at least one. What
depends on results is checked when the paper is judged (`replicate.verdicts.judge`); this module checks all that
can be known without.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import get_args

from replicate.errors import LedgerError, listed
from replicate.exhibits import AS_WRITTEN, Consequence, Paper, Table
from replicate.exhibits.file_names import display_name
from replicate.exhibits.numerals import ALLOWED, parse_number
from replicate.plain_text import parse_toml, read_text, steering
from replicate.verdicts.causes import CAUSES, CORRECTING_CAUSES, Cause

_CONSEQUENCES: tuple[Consequence, ...] = get_args(Consequence)

ANY = "*"
LEDGER = "ledger.toml"

_REQUIRED = ("exhibit", "rows", "columns", "cause", "explanation")
_OPTIONAL = ("reading", "corrected", "evidence", "consequence", "informed", "answer")
_ENTRY_HEADER = re.compile(r"^\s*\[\[\s*entry\s*\]\]")


@dataclass(frozen=True)
class LedgerEntry:
    """One explanation and the cells it covers.

    Attributes
    ----------
    rows, columns
        Keys, or ``("*",)``.
    corrected
        The right value as text; empty if the reading's value is to be shown at the printed precision, or with as
        many of its digits as the evidence bears.
    consequence
        What follows from the error; more than ``none`` needs evidence.
    informed, answer
        When and how the authors heard of it, and what they said; empty texts if nobody wrote to them.
    file, line
        What messages call the entry's file, and its line there, from 1.
    """

    exhibit: str
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    cause: Cause
    explanation: str
    reading: str = AS_WRITTEN
    corrected: str = ""
    evidence: str = ""
    consequence: Consequence = "none"
    informed: str = ""
    answer: str = ""
    file: str = LEDGER
    line: int = 0

    @property
    def place(self) -> str:
        """File and line, as messages name them."""
        return f"{self.file}:{self.line}"

    @property
    def explicit(self) -> bool:
        """Whether every cell is named by its row and column."""
        return ANY not in self.rows and ANY not in self.columns

    def covers(self, row: str, column: str) -> bool:
        """Whether the cell is among those the entry names, a ``*`` standing for every key."""
        return (ANY in self.rows or row in self.rows) and (ANY in self.columns or column in self.columns)


@dataclass(frozen=True)
class Ledger:
    """The entries of one paper, in the order of its file or files."""

    entries: tuple[LedgerEntry, ...] = ()

    @classmethod
    def load(cls, path: Traversable | Path, paper: Paper) -> Ledger:
        """Read and check a ledger. A paper without the file has an empty one.

        Parameters
        ----------
        path
            The ``ledger.toml``.
        paper
            The loaded paper: exhibits, row and column keys and readings must be its own.

        Raises
        ------
        LedgerError
            If the file is no TOML, an entry has a wrong, unknown or missing field, names something the paper
            does not have, or two entries name the same cell. The message names file, line and field.
        """
        name = display_name(path)
        if not (os.path.lexists(path) if isinstance(path, Path) else path.is_file()):
            return cls()
        text = read_text(path, name, LedgerError)
        data = parse_toml(text, name, LedgerError)
        raw = data.pop("entry", [])
        if data or not isinstance(raw, list) or not all(isinstance(item, dict) for item in raw):
            found = f"; found '{next(iter(data))}'" if data else ""
            msg = f"{name}: allowed: [[entry]] tables only{found}"
            raise LedgerError(msg)
        lines = [number for number, line in enumerate(text.splitlines(), 1) if _ENTRY_HEADER.match(line)]
        if len(lines) != len(raw):  # an inline list of tables, or the header inside a multi-line text
            lines = [1] * len(raw)
        entries = tuple(_entry(name, line, item, paper) for line, item in zip(lines, raw, strict=True))
        _check_named_once(entries)
        return cls(entries)

    @classmethod
    def load_all(cls, folder: Traversable | Path, paper: Paper) -> Ledger:
        """Read ``ledger.toml`` and, for a work of several parts, every ``ledger-<part>.toml`` of a paper's folder.

        Raises
        ------
        LedgerError
            As `load`, and if two files name the same cell.
        """
        parts = sorted(
            entry.name
            for entry in folder.iterdir()
            if entry.name.startswith("ledger-") and entry.name.endswith(".toml")
        )
        entries = tuple(entry for name in (LEDGER, *parts) for entry in cls.load(folder / name, paper).entries)
        _check_named_once(entries)
        return cls(entries)

    def of(self, exhibit: str) -> list[LedgerEntry]:
        """Return the entries of one exhibit, those that name their cells explicitly first."""
        return sorted(
            (entry for entry in self.entries if entry.exhibit == exhibit),
            key=lambda entry: not entry.explicit,
        )


def _entry(file: str, line: int, raw: dict[str, object], paper: Paper) -> LedgerEntry:
    place = f"{file}:{line}"
    missing = [key for key in _REQUIRED if key not in raw]
    unknown = [key for key in raw if key not in _REQUIRED + _OPTIONAL]
    if missing or unknown:
        what = f"'{missing[0]}' is missing" if missing else f"'{unknown[0]}' is not a field"
        msg = f"{place}: {what}; required: {', '.join(_REQUIRED)}; allowed: {', '.join(_OPTIONAL)}"
        raise LedgerError(msg)
    exhibit_id = _text(place, raw, "exhibit")
    exhibit = paper.exhibits.get(exhibit_id)
    tables = [key for key, item in paper.exhibits.items() if isinstance(item, Table) and item.printed]
    if not isinstance(exhibit, Table) or not exhibit.printed:
        what = "is not an exhibit of the paper" if exhibit is None else "has no printed values to explain"
        msg = f"{place}: exhibit '{exhibit_id}' {what}; allowed: {listed(tables)}"
        raise LedgerError(msg)
    cause = next((known for known in CAUSES if known == raw["cause"]), None)
    if cause is None:
        msg = f"{place}: cause {raw['cause']!r} is unknown; allowed: {', '.join(CAUSES)}"
        raise LedgerError(msg)
    consequence = next((known for known in _CONSEQUENCES if known == raw.get("consequence", "none")), None)
    if consequence is None:
        msg = f"{place}: consequence {raw['consequence']!r} is unknown; allowed: {', '.join(_CONSEQUENCES)}"
        raise LedgerError(msg)
    entry = LedgerEntry(
        exhibit=exhibit_id,
        rows=_keys(place, raw, "rows", exhibit.rows),
        columns=_keys(place, raw, "columns", exhibit.columns),
        cause=cause,
        explanation=_text(place, raw, "explanation"),
        reading=_text(place, raw, "reading", AS_WRITTEN),
        corrected=_text(place, raw, "corrected", ""),
        evidence=_text(place, raw, "evidence", ""),
        consequence=consequence,
        informed=_text(place, raw, "informed", ""),
        answer=_text(place, raw, "answer", ""),
        file=file,
        line=line,
    )
    if entry.reading not in exhibit.readings:
        known = listed(exhibit.readings)
        msg = f"{place}: '{entry.reading}' is not a reading of {exhibit_id}; allowed: {known}"
        raise LedgerError(msg)
    if consequence != "none" and not entry.evidence:
        msg = f"{place}: consequence = '{consequence}' needs evidence, but 'evidence' is empty"
        raise LedgerError(msg)
    if entry.answer and not entry.informed:
        msg = f"{place}: 'answer' is given, but not when and how the authors were informed; expected: 'informed'"
        raise LedgerError(msg)
    _check_corrected(place, entry)
    return entry


def _check_corrected(place: str, entry: LedgerEntry) -> None:
    if not entry.corrected:
        return
    if entry.cause not in CORRECTING_CAUSES:
        causes = listed(cause for cause in CAUSES if cause in CORRECTING_CAUSES)
        msg = f"{place}: 'corrected' is allowed with the causes {causes} only"
        raise LedgerError(msg)
    if not entry.explicit or len(entry.rows) * len(entry.columns) != 1:
        msg = f"{place}: 'corrected' is one value, so the entry must name exactly one row and one column"
        raise LedgerError(msg)
    if parse_number(entry.corrected) is None:
        msg = f"{place}: corrected = '{entry.corrected}' is not a number; allowed: {ALLOWED}"
        raise LedgerError(msg)


def _text(place: str, raw: dict[str, object], field: str, default: str | None = None) -> str:
    """Return a text field on one line. Numbers are refused: their trailing zeros would be lost."""
    value = raw.get(field, default)
    if not isinstance(value, str) or (default is None and not value.strip()):
        extent = "" if default is not None else " that is not empty"
        msg = f"{place}: {field} = {value!r}; expected: a quoted string{extent}"
        raise LedgerError(msg)
    if found := steering(value):
        msg = f"{place}: {field} holds the character {found}, which pages and terminals must not get"
        raise LedgerError(msg)
    return " ".join(value.split())


def _keys(place: str, raw: dict[str, object], field: str, allowed: Sequence[str]) -> tuple[str, ...]:
    value = raw[field]
    if value in (ANY, [ANY]):
        return (ANY,)
    if not isinstance(value, list) or not value:
        msg = f'{place}: {field} = {value!r}; expected: a list of keys or "{ANY}"'
        raise LedgerError(msg)
    for key in value:
        if key not in allowed:
            msg = f"{place}: {field}: {key!r} is not in the exhibit; allowed: {listed(allowed)}"
            raise LedgerError(msg)
        if value.count(key) > 1:
            msg = f"{place}: {field}: {key!r} appears twice"
            raise LedgerError(msg)
    return tuple(value)


def _check_named_once(entries: Iterable[LedgerEntry]) -> None:
    seen: dict[tuple[str, str, str], LedgerEntry] = {}
    for entry in entries:
        if not entry.explicit:
            continue
        for row in entry.rows:
            for column in entry.columns:
                first = seen.setdefault((entry.exhibit, row, column), entry)
                if first is not entry:
                    where = f"{entry.exhibit} row '{row}', column '{column}'"
                    other = f"line {first.line}" if first.file == entry.file else first.place
                    msg = f"{entry.place}: {where} is already named by the entry in {other}"
                    raise LedgerError(msg)

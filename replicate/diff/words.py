"""What is said of an exhibit besides its numbers: titles, notes of readings, explanations, claims. All of it is state.

An explanation that turns from "damage of the scan" into "misprint" accuses somebody, and no number moves. The words are
those of the paper's own files, with ``{{ value(...) }}`` unfilled: the numbers in them are compared as numbers.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from replicate.errors import AcceptedStateError
from replicate.exhibits import Claims, Exhibit, Table
from replicate.figures.json_text import parse_json
from replicate.verdicts.ledger import LedgerEntry

#: By what they are about (``title``, ``reading 'x': note``, ``explanation of A x: cause``): the text.
Words = Mapping[str, str]

FORMAT = "words of an exhibit"
VERSION = 1

_SHOWN = 36  # characters around what changed
_LEDGER = ("cause", "explanation", "reading", "corrected", "evidence", "consequence", "informed", "answer")
_DEFAULTS = {"reading": "as-written", "consequence": "none"}


def words_of(exhibit: Exhibit, entries: Sequence[LedgerEntry] = ()) -> Words:
    """Return the words of an exhibit.

    Parameters
    ----------
    entries
        What the ledger says of its cells.
    """
    return {about: text for about, text in _words(exhibit, entries) if text}


def _words(exhibit: Exhibit, entries: Sequence[LedgerEntry]) -> Iterator[tuple[str, str]]:
    yield "title", _plain(exhibit.title)
    if isinstance(exhibit, Claims):
        for claim in exhibit.claims.values():
            yield f"claim '{claim.id}'", _plain(claim.text)
            yield f"claim '{claim.id}': where", _plain(claim.where)
            yield f"claim '{claim.id}': printed", _plain(claim.printed)
    if not isinstance(exhibit, Table):
        return
    yield "caption", _plain(exhibit.caption)
    for name, texts in (("label", exhibit.labels), ("unit", exhibit.units)):
        for key, text in texts.items():
            yield f"{name} of '{key}'", _plain(text)
    for reading in exhibit.readings.values():
        yield f"reading '{reading.id}': title", _plain(reading.title)
        yield f"reading '{reading.id}': note", _plain(reading.note)
    names: dict[str, int] = {}
    for entry in entries:
        cells = f"{', '.join(entry.rows)} / {', '.join(entry.columns)}"
        names[cells] = names.get(cells, 0) + 1
        number = f" ({names[cells]})" if names[cells] > 1 else ""
        for field in _LEDGER:
            text = _plain(str(getattr(entry, field)))
            yield f"explanation of {cells}{number}: {field}", "" if text == _DEFAULTS.get(field) else text


def _plain(text: str) -> str:
    return " ".join(text.split())


def words_text(words: Words) -> str:
    """Return words as JSON, one line for each text."""
    content = {"format": FORMAT, "version": VERSION, "words": dict(words)}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def read_words(path: Path) -> Words:
    """Read accepted words.

    Raises
    ------
    AcceptedStateError
        If the file cannot be read or is none of ours.
    """
    where = f"{path.parent.name}/{path.name}"
    try:
        content: Any = parse_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        msg = f"{where}: cannot be read: {error.strerror or error}"
        raise AcceptedStateError(msg) from error
    except ValueError as error:
        line = f":{error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        msg = f"{where}{line}: is not valid JSON: {error}"
        raise AcceptedStateError(msg) from error
    words = content.get("words") if isinstance(content, dict) else None
    fits = isinstance(content, dict) and content.get("format") == FORMAT and content.get("version") == VERSION
    if not fits or not isinstance(words, dict) or not all(isinstance(text, str) for text in words.values()):
        msg = f"{where}: needed: an object with 'format' ('{FORMAT}'), 'version' ({VERSION}) and 'words', texts by name"
        raise AcceptedStateError(msg)
    return words


def compare_words(before: Words, after: Words) -> Iterator[tuple[str, str, str, str]]:
    """Yield what is said differently: what it is about, a sentence, and both texts."""
    for about in dict.fromkeys((*before, *after)):
        one, other = before.get(about, ""), after.get(about, "")
        if one != other:
            old, new = _around(one, other)
            yield about, f"{about} {old} -> {new}", one, other


def _around(one: str, other: str) -> tuple[str, str]:
    """Return both texts, long ones cut to where they differ."""
    if not one or not other:
        return _cut(one, 0, len(one)), _cut(other, 0, len(other))
    start = next((i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))
    rest = min(len(one), len(other)) - start
    end = next((i for i in range(rest) if one[-1 - i] != other[-1 - i]), rest)
    return _cut(one, start, len(one) - end), _cut(other, start, len(other) - end)


def _cut(text: str, start: int, end: int) -> str:
    if not text:
        return "nothing"
    low, high = max(0, start - _SHOWN), min(len(text), min(end, start + 2 * _SHOWN) + _SHOWN)
    return f"'{'…' if low else ''}{text[low:high]}{'…' if high < len(text) else ''}'"

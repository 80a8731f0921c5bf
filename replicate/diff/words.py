"""What is said of an exhibit besides its numbers: titles, notes of readings, explanations, claims. All of it is state.

An explanation that turns from "damage of the scan" into "misprint" accuses somebody, and no number moves. The words are
those of the paper's own files, with ``{{ value(...) }}`` unfilled: the numbers in them are compared as numbers. The
evidence of claims is what their checks said, numbers included.
"""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from replicate.errors import AcceptedStateError
from replicate.exhibits import Claims, Exhibit, Figure, Table
from replicate.figures.differences import ABSOLUTE
from replicate.figures.json_text import parse_json
from replicate.verdicts.ledger import LedgerEntry

FORMAT = "words of an exhibit"
VERSION = 1

_WORDS = "words"  # where in a figure's record they are
_SHOWN = 36  # characters around what changed
_LEDGER = ("cause", "explanation", "reading", "corrected", "evidence", "consequence", "informed", "answer")
_DEFAULTS = {"reading": "as-written", "consequence": "none"}
_NUMBER = re.compile(r"(\d+(?:\.\d+)?(?:e[-+]?\d+)?)")


@dataclass(frozen=True)
class Words:
    """The words of an exhibit.

    Attributes
    ----------
    texts
        By what they are about: ``title``, ``reading 'x': note``, ``explanation of A x: cause``.
    evidence
        Of claims, by their ids; ``None`` of what has none, and of what a version accepted that did not keep it.
    """

    texts: Mapping[str, str]
    evidence: Mapping[str, str] | None = None


def words_of(exhibit: Exhibit, entries: Sequence[LedgerEntry] = (), evidence: Mapping[str, str] | None = None) -> Words:
    """Return the words of an exhibit.

    Parameters
    ----------
    entries
        What the ledger says of its cells.
    evidence
        Of its claims.
    """
    said = None if evidence is None else {id: _plain(text) for id, text in evidence.items()}
    return Words({about: text for about, text in _words(exhibit, entries) if text}, said)


def _words(exhibit: Exhibit, entries: Sequence[LedgerEntry]) -> Iterator[tuple[str, str]]:
    yield "title", _plain(exhibit.title)
    if isinstance(exhibit, Figure):
        yield "caption", _plain(exhibit.caption)
        yield "alternative text", _plain(exhibit.alt)
        yield "stands for", _plain(exhibit.stands_for)
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
    content: dict[str, Any] = {"format": FORMAT, "version": VERSION, "words": dict(words.texts)}
    if words.evidence is not None:
        content["evidence"] = dict(words.evidence)
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
    known: dict[str, Any] = content if isinstance(content, dict) else {}
    words: Any = known.get("words")
    evidence: Any = known.get("evidence")
    fits = known.get("format") == FORMAT and known.get("version") == VERSION
    if not fits or not _are_texts(words) or not (evidence is None or _are_texts(evidence)):
        msg = (
            f"{where}: needed: an object with 'format' ('{FORMAT}'), 'version' ({VERSION}) and 'words', texts by name, "
            "of claims also with 'evidence', texts by id"
        )
        raise AcceptedStateError(msg)
    return Words(words, evidence)


def with_words(figure: Mapping[str, Any], words: Words) -> dict[str, Any]:
    """Return what a record says of a figure as a whole, with the words of the figure in it."""
    return {_WORDS: dict(words.texts), **figure}


def without_words(figure: Mapping[str, Any], where: str) -> tuple[dict[str, Any], Words | None]:
    """Split what a record says of a figure as a whole from the words of the figure; older versions kept none.

    Raises
    ------
    AcceptedStateError
        If the words are not texts by name.
    """
    words: Any = figure.get(_WORDS)
    if _WORDS in figure and not _are_texts(words):
        msg = f"{where}: '{_WORDS}' of the figure are {json.dumps(words)[:80]}; expected: texts by name"
        raise AcceptedStateError(msg)
    rest = {name: value for name, value in figure.items() if name != _WORDS}
    return rest, None if words is None else Words(words)


def _are_texts(content: Any) -> bool:
    return isinstance(content, dict) and all(isinstance(text, str) for text in content.values())


def compare_words(before: Words, after: Words, told: Collection[str] = ()) -> Iterator[tuple[str, str, str, str]]:
    """Yield what is said differently: what it is about, a sentence, and both texts.

    Parameters
    ----------
    told
        Ids of claims that found something else than accepted: their evidence says so in other words.
    """
    for about in dict.fromkeys((*before.texts, *after.texts)):
        one, other = before.texts.get(about, ""), after.texts.get(about, "")
        if one != other:
            yield _change(about, one, other)
    if before.evidence is None or after.evidence is None:
        return
    for id, other in after.evidence.items():
        one = before.evidence.get(id, "")
        if id not in told and not same_evidence(one, other):
            yield _change(f"claim '{id}': evidence", one, other)


def _change(about: str, one: str, other: str) -> tuple[str, str, str, str]:
    old, new = _around(one, other)
    return about, f"{about} {old} -> {new}", one, other


def same_evidence(one: str, other: str) -> bool:
    """Whether two sentences are the same, but for numbers that are zero but for rounding.

    Examples
    --------
    >>> same_evidence("by 3.1e-15 of 2.5", "by 8e-16 of 2.5"), same_evidence("at most 2.5", "at most 2.6")
    (True, False)
    """
    pairs = zip_longest(_NUMBER.split(one), _NUMBER.split(other), fillvalue="")
    return all(a == b or (_is_rounding(a) and _is_rounding(b)) for a, b in pairs)


def _is_rounding(text: str) -> bool:
    return _NUMBER.fullmatch(text) is not None and abs(float(text)) < ABSOLUTE


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

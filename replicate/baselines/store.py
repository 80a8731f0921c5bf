"""The folder of accepted figures: one record, one small picture and one list of acceptances for each.

``NAME.json`` is the record that is compared, ``NAME.png`` a picture for people, and each line of ``NAME.log`` an
acceptance: why, what had changed, and the digests of the state that it replaced, and of the record and the picture that
it made. A merge that mixes two acceptances shows, because the last line does not speak of the state that is there.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from replicate.errors import FigureError, FigureRecordError
from replicate.figures.record import Record
from replicate.staging import finish_interrupted, replace_files

#: What names of figures are made of, so that they are names of files everywhere.
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]*\Z")
_LONGEST = 150
_DIGITS = 16
_MARK = 6


def digest(content: str | bytes) -> str:
    """Return the digest of a record, or of a picture: the first digits of its SHA-256.

    Examples
    --------
    >>> digest("")
    'e3b0c44298fc1c14'
    """
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()[:_DIGITS]


def checked_name(name: object) -> str:
    """Return the name of a figure.

    Raises
    ------
    FigureError
        If it cannot be that of a file on every system.

    Examples
    --------
    >>> checked_name("step-response_2")
    'step-response_2'
    """
    if not isinstance(name, str) or not _NAME.match(name) or len(name) > _LONGEST:
        msg = (
            f"a figure cannot be called {name!r}: needed are letters, digits, '-' and '_', "
            f"the first a letter or a digit, at most {_LONGEST} of them"
        )
        raise FigureError(msg)
    return name


def name_of(text: str) -> str:
    """Return a name of a figure that is made from any text: the text itself, if it can be one.

    Otherwise a digest is part of it, so that no two texts have the same name.

    Examples
    --------
    >>> name_of("test_step-PI"), name_of("test_step[a/b]"), name_of("test_step[a b]")
    ('test_step-PI', 'test_step-a-b-8f34a2', 'test_step-a-b-d6ea1e')
    """
    if _NAME.match(text) and len(text) <= _LONGEST:
        return text
    mark = digest(text)[:_MARK]
    words = re.sub(r"[^A-Za-z0-9_]+", "-", text).strip("-_")[: _LONGEST - _MARK - 1]
    return f"{words or 'figure'}-{mark}"


def chosen_figure(text: str) -> tuple[str, str | None]:
    """Return a name and the digest that follows it, if one does.

    Examples
    --------
    >>> chosen_figure("plots/step-1=0123456789abcdef"), chosen_figure("step-1"), chosen_figure("step-1=")
    (('plots/step-1', '0123456789abcdef'), ('step-1', None), ('step-1', ''))
    """
    name, equals, digest = text.partition("=")
    return name, digest if equals else None


@dataclass(frozen=True)
class Accepted:
    """An accepted figure: its record, the digest of its file, and its picture, if there is one."""

    record: Record
    digest: str
    picture: bytes


@dataclass(frozen=True)
class Store:
    """A folder of accepted figures; names may have folders in them, as those of scripts do."""

    folder: Path

    def path(self, name: str, ending: str = ".json") -> Path:
        """Return where a file of a figure is."""
        return self.folder / f"{name}{ending}"

    def read(self, name: str) -> Accepted | None:
        """Return an accepted figure, or ``None`` if there is none.

        Raises
        ------
        FigureRecordError
            If its record is damaged, newer than this version, or not the one that was accepted last; if its picture
            is not.
        """
        path = self.path(name)
        with _reading(path):
            finish_interrupted(path.parent)
        if not self._has(path):
            return None
        text = self._text(path)
        try:
            record = Record.from_json(text)
        except FigureRecordError as error:
            where = f"{path}:{error.line}" if error.line else str(path)
            raise FigureRecordError(f"{where}: {error.why}") from None  # noqa: EM102  -- the class makes the sentence
        last = self._last(name)
        if last.get("accepted", digest(text)) != digest(text):
            why = f"{path}: is not the state that was accepted last, a merge or an edit changed it: accept it again"
            raise FigureRecordError(why)
        shown = self.path(name, ".png")
        with _reading(shown):
            picture = shown.read_bytes() if shown.is_file() else b""
        if picture and last.get("picture", digest(picture)) != digest(picture):
            why = f"{shown}: is not the picture that was accepted last, a merge or an edit changed it: accept it again"
            raise FigureRecordError(why)
        return Accepted(record, digest(text), picture)

    def digest(self, name: str) -> str:
        """Return the digest of the accepted state, whatever it is; empty if there is none."""
        path = self.path(name)
        return digest(self._text(path)) if self._has(path) else ""

    def names(self) -> list[str]:
        """Return the names of all accepted figures."""
        found = self.folder.rglob("*.json") if self.folder.is_dir() else ()
        names = (path.relative_to(self.folder).with_suffix("") for path in found)
        return sorted(name.as_posix() for name in names if not any(part.startswith(".") for part in name.parts))

    def write(self, name: str, record: str, picture: bytes, reason: str, changes: Sequence[str]) -> None:
        """Accept a state, all of its files or none.

        Raises
        ------
        OutputError
            If the folder cannot be written; it is as it was, then.
        """
        made = {"accepted": digest(record)} | ({"picture": digest(picture)} if picture else {})
        self._replace(name, {".json": record.encode(), ".png": picture}, reason, changes, made)

    def remove(self, name: str, reason: str) -> None:
        """Accept that there is no such figure any more; its acceptances stay."""
        self._replace(name, {}, reason, ["is not drawn any more"], {"accepted": ""})

    def _replace(
        self, name: str, files: dict[str, bytes], reason: str, changes: Sequence[str], made: dict[str, str]
    ) -> None:
        entry = {"reason": reason, "changes": list(changes), "replaces": self.digest(name), **made}
        log = self.path(name, ".log")
        earlier = self._text(log) if self._has(log) else ""
        line = json.dumps(entry, ensure_ascii=False) + "\n"
        fresh = {f"{log.stem}{ending}": content for ending, content in files.items() if content}
        gone = [] if files else [f"{log.stem}{ending}" for ending in (".json", ".png")]
        replace_files(log.parent, {**fresh, log.name: (earlier + line).encode()}, gone)

    def _last(self, name: str) -> dict[str, str]:
        """Return the digests of what was accepted last, by name; empty if nobody wrote them down."""
        log = self.path(name, ".log")
        if not self._has(log):
            return {}
        lines = self._text(log).splitlines()
        try:
            entry = json.loads(lines[-1]) if lines else {}
            return {"accepted": str(entry["accepted"])} | {key: str(entry[key]) for key in ("picture",) if key in entry}
        except (ValueError, KeyError, TypeError, RecursionError):
            why = f"{log}:{len(lines)}: is not an acceptance; needed: an object with 'accepted' in each line"
            raise FigureRecordError(why) from None

    @staticmethod
    def _has(path: Path) -> bool:
        with _reading(path):
            return path.is_file()

    @staticmethod
    def _text(path: Path) -> str:
        with _reading(path):
            return path.read_text(encoding="utf-8")


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Say of a file why it cannot be read."""
    try:
        yield
    except OSError as error:
        msg = f"{path}: cannot be read: {error.strerror or error}"
        raise FigureRecordError(msg) from None
    except UnicodeDecodeError:
        msg = f"{path}: is not UTF-8 text"
        raise FigureRecordError(msg) from None

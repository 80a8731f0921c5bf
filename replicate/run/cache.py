"""Results kept between runs, each with what it depends on.

An entry is used only if it is whole, is that of the unit asked for and everything it depends on is as it was; otherwise
the unit is computed again. A few entries of one unit stand beside each other, so that going back to an earlier state
finds its results.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from replicate.exhibits import Paper
from replicate.exhibits.results import Result
from replicate.run.dependencies import Dependencies, Looked
from replicate.run.entries import DAMAGED, NEVER, OTHER, SUFFIX, UselessError, read_entry, write_entry
from replicate.run.limits import MOST_KEPT
from replicate.run.storage import SCHEMA, from_text
from replicate.run.units import Unit, fits

FORM = "replicate result"
_NAME = re.compile(rf"([0-9a-f]{{16}}|[0-9a-f]{{24}}){re.escape(SUFFIX)}|\.aside-\w{{8}}")
_MOST_STATES = 4  # entries of one unit


@dataclass
class Cache:
    """A folder of results.

    Parameters
    ----------
    folder
        Created on the first write. ``None`` keeps nothing.
    """

    folder: Path | None
    _looked: Looked = field(default_factory=Looked)

    def get(self, paper: Paper, unit: Unit) -> tuple[Result | None, str]:
        """Return the result of a unit, or why there is none that holds."""
        if self.folder is None:
            return None, "nothing is kept"
        why = ""
        for path in self._entries(unit):
            result, reason = self._read(path, paper, unit)
            if result is not None:
                with contextlib.suppress(OSError):
                    os.utime(path)  # used just now: the last to be removed
                return result, ""
            why = why or reason
        return None, why or NEVER

    def state(self, paper: Paper, unit: Unit) -> str:
        """Return the digest of the result of a unit that holds and of all it depends on; empty if there is none.

        The paper need not be loaded if its folder is as it was when the result was last taken for one that holds.
        """
        for path in self._entries(unit) if self.folder is not None else ():
            with contextlib.suppress(UselessError, OSError, ValueError, TypeError, LookupError):
                recorded, text = self._text(path, paper, unit)
                os.utime(path)  # used just now: the last to be removed
                return hashlib.sha256(json.dumps(recorded).encode() + text).hexdigest()
        return ""

    def put(self, unit: Unit, text: str, dependencies: Dependencies) -> None:
        """Keep the text of a result. A full disk or a read-only folder costs the next run time, nothing else."""
        if self.folder is None or not dependencies:
            return
        state = hashlib.sha256(json.dumps(dependencies).encode()).hexdigest()[:16]
        with contextlib.suppress(OSError):
            write_entry(self._folder(unit) / f"{state}{SUFFIX}", _identity(unit), dependencies, text)
            for old in self._entries(unit)[_MOST_STATES:]:
                old.unlink(missing_ok=True)

    def trim(self, most: int = MOST_KEPT) -> int:
        """Remove what has not been used for longest until the rest is small enough; return the bytes removed."""
        removed = 0
        entries = sorted(stored(self.folder), key=lambda entry: entry.used)
        total = sum(entry.size for entry in entries)
        for entry in entries:
            if total - removed <= most:
                break
            with contextlib.suppress(OSError):
                entry.path.unlink(missing_ok=True)
                removed += entry.size
        return removed

    def clear(self) -> list[Entry]:
        """Remove every entry, and nothing else in the folder; return what there was."""
        entries = list(stored(self.folder))
        for entry in entries:
            entry.path.unlink(missing_ok=True)
            for folder in entry.path.parents:
                if self.folder is None or not folder.is_relative_to(self.folder):
                    break
                with contextlib.suppress(OSError):  # not empty
                    folder.rmdir()
        return entries

    def _folder(self, unit: Unit) -> Path:
        assert self.folder is not None  # noqa: S101  -- for the type checker; all callers have looked
        return self.folder / unit.paper / hashlib.sha256(json.dumps(_named(unit)).encode()).hexdigest()[:24]

    def _entries(self, unit: Unit) -> list[Path]:
        """Return the entries of a unit, those used last first."""
        found = [entry for entry in stored(self._folder(unit)) if entry.path.suffix == SUFFIX]
        return [entry.path for entry in sorted(found, key=lambda entry: (-entry.used, entry.path))]

    def _read(self, path: Path, paper: Paper, unit: Unit) -> tuple[Result | None, str]:
        try:
            return self._whole(path, paper, unit), ""
        except UselessError as error:
            return None, str(error)
        except Exception:  # noqa: BLE001  -- whatever is wrong with it, the result is computed again
            return None, DAMAGED

    def _whole(self, path: Path, paper: Paper, unit: Unit) -> Result:
        _, text = self._text(path, paper, unit)
        result = from_text(text)
        if not fits(result, unit, paper.exhibits[unit.exhibit]):
            raise UselessError(OTHER)
        return result

    def _text(self, path: Path, paper: Paper, unit: Unit) -> tuple[Dependencies, bytes]:
        """Return an entry as it was written, if all that its result depends on is as it was."""
        recorded, text = read_entry(path, _identity(unit))
        difference = self._looked.difference(paper, unit.exhibit, _checked(recorded))
        if difference:
            raise UselessError(difference)
        return recorded, text


@dataclass(frozen=True)
class Entry:
    """A file of the cache: where it is, how large, and when it was used last (nanoseconds)."""

    path: Path
    size: int
    used: int


def stored(folder: Path | None) -> Iterator[Entry]:
    """Yield all entries in a folder, and what runs that were killed have left of some; never files of others."""
    for place, folders, names in os.walk(folder or os.devnull):  # which passes over what another run removes
        folders.sort()
        for name in sorted(names):
            if _NAME.fullmatch(name):
                with contextlib.suppress(OSError):
                    stat = os.stat(os.path.join(place, name))  # noqa: PTH116, PTH118  -- `os.walk` gives texts
                    yield Entry(Path(place, name), stat.st_size, stat.st_mtime_ns)


def _identity(unit: Unit) -> dict[str, object]:
    return {"form": FORM, "schema": SCHEMA, "unit": _named(unit)}


def _named(unit: Unit) -> dict[str, str]:
    return {"paper": unit.paper, "package": unit.package, "exhibit": unit.exhibit, "reading": unit.reading}


def _checked(value: Any) -> Dependencies:
    groups = {"python", "framework", "paper", "project", "distribution", "module", "data"}
    if not isinstance(value, dict) or set(value) != groups:
        msg = "the dependencies are not complete"
        raise ValueError(msg)
    for group in value.values():
        if not isinstance(group, dict) or not all(isinstance(digest, str) for digest in group.values()):
            msg = "the dependencies are not names and digests"
            raise TypeError(msg)
    return value

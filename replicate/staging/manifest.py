"""The manifest of an output folder: which files earlier runs wrote, with a digest of each.

Only these are ever replaced or removed. A file that has another digest now belongs to whoever changed it.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from replicate.errors import OutputError
from replicate.staging.journal import ROOM
from replicate.staging.names import checked_name

MANIFEST = f"{ROOM}/manifest.json"

_FORMAT = 1

# What runs leave at the top of an output folder: only of such a folder may one say that it can be deleted.
_LEFT = {
    *("results.csv", "verdicts.csv", "errata.csv", "exhibits.csv", "columns.csv", "junit.xml", "report", "tables"),
    *("figures", "cache", "charts", "diff", "handouts", "sweeps"),
}


@dataclass(frozen=True)
class Manifest:
    """Digests of files by name, for each part of an output folder (report, diff, handouts, charts)."""

    parts: dict[str, dict[str, str]] = field(default_factory=dict)

    @classmethod
    def read(cls, target: Path) -> Manifest:
        """Return the manifest of a folder, an empty one if there is none.

        Raises
        ------
        OutputError
            If the file is damaged.
        """
        path = target / MANIFEST
        if not path.is_file():
            return cls()
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            if content["format"] != _FORMAT:
                msg = f"format {content['format']}"
                raise ValueError(msg)  # noqa: TRY301
            parts = content["parts"].items()
            return cls(
                {part: {checked_name(name): str(digest) for name, digest in files.items()} for part, files in parts}
            )
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            msg = f"{path}: is not a list of files that this version of replicate wrote; delete {target} (make clean)"
            raise OutputError(msg) from error

    def text(self) -> str:
        """Return the content of the file, the same for the same files."""
        return json.dumps({"format": _FORMAT, "parts": self.parts}, indent=1, sort_keys=True) + "\n"

    def digest(self, name: str) -> str | None:
        """Return the digest of a file, ``None`` if no earlier run wrote it."""
        return next((files[name] for files in self.parts.values() if name in files), None)

    def obsolete(self, part: str, written: Iterable[str], renews: Callable[[str], bool]) -> list[str]:
        """Return the files of a part that a run renews and did not write again."""
        return sorted(set(self.parts.get(part, ())).difference(written).intersection(self.of(part, renews)))

    def of(self, part: str, renews: Callable[[str], bool]) -> list[str]:
        """Return the files of a part that a run renews."""
        return [name for name in self.parts.get(part, ()) if renews(name)]

    def renewed(self, part: str, written: dict[str, str], removed: Iterable[str]) -> Manifest:
        """Return the manifest after a run."""
        gone = {*written, *removed}
        parts = {key: {n: d for n, d in files.items() if n not in gone} for key, files in self.parts.items()}
        parts[part] = parts.get(part, {}) | written
        return Manifest({key: files for key, files in parts.items() if files})


def digest(path: Path) -> str:
    """Return the digest of a file's content."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def refuse_foreign(target: Path, manifest: Manifest, names: Iterable[str], fresh: Path | None = None) -> None:
    """Refuse to write if a file is in the way that no earlier run wrote, or that was changed since.

    Parameters
    ----------
    fresh
        Folder with the new files; one that is in place already, byte for byte, is in nobody's way.

    Raises
    ------
    OutputError
        On one line, with the first such file and the number of others.
    """
    found = [(name, why) for name in names if (why := _foreign(target, manifest, name, fresh))]
    if not found:
        return
    (name, why), *others = found
    more = f" (and {len(others)} more)" if others else ""
    msg = f"{target / name}{more}: {why}; nothing was written"
    raise OutputError(msg)


def _foreign(target: Path, manifest: Manifest, name: str, fresh: Path | None) -> str:
    place = target / name
    not_a_file = _not_a_file(target, manifest, name)
    if not_a_file or not place.exists():
        return not_a_file
    known, now = manifest.digest(name), digest(place)
    if known == now or (fresh is not None and (fresh / name).is_file() and digest(fresh / name) == now):
        return ""
    if known is not None:
        return "was changed after the run that wrote it, so it is not replaced; move it away or delete it"
    if not manifest.parts and _looks_like_ours(target):
        return (
            "is in the way, and no earlier run of this version wrote it; choose another folder with --out, or, if an "
            f"older version left it, delete {target} (make clean)"
        )
    return "is in the way, and no earlier run wrote it; move it away, or choose another folder with --out"


def _looks_like_ours(target: Path) -> bool:
    """Whether a folder holds what a report leaves, and nothing at its top that a report does not."""
    there = {entry.name for entry in target.iterdir()} - {ROOM}
    return {"results.csv", "report"} <= there <= _LEFT


def _not_a_file(target: Path, manifest: Manifest, name: str) -> str:
    """Say what else stands where a file should, or where one of its folders should."""
    for parent in list(Path(name).parents)[:-1]:
        place = target / parent
        if os.path.lexists(place) and not place.is_dir() and manifest.digest(parent.as_posix()) is None:
            return f"{parent.as_posix()} is in the way, which is {_kind(place)} that no earlier run wrote; move it away"
    place = target / name
    if os.path.lexists(place) and (place.is_symlink() or not place.is_file()):
        return f"is in the way, which is {_kind(place)} and no file that an earlier run wrote; move it away"
    return ""


def _kind(place: Path) -> str:
    """Say what something is, without looking into it: reading a pipe would wait for ever."""
    if place.is_symlink():
        return "a symbolic link" if place.exists() else "a symbolic link to nothing"
    return "a folder" if place.is_dir() else "a file" if place.is_file() else "a pipe or device"

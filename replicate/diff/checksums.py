"""Checksums of accepted files, in ``SHA256SUMS`` beside them: what was altered after it was accepted is told.

The comparison says what differs from the present results. It cannot see what leaves them as they are: another picture,
panels in another order, a tolerance that was raised. The file has a line for each accepted one, as ``sha256sum`` writes
and checks them; of text the ends of lines do not count, because a checkout may change them.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from replicate.errors import AcceptedStateError

SUMS = "SHA256SUMS"

_LINE = re.compile(r"([0-9a-f]{64})  (\S+)")
_BINARY = ".png"


def checksum(name: str, content: bytes) -> str:
    r"""Return the checksum of a file.

    Examples
    --------
    >>> checksum("a.csv", b"1\r\n") == checksum("a.csv", b"1\n"), checksum("a.png", b"\r\n")[:8]
    (True, '7eb70257')
    """
    return hashlib.sha256(content if name.endswith(_BINARY) else content.replace(b"\r\n", b"\n")).hexdigest()


def checksums(paths: Iterable[Path]) -> dict[str, str]:
    """Return the checksums of files by their names."""
    return {path.name: checksum(path.name, path.read_bytes()) for path in paths}


def read_checksums(folder: Path) -> Mapping[str, str] | None:
    """Return what was written down of a paper's accepted files, by name; ``None`` if an older version accepted them.

    Raises
    ------
    AcceptedStateError
        If the file is damaged.
    """
    path, where = folder / SUMS, f"{folder.name}/{SUMS}"
    if not path.is_file():
        return None
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        msg = f"{where}: cannot be read: {getattr(error, 'strerror', None) or error}"
        raise AcceptedStateError(msg) from error
    sums: dict[str, str] = {}
    for number, line in enumerate(lines, 1):
        found = _LINE.fullmatch(line)
        if found is None or found[2] in sums:
            msg = f"{where}:{number}: expected: a SHA-256 checksum, two blanks and a name, each name once"
            raise AcceptedStateError(msg)
        sums[found[2]] = found[1]
    return sums


def checksums_text(sums: Mapping[str, str]) -> str:
    """Return the content of the file."""
    return "".join(f"{sums[name]}  {name}\n" for name in sorted(sums))


def altered(paths: Iterable[Path], sums: Mapping[str, str]) -> list[str]:
    """Return the names of files that are not as they were accepted."""
    return [name for name, found in checksums(paths).items() if sums.get(name) != found]

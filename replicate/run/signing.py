"""Signatures by which a run knows its own notes: of what others could have written, nothing is believed.

The key is the user's own, in the user's cache folder, and no other user can read it. Without such a folder, or where
its file is open to others, nothing is signed and nothing is believed.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import os
import secrets
from pathlib import Path

from replicate.run.costs import user_folder

FILE = "key"
_LENGTH = 32


def signature(content: bytes) -> str:
    """Return the signature of a content; empty if there is no key."""
    key = _key()
    return hmac.new(key, content, hashlib.sha256).hexdigest() if key else ""


def is_signed(content: bytes, given: object) -> bool:
    """Say whether a signature is the one that this user's runs give a content."""
    own = signature(content)
    return bool(own) and isinstance(given, str) and hmac.compare_digest(own.encode(), given.encode())


def is_own(stat: os.stat_result, closed: int = 0o022) -> bool:
    """Say whether a file is this user's, and none that others may have written.

    Parameters
    ----------
    stat
        Of the file, once it is open: who may write into its folder could put another one in its place.
    closed
        The permissions that no one else must have; the default forbids to write. Windows has neither.
    """
    return os.name == "nt" or (stat.st_uid == os.getuid() and not stat.st_mode & closed)


def _key() -> bytes:
    """Return the user's key, made at its first use; empty if there is none that is the user's alone."""
    folder = user_folder()
    if folder is None:
        return b""
    path = folder / FILE
    with contextlib.suppress(OSError):
        if not path.exists():
            _make(path)
        with path.open("rb") as file:
            stat = os.fstat(file.fileno())
            is_private = is_own(stat, closed=0o077) and not path.is_symlink()
            return file.read() if is_private and stat.st_size == _LENGTH else b""
    return b""


def _make(path: Path) -> None:
    """Write a key whole; of two runs that do so at the same time, one wins."""
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{FILE}-{secrets.token_hex(8)}")
    try:
        with os.fdopen(os.open(aside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
            file.write(secrets.token_bytes(_LENGTH))
        with contextlib.suppress(FileExistsError):
            os.link(aside, path)
    finally:
        aside.unlink(missing_ok=True)

"""Files of the cache: text of three lines, written whole, and of use only if it is whole and what was asked for.

The lines are what it is (and a digest of the rest), what it depends on, and what was computed. Nothing in it is ever
run. But pages show it, so that one which others could have written is of no use either.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from replicate.run.signing import is_own

SUFFIX = ".result"

NEVER = "it has not been computed before"
DAMAGED = "its entry in the cache is damaged"
OTHER = "its entry in the cache is that of another unit"
OTHER_FORM = "its entry in the cache has another form"
OTHERS = "its entry in the cache could have been written by others"

_LONGEST_HEAD = 2**16


class UselessError(Exception):
    """An entry cannot be used; the message says why."""


def write_entry(path: Path, identity: Mapping[str, object], dependencies: object, content: str) -> None:
    """Write an entry.

    Parameters
    ----------
    path
        Where to; its folder is made.
    identity
        What it is: ``form`` and ``schema``, and what tells it from all others of its form.
    dependencies
        What it depends on; anything that JSON can hold.
    content
        One line.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    rest = f"{json.dumps(dependencies)}\n{content}\n".encode()
    head = json.dumps({**identity, "digest": hashlib.sha256(rest).hexdigest()})
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, f"{head}\n".encode() + rest)


def read_entry(path: Path, identity: Mapping[str, object]) -> tuple[Any, bytes]:
    """Return what an entry depends on, and its content as it was written.

    Raises
    ------
    UselessError
        If there is none, or it is not whole, or something else, or not this user's alone to write.
    """
    try:
        with path.open("rb") as file:
            if not is_own(os.fstat(file.fileno())):
                raise UselessError(OTHERS)
            head = json.loads(file.readline(_LONGEST_HEAD))
            digest = head.pop("digest")
            if head != identity:
                same_form = all(head.get(key) == identity.get(key) for key in ("form", "schema"))
                raise UselessError(OTHER if same_form else OTHER_FORM)
            rest = file.read()
        dependencies, content = rest.split(b"\n", 1)
        if hashlib.sha256(rest).hexdigest() == digest:
            return json.loads(dependencies), content
    except FileNotFoundError as error:
        raise UselessError(NEVER) from error
    except (OSError, ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        raise UselessError(DAMAGED) from error
    raise UselessError(DAMAGED)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file aside and rename it: a reader, also one in another run, sees the whole file or none."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=".aside-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise

"""Files that are added to a folder one by one, each whole and on the disk before the next, while one run holds it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from replicate.errors import OutputError
from replicate.staging.files import partial_of, write_safely
from replicate.staging.journal import ROOM, room_of
from replicate.staging.lock import locked
from replicate.staging.stage import LOCK, say, unwritable


@contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made if need be, for one run; a second one waits and says so.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with locked(room_of(folder) / LOCK, say):
            yield
    except OSError as error:
        raise unwritable(folder, error) from error
    finally:
        with suppress(OSError):  # another run is waiting
            (folder / ROOM).rmdir()


def keep_file(path: Path, content: bytes) -> None:
    """Write a file that is whole at every moment, and on the disk when this returns.

    Raises
    ------
    OutputError
        If it cannot be written; what was there before is as it was.
    """
    try:
        write_safely(path, content)
    except OSError as error:
        partial_of(path).unlink(missing_ok=True)
        msg = f"{path}: cannot be written: {error.strerror or error}"
        raise OutputError(msg) from error

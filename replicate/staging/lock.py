"""One run at a time writes to a folder: the second waits, and says so.

The lock belongs to the process, not to the file: the operating system takes it back from a run that is killed.
"""

from __future__ import annotations

import errno
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from replicate.errors import OutputError

_PAUSE = 0.2  # seconds between two attempts
_REMOVALS = 100  # of the folder by other runs; more often than that, it cannot be made

# What the systems say when another process holds the lock; anything else means that this disk has no locks.
_HELD = {errno.EAGAIN, errno.EACCES, errno.EDEADLK}

# The system's lock does not tell two runs of one process apart.
_held: set[Path] = set()

if sys.platform == "win32":
    import msvcrt

    def _try(file: IO[str]) -> None:
        # A byte far behind the content, so that others can still read who holds the lock.
        file.seek(1 << 20)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _try(file: IO[str]) -> None:
        # `lockf`, not `flock`: workers that outlive a killed run do not inherit it.
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


@contextmanager
def locked(path: Path, say: Callable[[str], None]) -> Iterator[None]:
    """Hold the lock of a file, which is made and removed here.

    Parameters
    ----------
    path
        Its folder is made, too, if need be.
    say
        Called once, with one line, if another run holds the lock.

    Raises
    ------
    OutputError
        If this very process holds it already.
    OSError
        If the file cannot be made.
    """
    key = Path(os.path.realpath(path))  # of links in a circle, too
    if key in _held:
        msg = f"{path.parent.parent}: this process is writing to it already"
        raise OutputError(msg)
    file = _acquire(path, say)
    _held.add(key)
    try:
        yield
    finally:
        _held.discard(key)
        with suppress(OSError):  # an open file cannot be removed on Windows; it is empty of meaning when unlocked
            path.unlink()
        file.close()


def _acquire(path: Path, say: Callable[[str], None]) -> IO[str]:
    waited, removals = False, 0
    while True:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            file = path.open("a+", encoding="utf-8")
        except FileNotFoundError:  # the run before has just removed the folder
            removals += 1
            if removals > _REMOVALS:
                raise
            continue
        try:
            _try(file)
        except OSError as error:
            if error.errno not in _HELD:
                return file
            if not waited:
                file.seek(0)
                holder = file.read(20).strip()
                about = f" (process {holder})" if holder else ""
                say(f"{path.parent.parent}: another run is under way there{about}; waiting for it to end")
                waited = True
            file.close()
            time.sleep(_PAUSE)
            continue
        if _is_still_at(file, path):
            file.truncate(0)
            file.write(f"{os.getpid()}\n")
            file.flush()
            return file
        file.close()  # it was removed between opening and locking


def _is_still_at(file: IO[str], path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False
